"""What is asked: the variable, the interval that it leaves, and the scene that determines it."""

import math
from dataclasses import dataclass

from numpy.typing import ArrayLike
from sympy import Symbol

from nonsmooth.checks import require_choice
from nonsmooth.errors import SceneError, quoted
from nonsmooth.scenes.formulas import MEANT
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES
from nonsmooth.scenes.thresholds import bounds


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


def state_crossing(scene: Scene, variable: str, threshold: ArrayLike) -> StateCrossing:
    """Check what is asked.

    Parameters
    ----------
    scene : Scene
    variable : str
        Of the scene's state.
    threshold : float or (float, float)
        As for `scenes.thresholds.bounds`, in units of the variable.

    Returns
    -------
    StateCrossing
        Between walls, paths do not depend on n until they reach one. Where n = inf and the interval
        ends before the walls or at them, a finite n therefore replaces it.

    Raises
    ------
    SceneError
        If there is no such variable, the start is outside, or a level is a rigid wall that throws
        back while the other is beyond one, so that paths touch a level without passing it.
    """
    variable = require_choice("variable", variable, [s.name for s in scene.variables], MEANT)
    lower, upper = bounds(threshold)
    scene = scene.with_observable(variable)
    found = StateCrossing(scene, lower, upper)
    if not lower < found.start < upper:
        raise SceneError(
            f"{variable} starts at {found.start:g}, outside of threshold = {quoted(threshold)}; "
            "start between the levels"
        )
    wall = scene.mechanics.wall
    if variable != "x" or math.isfinite(scene.n) or math.isinf(wall):
        return found
    if -wall <= lower and upper <= wall:
        return StateCrossing(scene.with_n(1.0), lower, upper)
    if scene.mechanics.in_potential and (lower == -wall or upper == wall):
        raise SceneError(
            f"threshold = {quoted(threshold)} has a level on the rigid wall at {wall:g}, which x "
            "touches but does not pass; choose a level inside, or -1 and 1"
        )
    return found
