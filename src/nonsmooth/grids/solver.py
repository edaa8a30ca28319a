"""What a solver of the Poisson equation on a tensor grid must do, whatever its method."""

from typing import Protocol

import numpy as np

ODD, EVEN = -1, 1


class PoissonSolver(Protocol):
    """Solver of -A u = f - E f (eq. (12) of the paper) on one tensor grid.

    A is the generator of a scene, discretised on the grid's axes; E is the mean in the invariant
    measure of the discretised A. A solver is made for one scene and one grid and may be asked for
    many solutions. What must hold:

    - The rows of the discretised A sum to zero, so that constants are in its kernel. There is one
      invariant measure; its masses may be negative where they are small.
    - Functions are arrays of values at nodes. "The whole grid" means all nodes, in the order of the
      axes, of which the first varies slowest: the order of `generator.evaluate`.
    - Drift and observable of many scenes change sign with the state. If the solver was told so, it
      is `mirrored`: every function then is odd or even in the state, and the solver works on half
      of the nodes. Which half, and in which order, is the solver's own choice; others only use
      `fold` and `unfold`. An odd function has the mean 0.
    - Unless the solver is mirrored, it ignores parities, and `fold` may change the order only.

    Attributes
    ----------
    mirrored : bool
        Whether functions live on half of the grid and have a parity.
    scale : numpy.ndarray
        Folded; weights that make functions small where the invariant measure has hardly any mass,
        and an iterative solver hardly any accuracy.
    """

    mirrored: bool
    scale: np.ndarray

    def fold(self, whole: np.ndarray, /) -> np.ndarray:
        """Take a function from the whole grid to the nodes that are solved on.

        Parameters
        ----------
        whole : numpy.ndarray, shape (number of grid points,)

        Returns
        -------
        numpy.ndarray, shape (k,)
            All grid points, or half of them if `mirrored`.
        """

    def unfold(self, half: np.ndarray, parity: int, /) -> np.ndarray:
        """Take a function back to the whole grid; the inverse of `fold`.

        Parameters
        ----------
        half : numpy.ndarray, shape (k,)
        parity : {ODD, EVEN}
            Of the function; ignored unless `mirrored`.

        Returns
        -------
        numpy.ndarray, shape (number of grid points,)
        """

    def solve(
        self, values: np.ndarray, parity: int, accuracy: float, near: np.ndarray | None = None, /
    ) -> tuple[np.ndarray, float]:
        """Solve -A u = f - E f.

        Parameters
        ----------
        values : numpy.ndarray, shape (k,)
            f, folded.
        parity : {ODD, EVEN}
            Of f; ignored unless `mirrored`.
        accuracy : float
            Residual that is allowed, relative to f, in a norm of the solver's choice that bounds
            errors of means. A direct solver needs none.
        near : numpy.ndarray, shape (k,), optional
            A solution of nearly the same equation, from which an iterative solver goes on.

        Returns
        -------
        u : numpy.ndarray, shape (k,)
            Folded; determined up to a constant if even.
        mean : float
            E f.

        Raises
        ------
        ToleranceError
            If the accuracy is out of reach.
        """

    def stationary(self, accuracy: float, /) -> np.ndarray:
        """Masses of the invariant measure.

        Parameters
        ----------
        accuracy : float
            As for `solve`.

        Returns
        -------
        numpy.ndarray, shape (number of grid points,)
            At the nodes of the whole grid, of sum 1.
        """
