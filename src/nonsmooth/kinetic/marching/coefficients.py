"""Split steps with exp(A t) as a dense matrix, for a grid whose values need not be at nodes."""

import numpy as np

from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic.marching.split_step import Interval, SplitStep
from nonsmooth.kinetic.ordinates_plane import PlaneOrdinates
from nonsmooth.linear_algebra import dense


class CoefficientSteps(SplitStep):
    """Steps on a grid of half of the state, on which functions are even or odd.

    Parameters
    ----------
    grid : PlaneOrdinates
    interval : Interval
    step : float
    """

    def __init__(self, grid: PlaneOrdinates, interval: Interval, step: float):
        many, columns = len(grid.speeds), np.ones(len(interval.kept))
        even, odd = grid.start[EVEN], grid.start[ODD]
        dtype = np.result_type(grid.generator[EVEN].dtype, interval.forward)
        whole = np.outer(grid.ones, columns).astype(dtype)
        start = np.array([even[:many] + odd[:many], even[:many] - odd[:many]]) / 2
        super().__init__(interval, grid.speeds, start, whole[:many], whole[:many].copy(), step)
        self._still = {EVEN: whole[many:], ODD: np.zeros((len(odd) - many, len(columns)), dtype)}
        self._still_start = {EVEN: even[many:], ODD: odd[many:]}
        with np.errstate(over="ignore", invalid="ignore"):  # is found to be unstable
            self._mixing = {
                parity: dense.exponential(step * grid.generator[parity].toarray())
                for parity in (EVEN, ODD)
            }

    @property
    def operations(self) -> float:
        """Additions and multiplications of a step."""
        mixed = sum(matrix.size for matrix in self._mixing.values())
        return super().operations + 2.0 * mixed * self.there.shape[1]

    def mix(self) -> None:
        """Apply exp(A t) to the even and to the odd part."""
        many, parts = len(self.there), {}
        for parity in (EVEN, ODD):
            moving = (self.there + parity * self.opposite) / 2
            mixed = self._mixing[parity] @ np.vstack([moving, self._still[parity]])
            parts[parity], self._still[parity] = mixed[:many], mixed[many:]
        self.there, self.opposite = parts[EVEN] + parts[ODD], parts[EVEN] - parts[ODD]

    def doubled(self) -> None:
        """Make the step twice as long."""
        super().doubled()
        self._mixing = {parity: matrix @ matrix for parity, matrix in self._mixing.items()}

    def survival(self) -> complex:
        """Return q at x = 0 and the start of the state, after half a transport."""
        still = (self._still_start[p] @ (self._still[p] @ self.interval.kept) for p in (EVEN, ODD))
        return super().survival() + sum(still)
