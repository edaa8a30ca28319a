"""The Poisson equation on tensor grids with up to two variables, by sparse factorisation.

scipy's SuperLU frees memory only in the thread that has allocated it; elsewhere the memory is lost.
And Python hears Ctrl-C only in its main thread, between two of its own instructions. So factors are
made in a thread of their own, for which the caller waits, and go back to it to be freed; at the
end of the program, too, which would otherwise report an error.
"""

import atexit
import os
import queue
import threading
import weakref
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from functools import partial
from typing import ClassVar

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from sympy import Symbol

from nonsmooth.errors import ToleranceError
from nonsmooth.grids import tuning
from nonsmooth.grids.elements import Axis
from nonsmooth.grids.generator import assemble
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.progress import awaited, begin, fulfil
from nonsmooth.scenes.scene import Scene


class _Workshop:
    """A thread that makes factors, keeps them, and frees them; one task after the other.

    Attributes
    ----------
    kept : dict
        The factors by keys of their owners.
    """

    def __init__(self) -> None:
        self.kept: dict[object, spla.SuperLU] = {}
        self._tasks: queue.SimpleQueue[Callable[[], object] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()
        atexit.register(self._close)
        os.register_at_fork(before=self._settle)

    def _work(self):
        while (task := self._tasks.get()) is not None:
            task()

    def put(self, task: Callable[[], object]) -> None:
        """Do a task later."""
        self._tasks.put(task)

    def abandon(self) -> None:
        """Let the thread go on with what nobody waits for any more."""
        atexit.unregister(self._close)

    def is_open(self) -> bool:
        """Whether the thread is there; a forked process has no threads but its own."""
        return self._thread.is_alive()

    def _settle(self):
        """Wait until what is dropped is freed: scipy's leftovers break a forked process."""
        if self.is_open():
            done = threading.Event()
            self._tasks.put(done.set)
            done.wait(tuning.TENSOR_GRIDS.to_close)

    def _close(self):
        """Free all, or the program ends with an error of scipy's and the exit code 120."""
        self._tasks.put(self.kept.clear)
        self._tasks.put(None)
        self._thread.join(tuning.TENSOR_GRIDS.to_close)


class SparseFactors:
    """Sparse LU of a matrix whose pattern is symmetric and whose diagonal is not small.

    Parameters
    ----------
    matrix : sparse array, shape (n, n)

    Raises
    ------
    ToleranceError
        If the memory does not hold the factors.
    """

    _workshop: ClassVar[_Workshop | None] = None

    def __init__(self, matrix: sp.sparray):
        begin()
        workshop = SparseFactors._workshop
        if workshop is None or not workshop.is_open():
            workshop = SparseFactors._workshop = _Workshop()
        self._kept, self._key = workshop.kept, object()
        done: Future = Future()
        # tasks must not refer to this object, or it would never be freed
        workshop.put(partial(fulfil, done, partial(_factorise, matrix, self._kept, self._key)))
        free = partial(self._kept.pop, self._key, None)
        weakref.finalize(self, workshop.put, free).atexit = False
        try:
            awaited(done)
        except MemoryError:
            raise ToleranceError(
                f"the memory does not hold the factors of {matrix.shape[0]} equations; choose a "
                "larger tol or Monte Carlo, or free memory"
            ) from None
        except KeyboardInterrupt:
            workshop.abandon()
            SparseFactors._workshop = None
            raise

    def solve(self, right: np.ndarray, trans: str = "N") -> np.ndarray:
        """Solve with the matrix, or with its transpose if `trans` is "T"."""
        return self._kept[self._key].solve(right, trans=trans)


def _factorise(matrix, kept, key):
    kept[key] = spla.splu(
        matrix.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=1e-3,
        options={"SymmetricMode": True},
    )


class _Factors:
    """Sparse LU with one step of iterative refinement, which makes up for its weak pivoting."""

    def __init__(self, matrix):
        self.matrix = matrix
        self.lu = SparseFactors(matrix)

    def solve(self, right, trans="N"):
        matrix = self.matrix.T if trans == "T" else self.matrix
        solution = self.lu.solve(right, trans=trans)
        return solution + self.lu.solve(right - matrix @ solution, trans=trans)


def folded(matrix: sp.csr_array, parity: int) -> sp.csr_array:
    """Restrict a matrix to odd or even functions, on the first half of a grid.

    Parameters
    ----------
    matrix : scipy.sparse.csr_array, shape (2 n, 2 n)
        It keeps the parity.
    parity : {ODD, EVEN}

    Returns
    -------
    scipy.sparse.csr_array, shape (n, n)
    """
    half = matrix.shape[0] // 2
    return (matrix[:half, :half] + parity * matrix[:half, half:][:, ::-1]).tocsr()


class DirectSolver:
    """Solver by sparse factorisation; see `solver.PoissonSolver` for what it promises.

    Factors are kept, so that further solutions are cheap.

    Parameters
    ----------
    scene : Scene
        With a finite n.
    axes : dict
        Maps symbols to axes, see `mesh.axes.axes`.
    mirrored : bool
        Whether to use that the drift is odd, and all functions odd or even. No node may be its own
        mirror image.
    """

    def __init__(self, scene: Scene, axes: Mapping[Symbol, Axis], mirrored: bool):
        self.generator = assemble(scene, axes)
        self.size = self.generator.shape[0]
        self.mirrored = mirrored
        self.scale = np.ones(self.fold(np.empty(self.size)).size)
        self._factors: dict[int | tuple[float, int], SparseFactors | _Factors] = {}

    def fold(self, whole: np.ndarray) -> np.ndarray:
        """Restrict a function to the first half of the grid."""
        return whole[: self.size // 2] if self.mirrored else whole

    def unfold(self, half: np.ndarray, parity: int) -> np.ndarray:
        """Continue a function from half of the grid to all of it."""
        return np.concatenate([half, parity * half[::-1]]) if self.mirrored else half

    def matrix(self, parity: int) -> sp.csr_array:
        """Return the generator on odd or even functions, folded."""
        if not self.mirrored:
            return self.generator
        return folded(self.generator, parity)

    def _factor(self, parity):
        if parity not in self._factors:
            matrix = -self.matrix(parity)
            if parity == EVEN or not self.mirrored:  # constants, which are even, are in its kernel
                ones = np.ones((matrix.shape[0], 1))
                matrix = sp.block_array([[matrix, ones], [ones.T / len(ones), None]])
            self._factors[parity] = _Factors(matrix)
        return self._factors[parity]

    def solve(
        self,
        values: np.ndarray,
        parity: int,
        accuracy: float | None = None,
        near: np.ndarray | None = None,
    ) -> tuple[np.ndarray, float]:
        """Solve -A u = f - E f; the accuracy is that of rounding."""
        if self.mirrored and parity == ODD:
            return self._factor(ODD).solve(values), 0.0
        solution = self._factor(EVEN).solve(np.append(values, 0.0))
        return solution[:-1], float(solution[-1])

    def resolvent(self, values: np.ndarray, parity: int, shift: float) -> np.ndarray:
        """Apply (shift - A)^-1, shift > 0, to a folded function."""
        key = shift, parity if self.mirrored else EVEN
        if key not in self._factors:
            matrix = self.matrix(parity)
            self._factors[key] = SparseFactors(shift * sp.eye_array(matrix.shape[0]) - matrix)
        return self._factors[key].solve(values)

    def stationary(self, accuracy: float | None = None) -> np.ndarray:
        """Masses of the invariant measure at the nodes of the whole grid, of sum 1."""
        one = np.zeros(self.fold(np.empty(self.size)).size + 1)
        one[-1] = 1.0
        masses = self.unfold(self._factor(EVEN).solve(one, trans="T")[:-1], EVEN)
        return masses / masses.sum()
