"""Derivatives of E exp(-z tau) for one state variable, by the adjoint kinetic equation.

With the stiffness K, the masses M and the flow G (masses times g), h solves
(z M + K) h = G d_x h. If these change by dK, dM and dG, then h changes by dh:

    (z M + K) dh - G d_x dh = r,    r = -(z dM + dK) h + dG d_x h,    dh = 0 where the flow leaves.

The adjoint equation (z M + K) w + G d_x w = s delta(x), with w = 0 where the flow enters and s the
row vector of the start, gives the derivative s dh(0) as the integral of w r over the interval.

All matrices are symmetric. So w is a sum of the modes that h is made of, with their rates reversed,
and jumps at 0 by the modes in proportion to their values at the start. The integrals are those of
products of exponentials. On the nodes this is the derivative of what `case_modes` computes.
"""

import numpy as np

from nonsmooth.grids.solver import EVEN
from nonsmooth.kinetic.case_modes import modes
from nonsmooth.kinetic.derivatives.exponentials import against, along
from nonsmooth.kinetic.ordinates_line import ChangeOfOrdinates, Ordinates


class Adjoint:
    """h and the adjoint solution in an interval, at a place z with Re z > 0.

    Modes are those that decay from the upper wall, and then those from the lower one. Results are
    for the paths that leave through the upper wall and for those through the lower one, if these
    are finite.

    Parameters
    ----------
    grid : Ordinates
        A whole one.
    z : complex
    lower, upper : float
        Of opposite signs; one may be infinite.
    """

    def __init__(self, grid: Ordinates, z: complex, lower: float, upper: float):
        self._grid, self._z, self._up, self._down = grid, z, upper, -lower
        walls = modes(grid, z)
        self._above, self._below = walls.above, walls.below
        self._rates = np.append(self._above.rates, self._below.rates)
        self._still = np.flatnonzero(grid.g == 0)
        self._balance = z * np.diag(grid.masses) + grid.stiffness[EVEN]
        self._modes = self._at_all_nodes()
        flow = (grid.masses * grid.g)[:, None]
        jumps = np.append(self._above.start, self._below.start)
        jumps = jumps / np.sum(self._modes * flow * self._modes, axis=0)
        # what is left of the modes of the upper and of the lower wall: from a wall to the start,
        # from the opposite wall to the start, and across the interval
        self._fall = self._falls(upper, -lower)
        self._climb = self._falls(-lower, upper)
        self._across = self._falls(upper - lower, upper - lower)
        self._jump = jumps[: self._many], jumps[self._many :]
        self._h, self._w = self._strengths()
        self._h_at_start = np.concatenate(
            [fall[:, None] * h for fall, h in zip(self._fall, self._h, strict=True)]
        )
        self._slopes = np.append(self._above.rates, -self._below.rates)

    def by_parameter(self, change: ChangeOfOrdinates) -> np.ndarray:
        """Differentiate E exp(-z tau) with respect to a parameter of the scene.

        Parameters
        ----------
        change : ChangeOfOrdinates

        Returns
        -------
        numpy.ndarray of complex, shape (m,)
        """
        masses = self._z * change.masses[:, None]
        return self._integrated(
            self._flowing(change.flow) - masses * self._modes - change.stiffness @ self._modes
        )

    def _flowing(self, flow):
        """Multiply a change of G by the slopes of the modes."""
        return flow[:, None] * self._modes * self._slopes

    def _integrated(self, sources):
        """Integrate the adjoint solution times r, of which each mode has a column."""
        products = self._modes.T @ sources
        (h_above, h_below), (w_above, w_below) = self._h, self._w
        climb, jump, many = self._climb, self._jump, self._many
        near_upper = np.concatenate([h_above, self._h_at_start[many:]])
        near_lower = np.concatenate([self._h_at_start[:many], h_below])
        above = np.append(jump[0] + climb[0] * w_above, w_below)
        below = np.append(w_above, climb[1] * w_below - jump[1])
        total = above @ (products * self._integrals(self._up)) @ near_upper
        total = total + below @ (products * self._integrals(self._down)) @ near_lower
        if not len(self._still):
            return total
        # where the flow stands still, w is infinite at the start
        start = self._grid.start[EVEN][self._still]
        point = np.linalg.solve(self._balance[np.ix_(self._still, self._still)], start)
        return total + point @ sources[self._still] @ self._h_at_start

    def by_levels(self) -> tuple[np.ndarray, np.ndarray]:
        """Differentiate E exp(-z tau) with respect to the distances of the two thresholds.

        An interval and a g that grow by the same factor leave it as it is, and so do thresholds
        that move with the start.

        Returns
        -------
        upper, lower : numpy.ndarray of complex, shape (m,)
            0 for a threshold that is infinitely far.
        """
        grown = self._integrated(self._flowing(-self._grid.masses * self._grid.g))
        if np.isinf(self._down):
            return grown / self._up, 0.0 * grown
        if np.isinf(self._up):
            return 0.0 * grown, grown / self._down
        moved = np.append(self._above.start, self._below.start) * self._slopes @ self._h_at_start
        length = self._up + self._down
        return (grown - self._down * moved) / length, (grown + self._up * moved) / length

    @property
    def _many(self):
        """Number of modes that decay from the upper wall."""
        return len(self._above.rates)

    def _leaving(self):
        """Nodes among those that move where the flow leaves upwards, and downwards."""
        g = self._grid.g[self._grid.moving]
        return g > 0, g < 0

    def _falls(self, above, below):
        """Parts of the modes of both walls that are left at these distances, 0 at infinite ones."""
        pairs = (self._above.rates, above), (self._below.rates, below)
        return [np.exp(-r * d) if np.isfinite(d) else np.zeros(len(r)) for r, d in pairs]

    def _at_all_nodes(self):
        """Modes at all nodes, from those at nodes that move."""
        grid, (up, down) = self._grid, self._leaving()
        if self._many != np.sum(up):  # as where g has a pole
            raise np.linalg.LinAlgError("the modes of both walls are not told apart")
        found = np.zeros((len(grid.g), len(self._rates)), complex)
        above, below = found[:, : self._many], found[:, self._many :]
        above[grid.moving[up]], above[grid.moving[down]] = self._above.own, self._above.other
        below[grid.moving[down]], below[grid.moving[up]] = self._below.own, self._below.other
        found /= np.sqrt(grid.masses)[:, None]
        if len(self._still):
            rows = self._balance[self._still]
            found[self._still] = -np.linalg.solve(rows[:, self._still], rows @ found)
        return found

    def _strengths(self):
        """Strengths at the walls, of h and of what the adjoint solution has beside its jump."""
        above, below, many = self._above, self._below, self._many
        fall, across, jump = self._fall, self._across, self._jump
        up, down = self._leaving()
        weights = np.sqrt(self._grid.masses[self._grid.moving])
        matrix = np.block(
            [[above.own, below.other * across[1]], [above.other * across[0], below.own]]
        )
        right = np.zeros((len(matrix), 3), complex)
        right[:many, 0], right[many:, 1] = weights[up], weights[down]
        right[:many, 2] = below.other @ (fall[1] * jump[1])
        right[many:, 2] = -above.other @ (fall[0] * jump[0])
        found = np.linalg.solve(matrix, right)
        exits = np.flatnonzero(np.isfinite([self._up, self._down]))
        h, w = found[:, exits], found[:, 2]
        return (h[:many], h[many:]), (w[:many], w[many:])

    def _integrals(self, length):
        """Integrals of pairs of exponentials over a stretch of x, of w in rows and h in columns.

        In h the modes of the upper wall fall from the upper end, in w from the lower one, and those
        of the lower wall the other way.
        """
        found = along(self._rates, length)
        for same in (slice(None, self._many), slice(self._many, None)):
            found[same, same] = against(self._rates[same], length)
        return found
