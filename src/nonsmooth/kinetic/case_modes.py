"""The kinetic equation of one state variable by Case's elementary solutions, exact in x.

(z - A) h = g d_x h has the solutions phi(y) exp(mu x), here called modes, with
(z - A) phi = mu g phi (Case and Zweifel, Linear Transport Theory, 1967). On a grid there are as
many as nodes with g != 0. h is a sum of modes, whose strengths follow from h = 1 where the flow
leaves the interval. A mode decays from one of the two walls; it is scaled to its value at that
wall, so that no exponential is large.
"""

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.kinetic import tuning
from nonsmooth.kinetic.ordinates_line import Ordinates


@dataclass(frozen=True)
class Modes:
    """Modes that decay from one wall.

    Attributes
    ----------
    rates : numpy.ndarray, shape (m,)
        Rates of decay, of positive real part: mu for the upper wall and -mu for the lower.
    own, other : numpy.ndarray
        Modes in columns, at the nodes where the flow leaves through their own and through the
        other wall; times the root of the masses.
    start : numpy.ndarray, shape (m,)
        Values of the modes at the start.
    """

    rates: np.ndarray
    own: np.ndarray
    other: np.ndarray
    start: np.ndarray


def modes(grid: Ordinates, z: complex) -> "ModesOfWalls":
    """Compute the modes that decay from the upper and from the lower wall.

    On a half grid, those of the lower wall are the mirror images of the others.

    Parameters
    ----------
    grid : Ordinates
    z : complex

    Returns
    -------
    ModesOfWalls
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
    # the squares are those of decay lengths, positive for real z: rounding of the smallest ones
    # may have changed their sign
    fast = np.abs(squares) < tuning.CASE_MODES.rounding * np.max(np.abs(squares))
    rates = 1 / np.sqrt(np.where(fast, np.abs(squares), squares).astype(complex))
    rates = np.where(rates.real < 0, -rates, rates)
    even_parts = rates * (even @ odd_parts + means)
    even_start = grid.start[EVEN] @ even_parts
    odd_start = grid.start[ODD] @ (rates * (odd @ even_parts[moving]))
    leaving = np.sign(g)[:, None] * odd_parts
    own, other = even_parts[moving] + leaving, even_parts[moving] - leaving
    weights = np.sqrt(grid.masses[moving])[:, None]
    return ModesOfWalls(
        grid,
        Modes(rates, weights * own, weights * other, even_start + odd_start),
        Modes(rates, weights * own, weights * other, even_start - odd_start),
    )


def modes_at_real(grid: Ordinates, z: float) -> "ModesOfWalls":
    """Compute the modes at a real place, where they are those of symmetric matrices.

    Parameters
    ----------
    grid : Ordinates
        Whole.
    z : float
        Positive.

    Returns
    -------
    ModesOfWalls

    Raises
    ------
    numpy.linalg.LinAlgError
        If rounding makes z - A singular, as where z is small and elements are fine.
    """
    matrix = grid.stiffness[EVEN] + z * np.diag(grid.masses)
    scale = 1 / np.sqrt(np.diag(matrix))
    inverses, vectors = scipy.linalg.eigh(
        np.diag(grid.masses * grid.g * scale**2), matrix * np.outer(scale, scale)
    )
    moving = grid.moving
    # the others belong to nodes with g = 0
    found = np.sort(np.argsort(-np.abs(inverses))[: len(moving)])
    vectors = scale[:, None] * vectors[:, found]
    return _told_apart(grid, 1 / inverses[found], vectors[moving], grid.start[EVEN] @ vectors)


def _pairs(regular, drift, flux, z, balance):
    """Eigenpairs of regular + drift flux / z, and flux @ vectors / z.

    For small z the second term has one very large eigenvalue, the diffusion over the whole
    interval, whose rounding errors are larger than the other eigenvalues. Then these are computed
    from the inverse of the matrix plus 1/s, s of the size of `regular`, by the formula of Sherman
    and Morrison: the large eigenvalue becomes an unimportant one. Its own eigenpair follows by the
    power method.
    """
    vast = flux @ drift / z
    size = 2 * np.linalg.norm(regular / balance[:, None] * balance, 2)
    if abs(vast) < tuning.CASE_MODES.separated * size:
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
    for _ in range(tuning.CASE_MODES.powers):
        mode = regular @ mode + drift * (flux @ mode / z)
        values[slow] = flux @ mode / (flux @ drift)
        mode = mode / values[slow]
    vectors[:, slow], means[slow] = mode, flux @ mode / z
    return values, vectors, means


def _eigen(matrix, balance):
    """Eigenpairs of a matrix, balanced by a diagonal similarity."""
    values, vectors = np.linalg.eig(matrix / balance[:, None] * balance)
    return values, vectors * balance[:, None]


def _of_all(grid, resolvent, balance):
    """Modes on a whole grid, the eigenvectors of (z - A)^-1 g."""
    moving = grid.moving
    inverses, vectors = _eigen(resolvent[moving], balance)
    rates = 1 / inverses
    return _told_apart(grid, rates, vectors, grid.start[EVEN] @ (rates * (resolvent @ vectors)))


def _told_apart(grid, rates, vectors, start):
    """Tell modes that decay from the upper wall from those of the lower, on a whole grid."""
    moving = grid.moving
    vectors = np.sqrt(grid.masses[moving])[:, None] * vectors
    up = grid.g[moving] > 0
    decay = rates.real > 0

    def decaying(chosen, rates, leaves):
        return Modes(
            rates[chosen], vectors[leaves][:, chosen], vectors[~leaves][:, chosen], start[chosen]
        )

    return ModesOfWalls(grid, decaying(decay, rates, up), decaying(~decay, -rates, ~up))


@dataclass(frozen=True)
class Waves:
    """E exp(-z tau) for the velocity at the start: the sum of `strengths` exp(-`rates` distance).

    Attributes
    ----------
    strengths, rates : numpy.ndarray, shape (m,)
        Of the modes of one wall.
    """

    strengths: np.ndarray
    rates: np.ndarray

    def at(self, distance: float) -> complex:
        """Sum at a distance from the wall."""
        return np.exp(-self.rates * distance) @ self.strengths

    def grid(self, distances: np.ndarray, further: np.ndarray) -> np.ndarray:
        """Sum at all distances[i] + further[k], neither negative."""
        far, near = (np.exp(-np.outer(part, self.rates)) for part in (distances, further))
        return (far * self.strengths) @ near.T


@dataclass(frozen=True)
class ModesOfWalls:
    """The modes at a place z, which serve walls at any distances.

    Attributes
    ----------
    grid : Ordinates
    above, below : Modes
        Those that decay from the upper and from the lower wall.
    """

    grid: Ordinates
    above: Modes
    below: Modes

    def first_passage(self, lower: float, upper: float) -> complex:
        """E exp(-z tau), tau the first time that int_0^t g leaves (lower, upper).

        Parameters
        ----------
        lower, upper : float
            Of opposite signs; one may be infinite.

        Returns
        -------
        complex
        """
        above, below = self.waves(lower, upper)
        return sum(w.at(d) for w, d in ((above, upper), (below, -lower)) if np.isfinite(d))

    def by_exit(self, lower: float, upper: float) -> np.ndarray:
        """E exp(-z tau) of the paths that leave through the upper and through the lower wall.

        Parameters
        ----------
        lower, upper : float
            Of opposite signs, both finite.

        Returns
        -------
        numpy.ndarray, shape (2,)
        """
        above, below = self.above, self.below
        start = np.append(
            above.start * np.exp(-above.rates * upper), below.start * np.exp(below.rates * lower)
        )
        return start @ self.strengths(upper - lower)

    def strengths(self, distance: float) -> np.ndarray:
        """Strengths of all modes if h = 1 where the flow leaves at one of the walls, 0 elsewhere.

        Parameters
        ----------
        distance : float
            Between the walls.

        Returns
        -------
        numpy.ndarray, shape (n, 2)
            First those of the upper wall; columns for paths that leave there, and at the lower one.
        """
        grid, above, below = self.grid, self.above, self.below
        ones = grid.ones
        if grid.mirrored:
            even, odd = (
                np.linalg.solve(above.own + sign * _arriving(above, distance), ones / 2)
                for sign in (1, -1)
            )
            strengths = np.block([[even + odd, even - odd], [even - odd, even + odd]])
            return strengths.reshape(2, -1).T
        leaves = grid.g[grid.moving] > 0
        right = np.zeros((len(ones), 2))
        many = len(above.rates)
        if many != np.sum(leaves):  # as where g has a pole
            raise np.linalg.LinAlgError("the modes of both walls are not told apart")
        right[:many, 0], right[many:, 1] = ones[leaves], ones[~leaves]
        return np.linalg.solve(_at_both_walls(above, below, distance), right)

    def waves(self, lower: float, upper: float) -> tuple[Waves, Waves]:
        """E exp(-z tau) as a function of the place in (lower, upper) at which int_0^t g begins.

        Parameters
        ----------
        lower, upper : float
            As for `first_passage`.

        Returns
        -------
        above, below : Waves
            Of the upper and of the lower wall; none where the wall is infinitely far.
        """
        grid, above, below = self.grid, self.above, self.below
        g, weights = grid.g[grid.moving], grid.ones
        up, down = (slice(None),) * 2 if grid.mirrored else (g > 0, g < 0)
        none = Waves(np.zeros(0), np.zeros(0))
        if np.isinf(lower):
            return _of_one_wall(above, below, np.abs(g[up]), np.abs(g[down]), weights[up]), none
        if np.isinf(upper):
            return none, _of_one_wall(below, above, np.abs(g[down]), np.abs(g[up]), weights[down])
        if grid.mirrored:  # by symmetry the modes of both walls have the same strengths
            strength = np.linalg.solve(above.own + _arriving(above, upper - lower), weights)
            strengths = [strength, strength]
        else:
            strengths = np.split(
                np.linalg.solve(
                    _at_both_walls(above, below, upper - lower),
                    np.concatenate([weights[up], weights[down]]),
                ),
                [len(above.rates)],
            )
        return (
            Waves(above.start * strengths[0], above.rates),
            Waves(below.start * strengths[1], below.rates),
        )


def _arriving(wall, distance):
    """Values of the modes of a wall at the opposite one."""
    return wall.other * np.exp(-wall.rates * distance)


def _at_both_walls(above, below, distance):
    """Values of the modes of both walls where paths leave: at the upper and at the lower one."""
    return np.block(
        [[above.own, _arriving(below, distance)], [_arriving(above, distance), below.own]]
    )


def _of_one_wall(wall, opposite, leaving, entering, right):
    """Sum the modes of a wall where the other wall is infinitely far.

    For Re z > 0 these are the modes that decay away from the wall. The transform is needed for
    Re z < 0, too, as an analytic continuation; there the end of the grid reflects some modes,
    which then grow. So modes are assigned to the wall by the sign of their flux <phi, g phi>. For
    Re z > 0 this is the same rule. Decay decides only where the flux is too small to tell. Modes
    that grow belong to velocities beyond the grid, so they do not contribute at the start.
    """
    own = np.hstack([wall.own, opposite.other])
    other = np.hstack([wall.other, opposite.own])
    out, back = leaving @ np.abs(own) ** 2, entering @ np.abs(other) ** 2
    flux = (out - back) / (out + back)
    decays = np.repeat([1.0, -1.0], [len(wall.rates), len(opposite.rates)])
    directed = tuning.CASE_MODES.directed
    order = np.argsort(-np.where(np.abs(flux) > directed, flux, directed * decays), stable=True)
    chosen = order[: len(right)]
    start = np.append(wall.start, np.zeros(len(opposite.rates)))
    rates = np.append(wall.rates, np.zeros(len(opposite.rates)))
    strengths = start[chosen] * np.linalg.solve(own[:, chosen], right)
    return Waves(strengths, rates[chosen])
