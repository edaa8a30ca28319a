"""First passage of x' = g out of an interval by Case's elementary solutions, exact in x.

The Laplace transform h(x, Z) = E exp(-z tau) of the exit time of x + int g solves
(z - A) h = g d_x h with h = 1 where the flow leaves: at the upper wall where g > 0, at the lower
where g < 0. It is a sum of modes phi exp(mu x) with (z - A) phi = mu g phi, as many as nodes with
g != 0; each is scaled by its value at the wall from which it decays.
"""

from dataclasses import dataclass

import numpy as np

from nonsmooth.grids.solver import EVEN, ODD

_ROUNDING = 1e-12  # of the squares of the lengths over which modes decay, relative to the longest
_SEPARATED, _POWERS = 30.0, 12  # slow eigenvalue over the others; steps until it is exact
_DIRECTED = 0.1  # flux of a wave that only one wall sends, relative to the largest possible


@dataclass(frozen=True)
class Modes:
    """Modes that decay from a wall, at the nodes where the flow leaves there or at the other wall.

    Attributes
    ----------
    rates : numpy.ndarray, shape (m,)
        |Re mu| > 0: `rates` is mu for the upper wall and -mu for the lower.
    own, other : numpy.ndarray
        Modes in columns, at the nodes where the flow leaves at their own and at the other wall.
    start : numpy.ndarray, shape (m,)
        Their values at the start.
    """

    rates: np.ndarray
    own: np.ndarray
    other: np.ndarray
    start: np.ndarray


def modes(grid, z):
    """Modes of the upper and of the lower wall; of one half grid, where they are mirror images.

    Parameters
    ----------
    grid : Ordinates
    z : complex

    Returns
    -------
    upper, lower : Modes
    """
    moving = grid.moving
    g = grid.g[moving]
    source = np.zeros((len(grid.g), len(moving)))
    source[moving, np.arange(len(moving))] = g
    balance = np.sqrt(np.abs(g) / grid.masses[moving])
    if not grid.mirrored:
        return _of_all(grid, grid.resolvent(z, EVEN, source), balance)
    even, flux = grid.regular(z, source), grid.masses @ source
    odd = grid.resolvent(z, ODD, source)
    squares, odd_parts, means = _pairs(
        odd[moving] @ even[moving], odd[moving].sum(axis=1), flux, z, balance * np.sqrt(np.abs(g))
    )
    # at real z, rounding may make the smallest negative: modes that never decay, instead of at once
    fast = np.abs(squares) < _ROUNDING * np.max(np.abs(squares))
    rates = 1 / np.sqrt(np.where(fast, np.abs(squares), squares).astype(complex))
    rates = np.where(rates.real < 0, -rates, rates)
    even_parts = rates * (even @ odd_parts + means)
    even_start = grid.start[EVEN] @ even_parts
    odd_start = grid.start[ODD] @ (rates * (odd @ even_parts[moving]))
    leaving = np.sign(g)[:, None] * odd_parts
    own, other = even_parts[moving] + leaving, even_parts[moving] - leaving
    weights = np.sqrt(grid.masses[moving])[:, None]
    return (
        Modes(rates, weights * own, weights * other, even_start + odd_start),
        Modes(rates, weights * own, weights * other, even_start - odd_start),
    )


def _pairs(regular, drift, flux, z, balance):
    """Eigenpairs of regular + drift flux / z, and flux @ vectors / z.

    Where the slow mode, about drift, is far above the others, its eigenvalue would drown them in
    rounding. They are those of the inverse plus 1/s, s of the size of `regular`, by the formula of
    Sherman and Morrison; the slow one follows by two steps of the power method.
    """
    vast = flux @ drift / z
    size = 2 * np.linalg.norm(regular / balance[:, None] * balance, 2)
    if abs(vast) < _SEPARATED * size:
        values, vectors = _eigen(regular + np.outer(drift, flux / z), balance)
        return values, vectors, flux @ vectors / z
    bounded = np.linalg.inv(np.eye(len(drift)) + regular / size)
    lost, left = bounded @ drift, flux @ bounded
    shifted = size * (
        np.eye(len(drift)) - bounded + np.outer(lost, left) / (z * size + left @ drift)
    )
    values, vectors = (part.astype(complex) for part in _eigen(shifted, balance))
    slow = np.argmin(np.abs(values - size))
    inverses = 1 / values - 1 / size
    inverses[slow] = 1 / vast
    values = 1 / inverses
    weighted = drift / balance**2
    means = weighted @ (vectors * values - regular @ vectors) / (weighted @ drift)
    mode = drift
    for _ in range(_POWERS):
        mode = regular @ mode + drift * (flux @ mode / z)
        values[slow] = flux @ mode / (flux @ drift)
        mode = mode / values[slow]
    vectors[:, slow], means[slow] = mode, flux @ mode / z
    return values, vectors, means


def _eigen(matrix, balance):
    values, vectors = np.linalg.eig(matrix / balance[:, None] * balance)
    return values, vectors * balance[:, None]


def _of_all(grid, resolvent, balance):
    moving = grid.moving
    inverses, vectors = _eigen(resolvent[moving], balance)
    rates = 1 / inverses
    start = grid.start[EVEN] @ (rates * (resolvent @ vectors))
    vectors = np.sqrt(grid.masses[moving])[:, None] * vectors
    up = grid.g[moving] > 0
    decay = rates.real > 0

    def decaying(chosen, rates, leaves):
        return Modes(
            rates[chosen], vectors[leaves][:, chosen], vectors[~leaves][:, chosen], start[chosen]
        )

    return decaying(decay, rates, up), decaying(~decay, -rates, ~up)


@dataclass(frozen=True)
class Waves:
    """E exp(-z tau) from the start's velocity, sum of `strengths` exp(-`rates` distance).

    Attributes
    ----------
    strengths, rates : numpy.ndarray, shape (m,)
        Of the modes of one wall.
    """

    strengths: np.ndarray
    rates: np.ndarray

    def at(self, distance):
        """Sum at a distance from the wall."""
        return np.exp(-self.rates * distance) @ self.strengths

    def grid(self, distances, further):
        """Sum at all distances[i] + further[k], neither negative."""
        far, near = (np.exp(-np.outer(part, self.rates)) for part in (distances, further))
        return (far * self.strengths) @ near.T


def first_passage(grid, z, lower, upper):
    """E exp(-z tau), tau the first time that int_0^t g leaves (lower, upper).

    Parameters
    ----------
    grid : Ordinates
    z : complex
    lower, upper : float
        Of opposite signs; one may be infinite.

    Returns
    -------
    complex
    """
    above, below = waves(grid, z, lower, upper)
    return sum(w.at(d) for w, d in ((above, upper), (below, -lower)) if np.isfinite(d))


def waves(grid, z, lower, upper):
    """E exp(-z tau) as a function of the place, int_0^t g beginning at one in (lower, upper).

    Parameters
    ----------
    grid, z, lower, upper
        As of `first_passage`.

    Returns
    -------
    above, below : Waves
        Of the upper and of the lower wall; none where the wall is infinitely far.
    """
    above, below = modes(grid, z)
    g, weights = grid.g[grid.moving], np.sqrt(grid.masses[grid.moving])
    up, down = (slice(None),) * 2 if grid.mirrored else (g > 0, g < 0)
    none = Waves(np.zeros(0), np.zeros(0))
    if np.isinf(lower):
        return _of_one_wall(above, below, np.abs(g[up]), np.abs(g[down]), weights[up]), none
    if np.isinf(upper):
        return none, _of_one_wall(below, above, np.abs(g[down]), np.abs(g[up]), weights[down])
    far_above, far_below = (np.exp(-m.rates * (upper - lower)) for m in (above, below))
    if grid.mirrored:  # both walls see the same
        strength = np.linalg.solve(above.own + above.other * far_above, weights)
        strengths = strength, strength
    else:
        strengths = np.split(
            np.linalg.solve(
                np.block(
                    [[above.own, below.other * far_below], [above.other * far_above, below.own]]
                ),
                np.concatenate([weights[up], weights[down]]),
            ),
            [len(above.rates)],
        )
    return (
        Waves(above.start * strengths[0], above.rates),
        Waves(below.start * strengths[1], below.rates),
    )


def _of_one_wall(wall, opposite, leaving, entering, right):
    """Sum the modes where the other wall is infinitely far.

    The solution is continued from Re z > 0, where modes decay as they leave. Beyond, those that the
    end of the grid reflects may grow: they belong to a wall by the sign of their flux <phi, g phi>,
    and what they carry is left out like all that is beyond the grid.
    """
    own = np.hstack([wall.own, opposite.other])
    other = np.hstack([wall.other, opposite.own])
    out, back = leaving @ np.abs(own) ** 2, entering @ np.abs(other) ** 2
    flux = (out - back) / (out + back)
    decays = np.repeat([1.0, -1.0], [len(wall.rates), len(opposite.rates)])
    order = np.argsort(-np.where(np.abs(flux) > _DIRECTED, flux, _DIRECTED * decays), stable=True)
    chosen = order[: len(right)]
    start = np.append(wall.start, np.zeros(len(opposite.rates)))
    rates = np.append(wall.rates, np.zeros(len(opposite.rates)))
    strengths = start[chosen] * np.linalg.solve(own[:, chosen], right)
    return Waves(strengths, rates[chosen])
