"""First passage marched in time against its Laplace transform."""

import numpy as np
import pytest
from scipy.integrate import simpson

from nonsmooth.crossing.first_passage import plane
from nonsmooth.crossing.first_passage.time_stepping import PlaneProblemInTime
from references import COLORED_FRICTION, OBSTACLE


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "levels"),
    [(COLORED_FRICTION, (-0.3, 0.3)), (OBSTACLE, (-0.8, 1.2))],
    ids=["friction", "obstacle"],
)
def test_marching_agrees_with_the_transform(scene, levels):
    """The transform of the marched curve, integrated up to exp(-10), is the one solved for.

    Both are on coarse grids, good to 5e-4.
    """
    z = 0.5
    marched = PlaneProblemInTime(plane.PlaneProblem(scene, *levels))
    times = np.linspace(0.0, 20.0, 801)[1:]
    found = marched.solve(times, marched.settings.levels[0])[0]
    integral = z * simpson(np.append(0.0, np.exp(-z * times) * found), dx=times[0])
    integral += np.exp(-z * times[-1]) * found[-1]
    transform = plane.PlaneProblem(scene, *levels).transform(0, times, 0.0)
    assert integral == pytest.approx(transform(z), abs=1e-3)
