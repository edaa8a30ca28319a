"""Monomials of the state, in numpy for fits and as tables for kernels."""

import itertools
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from nonsmooth.paths.kernels.panel import STATE
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES


@dataclass(frozen=True)
class Polynomials:
    """All monomials up to a degree in the state variables, each cut off at its reach.

    A variable z enters as z / reach, and as -1 or 1 beyond.

    Attributes
    ----------
    exponents : numpy.ndarray of int, shape (terms, d)
        By increasing degree, the constant first.
    rows : tuple of int
        The variables' rows of a panel.
    driven : int
        Which of the variables the noise enters.
    reach : numpy.ndarray, shape (d,)
    """

    exponents: np.ndarray
    rows: tuple[int, ...]
    driven: int
    reach: np.ndarray

    @cached_property
    def degrees(self) -> np.ndarray:
        """Total degree of each monomial."""
        return self.exponents.sum(axis=1)

    @cached_property
    def origin(self) -> tuple[np.ndarray, np.ndarray]:
        """For each monomial, one of lower degree and the variable by which that is multiplied."""
        parents = np.zeros(len(self.exponents), dtype=np.int64)
        factors = np.zeros(len(self.exponents), dtype=np.int64)
        for k in range(1, len(self.exponents)):
            factors[k] = np.flatnonzero(self.exponents[k])[0]
            parents[k] = self._index(k, factors[k])
        return parents, factors

    @cached_property
    def slopes(self) -> tuple[np.ndarray, np.ndarray]:
        """For each monomial, its derivative by the driven variable: which one, times what."""
        power = self.exponents[:, self.driven]
        lower = [self._index(k, self.driven) if power[k] else 0 for k in range(len(power))]
        return np.array(lower), power / self.reach[self.driven]

    def _index(self, k, variable):
        """Return the place of the monomial k over a variable."""
        wanted = self.exponents[k].copy()
        wanted[variable] -= 1
        return int(np.flatnonzero(np.all(self.exponents == wanted, axis=1))[0])

    def values(self, state: np.ndarray) -> np.ndarray:
        """Evaluate the monomials, shape (terms, l), at states of the shape (d, l)."""
        z = np.clip(state / self.reach[:, None].astype(state.dtype), -1.0, 1.0)
        parents, factors = self.origin
        result = np.ones((len(parents), state.shape[1]), dtype=state.dtype)
        for k in range(1, len(parents)):
            result[k] = result[parents[k]] * z[factors[k]]
        return result


def polynomials(scene: Scene, degree: int, state: np.ndarray, margin: float) -> Polynomials:
    """Return the monomials for a scene, with a reach that holds given states with a margin."""
    used = [k for k, s in enumerate(STATE_VARIABLES) if s.name in scene.state]
    powers = itertools.product(range(degree + 1), repeat=len(used))
    exponents = sorted((m for m in powers if sum(m) <= degree), key=lambda m: (sum(m), m))
    driven = used.index(STATE_VARIABLES.index(scene.noise.driven))
    reach = margin * np.abs(state).max(axis=1)
    return Polynomials(np.array(exponents), tuple(STATE[k] for k in used), driven, reach)


def state_rows(scene: Scene) -> list[int]:
    """Return the rows of a panel that hold the scene's state."""
    return [row for row, s in zip(STATE, STATE_VARIABLES, strict=True) if s.name in scene.state]
