"""The Poisson equation -A u = f - E f (eq. poisson) on a tensor grid, solved by linear algebra.

Up to two variables, by one sparse factorisation. Beyond, the generator is the sum of the noise's
own generator L and of the transport T by the oscillator's drift, which does not mix values of the
noise: (a - T)^-1 (a - L)^-1, one step of alternating directions, preconditions GMRES.

Where drift and observable are odd, solutions are odd or even in the state, and half of the grid
is enough.
"""

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from nonsmooth.grids.generator import assemble

ODD, EVEN = -1, 1


def factorise(matrix):
    """Sparse LU of a matrix whose pattern is symmetric and whose diagonal is not small."""
    return spla.splu(
        matrix.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=1e-3,
        options={"SymmetricMode": True},
    )


class _Factors:
    """Sparse LU with one step of iterative refinement, which mends its weak pivoting."""

    def __init__(self, matrix):
        self.matrix = matrix
        self.lu = factorise(matrix)

    def solve(self, right, trans="N"):
        matrix = self.matrix.T if trans == "T" else self.matrix
        solution = self.lu.solve(right, trans=trans)
        return solution + self.lu.solve(right - matrix @ solution, trans=trans)


class Direct:
    """Solver by sparse factorisation.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    axes : dict
        See `mesh.axes`.
    mirrored : bool
        Whether to use that drift and observable are odd.
    """

    def __init__(self, scene, axes, mirrored):
        self.generator = assemble(scene, axes)
        self.size = self.generator.shape[0]
        self.mirrored = mirrored
        self._factors = {}

    def unfold(self, half, parity):
        """Continue a function from half of the grid to all of it."""
        return np.concatenate([half, parity * half[::-1]]) if self.mirrored else half

    def fold(self, whole):
        """Restrict a function to the half of the grid that is solved on."""
        return whole[: self.size // 2] if self.mirrored else whole

    def matrix(self, parity):
        """Return the generator on odd or even functions."""
        if not self.mirrored:
            return self.generator
        half = self.size // 2
        return (
            self.generator[:half, :half] + parity * self.generator[:half, half:][:, ::-1]
        ).tocsr()

    def _factor(self, parity):
        # constants are in the kernel of A, and are not odd
        if parity not in self._factors:
            matrix = -self.matrix(parity)
            if parity == EVEN or not self.mirrored:
                ones = np.ones((matrix.shape[0], 1))
                matrix = sp.block_array([[matrix, ones], [ones.T / len(ones), None]])
            self._factors[parity] = _Factors(matrix)
        return self._factors[parity]

    def solve(self, values, parity, _accuracy=None):
        """Solve -A u = f - E f.

        Parameters
        ----------
        values : numpy.ndarray
            f on the (half) grid.
        parity : {ODD, EVEN}
            Of f; ignored unless mirrored.

        Returns
        -------
        u : numpy.ndarray
        mean : float
        """
        if self.mirrored and parity == ODD:
            return self._factor(ODD).solve(values), 0.0
        solution = self._factor(EVEN).solve(np.append(values, 0.0))
        return solution[:-1], float(solution[-1])

    def resolvent(self, values, parity, shift):
        """Apply (shift - A)^-1, shift > 0, to a function on the (half) grid."""
        key = shift, parity if self.mirrored else EVEN
        if key not in self._factors:
            matrix = self.matrix(parity)
            self._factors[key] = factorise(shift * sp.eye_array(matrix.shape[0]) - matrix)
        return self._factors[key].solve(values)

    def stationary(self, _accuracy=None):
        """Masses of the invariant measure at the nodes of the whole grid, of sum 1."""
        one = np.zeros(self.fold(np.empty(self.size)).size + 1)
        one[-1] = 1.0
        masses = self.unfold(self._factor(EVEN).solve(one, trans="T")[:-1], EVEN)
        return masses / masses.sum()
