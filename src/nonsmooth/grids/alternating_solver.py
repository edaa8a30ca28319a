"""The Poisson equation on large tensor grids, by alternating directions and a Krylov space.

With colored noise the generator is the sum A = L + T of the noise's own generator L and of the
transport T by the oscillator's drift. L acts on the variables of the noise only, and T does not mix
different values of the noise, so that both are easily inverted: one step of alternating
directions, 2 a (a - T)^-1 (a - L)^-1 with a number a > 0, is close to -A^-1 on functions that decay
at rates near a. It preconditions GMRES.
"""

from collections.abc import Mapping

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from sympy import Symbol

from nonsmooth.errors import ToleranceError
from nonsmooth.grids import tuning
from nonsmooth.grids.direct_solver import SparseFactors
from nonsmooth.grids.elements import Axis
from nonsmooth.grids.generator import assemble
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.linear_algebra import dense
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import x


class AlternatingSolver:
    """Solver by alternating directions and GMRES, for scenes with colored noise.

    See `solver.PoissonSolver` for what it promises. A folded function is an array over the values
    of the forcing eta, the oscillator's variables, and zeta, in this order, flattened.

    Parameters
    ----------
    scene : Scene
        With a finite n and colored noise.
    axes : dict
        Maps symbols to axes, see `mesh.axes.axes`.
    mirrored : bool
        Whether to use that the drift is odd, and all functions odd or even. No node may be its own
        mirror image.
    shift : float
        The number a of the preconditioner: a rate between those at which L and T act.

    Attributes
    ----------
    scale : numpy.ndarray
        Weights of residuals and, where functions are compared, of their values.
    iterations : int
        Number that the last solution took.
    most : int
        Number after which to give up.
    """

    def __init__(self, scene: Scene, axes: Mapping[Symbol, Axis], mirrored: bool, shift: float):
        chosen = tuning.ALTERNATING_DIRECTIONS
        noise = {symbol: axes[symbol] for symbol in axes if symbol in scene.noise.drift}
        rest = {symbol: axes[symbol] for symbol in axes if symbol not in noise}
        forcing, *own = noise
        self.mirrored = mirrored
        self.most = chosen.krylov * chosen.restarts
        # Numbers of nodes: of the forcing on the whole grid and on the part that is solved on, of
        # the noise's other variable, and of the oscillator.
        self._forcing = len(axes[forcing].nodes)
        self._kept = self._forcing // 2 if mirrored else self._forcing
        self._own = int(np.prod([len(axes[symbol].nodes) for symbol in own]))
        self._oscillator = int(np.prod([len(axis.nodes) for axis in rest.values()]))
        self._shape = (self._kept, self._oscillator, self._own)
        self._noise = self._noise_matrices(scene, noise)
        self._transport = self._transport_matrices(scene, {forcing: axes[forcing]}, rest)
        self._shift = shift
        identity = sp.eye_array(self._oscillator)
        self._resolvents = [SparseFactors(shift * identity - t) for t in self._transport]
        # a product with an inverse takes half the time of two triangular solutions
        self._noise_resolvents = {
            sign: dense.inverse(shift * np.eye(len(part)) - part)
            for sign, part in self._noise.items()
        }
        self._measure = self._measure_near_origin(rest)
        # Residuals are weighted with a density, because they are to bound errors of means. Without
        # weights the corners of the box would count most. Between walls the density of the
        # displacement does not fall off, so that the weight does not depend on it.
        flat = scene.mechanics.argument if scene.mechanics.argument == x else None
        self.scale = self.fold(np.sqrt(_normal(axes, flat)))

    def _noise_matrices(self, scene, noise):
        """Return the generator L of the noise, on functions that are odd and even in it."""
        L = assemble(scene, noise).toarray()
        if not self.mirrored:
            return {ODD: L, EVEN: L}
        half = L.shape[0] // 2
        return {sign: L[:half, :half] + sign * L[:half, half:][:, ::-1] for sign in (ODD, EVEN)}

    def _transport_matrices(self, scene, forcing, rest):
        """Return the transport T by the oscillator's drift, for each value of the forcing."""
        T = assemble(scene, forcing | rest, equations=rest)
        size = self._oscillator
        return [
            T[i * size : (i + 1) * size, i * size : (i + 1) * size].tocsr()
            for i in range(self._kept)
        ]

    def _measure_near_origin(self, rest):
        """Return a measure of mass 1; the integral of a solution over it fixes the constant."""
        masses = dense.svd(self._noise[EVEN].T)[2][-1]  # spans the kernel
        masses = masses.reshape(self._kept, 1, self._own) / masses.sum()
        measure = (masses * _bump(rest)[None, :, None]).ravel()
        return measure / measure.sum()

    def unfold(self, half: np.ndarray, parity: int) -> np.ndarray:
        """Continue a function from half of the grid to all of it."""
        values = half.reshape(self._shape)
        if self.mirrored:
            values = np.concatenate([values, parity * values[::-1, ::-1, ::-1]])
        return values.transpose(0, 2, 1).ravel()

    def fold(self, whole: np.ndarray) -> np.ndarray:
        """Restrict a function to the half of the grid that is solved on."""
        values = whole.reshape(self._forcing, self._own, self._oscillator)
        return np.ascontiguousarray(values[: self._kept].transpose(0, 2, 1)).ravel()

    def _by_noise(self, values, parity, apply):
        """Apply an operator on the noise to functions of all variables.

        It conserves the parity in the oscillator's variables, and with it that in the noise's.
        """
        columns = values.transpose(0, 2, 1).reshape(-1, self._oscillator)
        if not self.mirrored:
            result = apply(parity, columns)
        else:
            half = -(-self._oscillator // 2)
            left, right = columns[:, :half], columns[:, ::-1][:, :half]
            even, odd = apply(parity, (left + right) / 2), apply(-parity, (left - right) / 2)
            result = np.empty_like(columns)
            result[:, ::-1][:, :half] = even - odd
            result[:, :half] = even + odd
        return result.reshape(self._kept, self._own, self._oscillator).transpose(0, 2, 1)

    def generator(self, values: np.ndarray, parity: int, adjoint: bool = False) -> np.ndarray:
        """Apply A, or its transpose, to a folded function."""
        values = values.reshape(self._shape)
        result = np.stack(
            [
                (t.T if adjoint else t) @ part
                for t, part in zip(self._transport, values, strict=True)
            ]
        )
        noise = {sign: part.T for sign, part in self._noise.items()} if adjoint else self._noise
        result += self._by_noise(values, parity, lambda sign, columns: noise[sign] @ columns)
        return result.ravel()

    def _precondition(self, values: np.ndarray, parity: int, adjoint: bool = False) -> np.ndarray:
        """Apply 2 a (a - T)^-1 (a - L)^-1, or its transpose, in the place of -A^-1."""
        inverse = self._noise_resolvents

        def noise(values):
            return self._by_noise(
                values,
                parity,
                lambda sign, columns: (inverse[sign].T if adjoint else inverse[sign]) @ columns,
            )

        def transport(values):
            return np.stack(
                [
                    lu.solve(part, trans="T" if adjoint else "N")
                    for lu, part in zip(self._resolvents, values, strict=True)
                ]
            )

        values = values.reshape(self._shape)
        values = noise(transport(values)) if adjoint else transport(noise(values))
        return 2 * self._shift * values.ravel()

    def _unconditioned(self, values, parity):
        """Apply the inverse of `_precondition`."""
        moved = np.stack(
            [
                self._shift * part - t @ part
                for t, part in zip(self._transport, values.reshape(self._shape), strict=True)
            ]
        )
        changed = self._by_noise(moved, parity, lambda sign, columns: self._noise[sign] @ columns)
        return (self._shift * moved - changed).ravel() / (2 * self._shift)

    def _gmres(self, right, parity, accuracy, near=None, adjoint=False):
        """Solve (-A + 1 measure') u = f; 1 is a column of ones and measure' a row.

        The integral of u over the measure is then the mean of f.
        """
        ones, measure, scale = np.ones(right.size), self._measure, self.scale
        if adjoint:
            ones, measure, scale = measure, ones, ones
        odd = self.mirrored and parity == ODD

        def solution_of(scaled):
            return self._precondition(scaled / scale, parity, adjoint)

        # preconditioned from the right, so that the residual that GMRES minimises is the true one
        def apply(scaled):
            values = solution_of(scaled)
            result = -self.generator(values, parity, adjoint)
            return scale * (result if odd else result + ones * (measure @ values))

        self.iterations = 0

        def count(_residual):
            self.iterations += 1
            if self.iterations > self.most:
                raise self._failure(accuracy)

        solution, failed = spla.gmres(
            spla.LinearOperator((right.size, right.size), apply, dtype=float),
            scale * right,
            None if near is None else scale * self._unconditioned(near, parity),
            rtol=accuracy,
            restart=tuning.ALTERNATING_DIRECTIONS.krylov,
            maxiter=tuning.ALTERNATING_DIRECTIONS.restarts,
            callback=count,
            callback_type="pr_norm",
        )
        if failed:
            raise self._failure(accuracy)
        return solution_of(solution)

    def _failure(self, accuracy):
        return ToleranceError(
            f"the Poisson equation was not solved to {accuracy:.0e} in {self.most} iterations, as "
            "in scenes that mix slowly; loosen tol or use Monte Carlo"
        )

    def solve(
        self, values: np.ndarray, parity: int, accuracy: float, near: np.ndarray | None = None
    ) -> tuple[np.ndarray, float]:
        """Solve -A u = f - E f.

        Parameters
        ----------
        values, parity, near
            As for `solver.PoissonSolver.solve`.
        accuracy : float
            Norm of the residual, weighted with a normal density, relative to that of f.

        Returns
        -------
        u, mean
            As for `solver.PoissonSolver.solve`.

        Raises
        ------
        ToleranceError
            If the iteration does not converge.
        """
        solution = self._gmres(values, parity, accuracy, near)
        if self.mirrored and parity == ODD:
            return solution, 0.0
        return solution, float(self._measure @ solution)

    def stationary(self, accuracy: float) -> np.ndarray:
        """Masses of the invariant measure at the nodes of the whole grid, of sum 1."""
        masses = self.unfold(self._gmres(self._measure, EVEN, accuracy, adjoint=True), EVEN)
        return masses / masses.sum()


def _normal(axes, flat):
    """Evaluate a normal density, up to a factor; it is constant in the variable `flat`."""
    total = np.ones(1)
    for symbol, axis in axes.items():
        depth = 0 if symbol == flat else tuning.ALTERNATING_DIRECTIONS.depth
        total = np.kron(total, np.exp(-depth * (axis.nodes / axis.edges[-1]) ** 2))
    return total


def _bump(rest):
    """Masses of a narrow measure around the origin of the oscillator's variables."""
    total = np.ones(1)
    for axis in rest.values():
        width = axis.nodes[-1] / 4
        total = np.kron(total, axis.weights * np.exp(-((axis.nodes / width) ** 2) / 2))
    return total
