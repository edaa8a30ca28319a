"""By how much the noise of a path is shifted, given its state and its distance to a level.

Let W(d, s) be the probability that the Brownian limit covers a distance d within the time s. To
first order, the probability to reach the level b within s from the state z is W(b + kappa - D - u,
s), D = int g and u(z) the Poisson solution. Doob's transform with it adds theta dt to the noise,

    theta = sigma d_v u(z) q,    q = -d_d log W,

v being the variable that noise enters. A guide replaces sigma d_v u by polynomials P in the state,

    theta = q (P_1 + q P_2 + q^2 P_3 + exp(-lambda s) P_4),

which also hold for large deviations, where the response to a large q is not linear, and for the
last moments, in which the process is no Brownian motion. As q grows without bound towards the end,
c q / (c + q) stands for it, c being the q of a straight way to the level or a fixed one.
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from nonsmooth.paths import tuning
from nonsmooth.paths.kernels.panel import STATE
from nonsmooth.paths.tilted.polynomials import Polynomials


class Tilt(NamedTuple):
    """What kernels know of a guide towards one level.

    `parent` and `variable` make each monomial from another one; `width` are the inverse reaches of
    the state variables. A row of `term` has four monomials, that of `coefficient` what they are
    multiplied by in the polynomial `output` (0 for u, 1 to 3 for P), and that of `last` what this
    gains times exp(-lambda s). `side` is 1 for the upper level and -1 for the lower, `target` the
    level times `side` plus kappa, `mean` that of g, `gamma` the root of gamma^2, `due` the time
    by which the level is to be reached, `end` that with a while added, `haste` is lambda, `cap`
    is c, `bound` the largest theta, and `kept` the time for which theta is kept.
    """

    parent: np.ndarray
    variable: np.ndarray
    width: np.ndarray
    output: np.ndarray
    term: np.ndarray
    coefficient: np.ndarray
    last: np.ndarray
    side: Any
    target: float
    mean: float
    gamma: float
    due: float
    end: float
    haste: float
    cap: Any
    bound: float
    kept: float


@dataclass(frozen=True)
class Aim:
    """The level that paths are to reach first, and by when.

    Attributes
    ----------
    side : int
        1 for the upper level, -1 for the lower one.
    levels : (float, float)
        Lower and upper level of int g, at which paths end.
    time : float
    """

    side: int
    levels: tuple[float, float]
    time: float

    @property
    def distance(self) -> float:
        """Distance of the level from 0."""
        return abs(self.levels[(1 + self.side) // 2])

    def nearer(self, part: float) -> "Aim":
        """Return the same aim at a part of the distance."""
        lower, upper = self.levels
        own = (lower, part * upper) if self.side > 0 else (part * lower, upper)
        return replace(self, levels=own)


@dataclass(frozen=True)
class Guide:
    """Polynomials of the state that shift the noise.

    Attributes
    ----------
    basis : Polynomials
    coefficients : numpy.ndarray, shape (5, terms)
        Of u and of P_1 to P_4.
    mean, gamma : float
        The stationary mean of g and the root of gamma^2.
    kept : float
        Time for which a shift is kept.
    ahead : float
        By how much the start takes int g farther than the mean does, in the long run.
    kappa : float
        By how much the level seems to be farther away.
    """

    basis: Polynomials
    coefficients: np.ndarray
    mean: float
    gamma: float
    kept: float
    ahead: float = 0.0
    kappa: float = 0.0

    def towards(self, aim: Aim, precision: str = "float32") -> Tilt:
        """Return what kernels need to shift the noise towards a level."""
        number = np.dtype(precision).type
        parent, factor = self.basis.origin
        rows = np.array(self.basis.rows) - STATE[0]
        width = np.ones(len(STATE), number)
        width[rows] = 1 / self.basis.reach
        output, term = self._by_fours()
        always, last = self.coefficients[:4], np.zeros_like(self.coefficients[:4])
        last[1] = self.coefficients[4]
        filled, used = np.maximum(term, 0), term >= 0
        always, last = (used * part[output[:, None], filled] for part in (always, last))
        return Tilt(
            parent,
            rows[factor],
            width,
            output,
            filled,
            always.astype(number),
            last.astype(number),
            number(aim.side),
            float(aim.distance + self.kappa),
            float(self.mean),
            float(self.gamma),
            float(aim.time),
            float(aim.time + tuning.TILT.pause),
            float(tuning.TILT.haste),
            number(self.largest_rate(aim)),
            float(tuning.TILT.bound * self.gamma * self.largest_rate(aim)),
            float(self.kept),
        )

    def _by_fours(self):
        """Terms of u and P_1 to P_3, four of one polynomial at a time, filled up with -1."""
        used = self.coefficients[:4] != 0
        used[1] |= self.coefficients[4] != 0
        output, rows = [], []
        for polynomial, terms in enumerate(map(np.flatnonzero, used)):
            filled = np.pad(terms, (0, -len(terms) % 4), constant_values=-1).reshape(-1, 4)
            output += len(filled) * [polynomial]
            rows.append(filled)
        return np.array(output, dtype=np.int64), np.concatenate(rows)

    def rate(self, aim: Aim, left: float, covered: np.ndarray) -> np.ndarray:
        """Return q with its sign at the time `left` before the end; `covered` is D + u."""
        scale = 1 / (self.gamma * np.sqrt(left + tuning.TILT.pause))
        target = aim.distance + self.kappa - aim.side * self.mean * left
        away = np.maximum(target - aim.side * covered, 0.0) * scale
        hazard = (1 - 1 / np.pi) * away + np.sqrt((away / np.pi) ** 2 + 2 / np.pi)
        q, cap = scale * hazard, self.largest_rate(aim)
        return aim.side * q * cap / (q + cap)

    def largest_rate(self, aim: Aim) -> float:
        """Return the bound of q; more would give single paths large weights."""
        typical = aim.distance / (self.gamma * aim.time)
        return max(tuning.TILT.least_cap, tuning.TILT.share * typical) / self.gamma
