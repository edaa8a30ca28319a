"""What is asked: the variable, the interval that it leaves, and the scene that determines it."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from sympy import Symbol

from nonsmooth.checks import require_choice
from nonsmooth.errors import SceneError, quoted
from nonsmooth.scenes.formulas import MEANT
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES
from nonsmooth.scenes.thresholds import intervals


@dataclass(frozen=True)
class StateCrossing:
    """First passage of a variable of the state out of an interval.

    Attributes
    ----------
    scene : Scene
        Its observable is the variable, so that its state is what determines the variable.
    lower, upper : float
        lower < start < upper, one of them possibly infinite.
    """

    scene: Scene
    lower: float
    upper: float

    @property
    def variable(self) -> Symbol:
        """The variable that leaves the interval."""
        return next(s for s in STATE_VARIABLES if s.name == self.scene.observable)

    @property
    def followed(self) -> str | None:
        """What paths are watched for: the variable."""
        return str(self.scene.observable)

    @property
    def start(self) -> float:
        """Value of the variable at time 0."""
        return self.scene.start.get(self.scene.observable, 0.0)

    @property
    def driven(self) -> bool:
        """Whether noise acts on the variable itself, so that its paths are rough."""
        return self.variable == self.scene.noise.driven


@dataclass(frozen=True)
class IntegralCrossing(StateCrossing):
    """First passage of int g of a scene, from 0, where it is sampled like that of a variable."""

    @property
    def followed(self) -> str | None:
        """None: the integral."""
        return None

    @property
    def start(self) -> float:
        """Value of the integral at time 0."""
        return 0.0

    @property
    def driven(self) -> bool:
        """Whether noise acts on the integral itself; it does not."""
        return False


def state_crossings(
    scene: Scene, variable: str, threshold: ArrayLike
) -> tuple[list[StateCrossing], bool]:
    """Check what is asked.

    Parameters
    ----------
    scene : Scene
    variable : str
        Of the scene's state.
    threshold : array_like
        As for `scenes.thresholds.intervals`, in units of the variable.

    Returns
    -------
    asked : list of StateCrossing
        One for each threshold, all of one scene. Between walls, paths do not depend on n until they
        reach one. Where n = inf and all intervals end before the walls or at them, a finite n
        therefore replaces it.
    several : bool
        Whether it is a list of thresholds.

    Raises
    ------
    SceneError
        If there is no such variable, the start is outside, or a level is a rigid wall that throws
        back while another is beyond one, so that paths touch a level without passing it.
    """
    variable = require_choice("variable", variable, [s.name for s in scene.variables], MEANT)
    levels, several = intervals(threshold)
    scene = scene.with_observable(variable)
    found = [StateCrossing(scene, lower, upper) for lower, upper in levels.tolist()]
    for one in found:
        if not one.lower < one.start < one.upper:
            raise SceneError(
                f"{variable} starts at {one.start:g}, outside of threshold = {quoted(threshold)}; "
                "start between the levels"
            )
    wall = scene.mechanics.wall
    if variable != "x" or math.isfinite(scene.n) or math.isinf(wall):
        return found, several
    if np.all(np.abs(levels) <= wall):
        soft = scene.with_n(1.0)
        return [replace(one, scene=soft) for one in found], several
    if scene.mechanics.in_potential and np.any(np.abs(levels) == wall):
        raise SceneError(
            f"threshold = {quoted(threshold)} has a level on the rigid wall at {wall:g}, which x "
            "touches but does not pass; choose levels inside, or -1 and 1 alone"
        )
    return found, several
