"""What a first-passage problem is: the contract between `distribution` and those who solve it.

Asked is P(tau <= t), tau the first time at which int_0^t g leaves an interval (lower, upper).
`distribution` solves a problem on finer and finer levels until two of them agree. It takes two
kinds of problems. A `LaplaceProblem` can compute the Laplace transform E exp(-z tau), which
`inversion` inverts. A `DirectProblem` computes the probabilities themselves. Both say in a record
of `Settings` how accurate they are. The page `docs/how_to/add_a_first_passage_problem.md` has an
example.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from nonsmooth.scenes.scene import Scene


@dataclass(frozen=True)
class Settings:
    """How accurate a problem is, and on which levels it is solved.

    Attributes
    ----------
    default_tolerance : float
        Absolute error of probabilities unless the user asks for another.
    coarse_tolerance : float
        A tolerance at least so large begins with the first level, a smaller one with the second.
    levels : tuple
        Levels of resolution, from coarse to fine. Errors should fall by a factor of two at least
        from one to the next, for the difference of two levels is taken as the error.
    relative : bool
        Whether the relative error of small probabilities, and of small survival probabilities if
        both thresholds are finite, is small. The difference of two levels at one time then counts
        at a neighbouring time in proportion to the probability.
    least_probability : float
        Probabilities that can be shown to be smaller are returned as 0, with this as their error.
    unseen_error : float
        Relative error of the probability that all levels have in common, so that no comparison of
        levels shows it.
    advice : str
        What a user can do whose tolerance is not met; the end of an error message.
    """

    default_tolerance: float
    coarse_tolerance: float
    levels: tuple
    relative: bool
    least_probability: float
    unseen_error: float
    advice: str


class ContourLevel(NamedTuple):
    """A level of resolution of a `LaplaceProblem`.

    Attributes
    ----------
    resolution : object
        Of the transform, handed on to `LaplaceProblem.transform`.
    nodes : int
        Of a hyperbolic contour that serves a single time.
    spacing : float
        Of the nodes of a contour through a saddle point, relative to what ten digits need.
    """

    resolution: Any
    nodes: int
    spacing: float


@dataclass(frozen=True)
class Part:
    """A part of a resolution.

    Attributes
    ----------
    first, last : int
        Resolution to begin with, and the finest.
    step : {1, -1}
        Whether it is compared with the next finer resolution, or with the next coarser one.
    falls : float
        What a resolution changes, over what the one before has changed: at least, for an error.
    coarser : bool
        Whether it begins with the resolution before `first` for a loose tolerance.
    beyond : float
        Over a change to the next finer resolution, the sum of all that would follow, if this is
        known: such changes are extrapolated. 1/3 for a method of order 2 and halved steps.
    counted : float
        Share of a change that is its error: less than 1 if those that would follow are far smaller.
    """

    first: int
    last: int
    step: int
    falls: float = 0.1
    coarser: bool = False
    beyond: float = 0.0
    counted: float = 1.0


@dataclass(frozen=True)
class ContourSettings(Settings):
    """Settings of a problem whose Laplace transform is inverted; `levels` are `ContourLevel`.

    Attributes
    ----------
    least_transform : float
        Values of the transform on the real axis below are taken to be rounding.
    window : float
        Last time over first time that a contour through a saddle point serves.
    rise_truncation, steady_truncation : float
        Size of a term, relative to the first, at which a contour ends: for contours through a
        saddle point, which serve while the probability is still small, and for hyperbolas.
    """

    least_transform: float
    window: float
    rise_truncation: float
    steady_truncation: float


class FirstPassageProblem(ABC):
    """First passage of int_0^t g out of an interval: what both kinds of problems have.

    Attributes
    ----------
    scene : Scene
        With E g = 0 and a start.
    lower, upper : float
        lower < 0 < upper, one of them possibly infinite.
    """

    scene: Scene
    lower: float
    upper: float

    @property
    @abstractmethod
    def settings(self) -> Settings:
        """How accurate the problem is, and its levels."""

    @property
    def two_sided(self) -> bool:
        """Whether both thresholds are finite."""
        return bool(np.isfinite(self.lower) and np.isfinite(self.upper))


class LaplaceProblem(FirstPassageProblem):
    """A problem that computes the Laplace transform F(z) = E exp(-z tau).

    F must be real on the real axis, F(0) = 1 if int g leaves the interval surely, and, as an
    analytic continuation, be computed for Re z < 0, too, where it has poles on or near the axis.
    `np.linalg.LinAlgError` says that it has no value at a point.
    """

    @property
    @abstractmethod
    def settings(self) -> ContourSettings:
        """How accurate the problem is, and its levels."""

    @property
    def on_vertical_lines(self) -> bool:
        """Whether F is inverted on vertical lines, because contours that bend come near poles."""
        return False

    def parts(
        self, resolution: Any, times: np.ndarray, rarity: float
    ) -> tuple[Callable[[complex], np.ndarray], np.ndarray]:
        """Parts of F and the times before which they contribute nothing, for vertical lines.

        Parameters
        ----------
        resolution, times, rarity
            As for `transform`.

        Returns
        -------
        parts : callable
            Takes z, returns values of the sum F(z), shape (m,).
        fronts : numpy.ndarray, shape (m,)
        """
        transform = self.transform(resolution, times, rarity)
        return lambda z: np.array([transform(z)]), np.zeros(1)

    def parts_on_line(
        self,
        parts: Callable[[complex], np.ndarray],
        of_grid: tuple[Any, np.ndarray, float],
        abscissa: float,
        accuracy: float,
    ) -> tuple[Callable[[complex], np.ndarray], float]:
        """Parts of F at many places of a vertical line, as cheaply as an accuracy allows.

        Parameters
        ----------
        parts : callable
            What `parts` returns.
        of_grid : tuple
            The arguments with which it does.
        abscissa : float
            Re z; positive.
        accuracy : float
            Wanted of F, relative to its value on the real axis.

        Returns
        -------
        parts : callable
            The same, or others that are nearly the same on the line.
        inexact : float
            What they are off, relative to that value.
        """
        return parts, 0.0

    @abstractmethod
    def coarse_transform(self, radius: float, depth: float) -> Callable[[complex], complex]:
        """Return F on a coarse grid, good to a few digits, for the choice of contours.

        Parameters
        ----------
        radius : float
            |z| of the points at which it is wanted, on the positive axis and off it.
        depth : float
            The value on the axis is of the order exp(-depth).
        """

    @abstractmethod
    def transform(
        self, resolution: Any, times: np.ndarray, rarity: float
    ) -> Callable[[complex], complex]:
        """Return F on a grid that serves given times.

        Parameters
        ----------
        resolution : object
            That of a level.
        times : numpy.ndarray, shape (k,)
            Times of a window, or of all windows between the rise and the end, increasing; z will be
            of the size of their inverses.
        rarity : float
            If the settings are `relative`: probabilities from exp(-rarity) on are wanted to
            relative accuracy. At the first of the times.
        """


class DirectProblem(FirstPassageProblem):
    """A problem that computes the probabilities themselves, such as by steps in time."""

    @abstractmethod
    def solve(self, times: np.ndarray, level: Any) -> np.ndarray:
        """Probability and survival probability on one level.

        Parameters
        ----------
        times : numpy.ndarray, shape (k,)
            Increasing, positive.
        level : object
            An entry of `settings.levels`.

        Returns
        -------
        numpy.ndarray, shape (2, k)
        """
