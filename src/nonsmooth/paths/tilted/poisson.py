"""The Poisson solution of g as a polynomial of the state, fitted to a short simulation.

From -A u = g - E g follows, over every stretch of time,

    int g - t E g + u(end) - u(begin) = int sigma d_v u dW.

The polynomial is the one for which the two sides differ least in the mean square: linear least
squares over many stretches. This takes every scene, in any number of variables.
"""

import numpy as np

from nonsmooth.errors import SceneError, ToleranceError
from nonsmooth.paths import tuning
from nonsmooth.paths.ensembles import require_finite
from nonsmooth.paths.kernels.panel import TOTAL_DELTA, new_panel
from nonsmooth.paths.kernels.random_numbers import BLOCK, labelled
from nonsmooth.paths.resolution import coarse_step
from nonsmooth.paths.schemes import registry
from nonsmooth.paths.tilted.polynomials import polynomials, state_rows
from nonsmooth.paths.tilted.tilt import Guide
from nonsmooth.paths.time_loop import EVERYWHERE, compile_march, march
from nonsmooth.progress import bar
from nonsmooth.scenes.scene import Scene


def fitted(scene: Scene, step: float, seed: int | tuple) -> Guide:
    """Fit the Poisson solution and its slope in the driven variable.

    Parameters
    ----------
    scene : Scene
    step : float
    seed : int or tuple

    Returns
    -------
    Guide
        With P_1 = sigma d_v u; the other P are 0.

    Raises
    ------
    SceneError
        If int g does not spread like a Brownian motion, or paths diverge.
    ToleranceError
        If this takes too many steps.
    """
    chosen = tuning.POISSON_FIT
    stretch = chosen.stretch * max(1.0, 1 / scene.damping)
    count = int(np.ceil(stretch / step))
    if count > chosen.most_steps:
        raise ToleranceError(
            f"importance sampling first follows paths for a time of {stretch:.2g}, {count:.1e} "
            f"steps, above {chosen.most_steps:.0e}; choose a longer step, more damping or "
            "method='monte_carlo'"
        )
    s = registry.coefficients(scene, "strang", step)
    panel = new_panel(scene, labelled(seed, "poisson"), 0)
    compile_march(s, panel)
    rows, factor = state_rows(scene), float(s.factor[0])
    march(s, panel, BLOCK, count, *EVERYWHERE)
    first = float(np.mean(panel.total[TOTAL_DELTA, :BLOCK]))
    degree = tuning.TILT.degrees[scene.dimension - 1]
    basis = polynomials(scene, degree, panel.data[rows, :BLOCK].astype(float), chosen.margin)
    used = np.flatnonzero(basis.degrees % 2 == 1 if scene.is_odd() else basis.degrees > 0)
    lower, times = (slope[used] for slope in basis.slopes)
    columns, martingales, gains = [], [], []

    def values():
        return basis.values(panel.data[rows, :BLOCK].astype(float))

    with bar("fitting", chosen.stretches * count) as advance:
        for _ in range(chosen.stretches):
            before, began = values()[used], panel.total[:, :BLOCK].copy()
            martingale = np.zeros_like(before)
            for _ in range(count):
                slope = values()[lower] * times[:, None]
                march(s, panel, BLOCK, 1, *EVERYWHERE)
                used_up = s.normals == 1 and panel.left[0] == 0
                martingale += factor * slope * panel.data[1 if used_up else 0, :BLOCK]
                advance(1)
            columns.append((martingale - values()[used] + before).T)
            martingales.append(martingale.T)
            gains.append(panel.total[TOTAL_DELTA, :BLOCK] - began[TOTAL_DELTA])
    x, gain = np.concatenate(columns), np.concatenate(gains)
    require_finite(x)
    if not scene.is_odd():
        x = np.column_stack([x, np.ones(len(x))])
    size = np.maximum(np.sqrt(np.mean(x**2, axis=0)), np.finfo(float).tiny)
    weights = np.linalg.lstsq(x / size, gain, rcond=chosen.singular)[0] / size
    own = weights[: len(used)]
    gamma2 = np.var(np.concatenate(martingales) @ own) / (count * step)
    if not gamma2 > chosen.least * np.var(gain) / (count * step):
        raise SceneError(
            "int g does not spread like a Brownian motion here, which importance sampling needs; "
            "use method='monte_carlo'"
        )
    coefficients = np.zeros((5, len(basis.degrees)))
    coefficients[0, used] = own
    np.add.at(coefficients[1], lower, own * times * factor / np.sqrt(step))
    mean = 0.0 if scene.is_odd() else weights[-1] / (count * step)
    ahead = 0.0 if scene.is_odd() and not scene.start else first - mean * count * step
    white = scene.noise.kind == "white"
    kept = (tuning.TILT.kept_white if white else tuning.TILT.kept) * coarse_step(scene)
    return Guide(basis, coefficients, float(mean), float(np.sqrt(gamma2)), kept, ahead)
