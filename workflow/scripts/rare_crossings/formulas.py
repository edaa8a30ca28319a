"""The asymptotic formula for far thresholds and, with white noise, its first correction."""

import numpy as np

from nonsmooth.boundary_layer.extrapolation_length import extrapolation_length
from nonsmooth.crossing.brownian import asymptotic_crossing
from nonsmooth.scenes.scene import Scene
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

POINTS = 60  # of a curve
ACCURATE = 0.05  # error of kappa over gamma: the curve moves by less than its width


def formulas(limit, scenes, p, horizon):
    """Evaluate both formulas from half of the first threshold of each scene to its last one.

    Parameters
    ----------
    limit : xarray.Dataset
        With gamma^2 of each scene.
    scenes : dict
        Name -> the scene's parameters and its thresholds.
    p, horizon : float

    Returns
    -------
    xarray.Dataset
        Over (scene, point); the corrected one over (solved, point).
    """
    thresholds, rows = [], {"asymptotic": [], "corrected": []}
    solved = []
    for name, parameters in scenes.items():
        scene, own = Scene(**parameters["scene"]), parameters["thresholds"]
        gamma2, error = (float(limit[key].sel(scene=name)) for key in ("gamma2", "gamma2_error"))
        thresholds.append(np.linspace(own[0] / 2, own[-1], POINTS))
        rows["asymptotic"].append(_curve(thresholds[-1], horizon, gamma2, error))
        if scene.noise.kind == "white":  # kappa is solved for in seconds
            kappa = extrapolation_length(scene, ACCURATE * np.sqrt(gamma2)).value
            # a level moved beyond the start is crossed at once
            moved = np.maximum(thresholds[-1] + kappa / np.sqrt(p), thresholds[-1][0] / 100)
            rows["corrected"].append(_curve(moved, horizon, gamma2, error))
            solved.append(name)
    asymptotic, asymptotic_error = np.moveaxis(rows["asymptotic"], 1, 0)
    corrected, corrected_error = np.moveaxis(rows["corrected"], 1, 0)
    return artifact.dataset(
        "Formulas for rare threshold crossings",
        f"p = {p}, T = {horizon}",
        {
            "scene": ("scene", list(scenes), "name of the scene"),
            "solved": ("solved", solved, "name of a scene whose kappa is known"),
        },
        {
            "threshold": (("scene", "point"), thresholds, "threshold b"),
            "asymptotic": (("scene", "point"), asymptotic, "W_star(b / gamma, T)"),
            "asymptotic_error": (("scene", "point"), asymptotic_error, "inherited from gamma^2"),
            "corrected": (
                ("solved", "point"),
                corrected,
                "W_star((b + kappa / sqrt(p)) / gamma, T)",
            ),
            "corrected_error": (("solved", "point"), corrected_error, "inherited from gamma^2"),
        },
    )


def _curve(thresholds, horizon, gamma2, error):
    """Evaluate W_star at many thresholds; values and errors."""
    pairs = [asymptotic_crossing(b, np.array([horizon]), gamma2, error) for b in thresholds]
    return np.array(pairs)[..., 0].T


if __name__ == "__main__":
    produce(formulas, snakemake)
