"""The rate of V-uniform ergodicity against the spectral gap, and the bound of the Poisson solution."""

from nonsmooth import artifact
from nonsmooth.ergodicity import decay_rate, poisson_bound
from nonsmooth.errors import CheckError
from nonsmooth.jobs import produce
from nonsmooth.scene import Scene
from nonsmooth.spectral_gap import spectral_gap


def measure(scenes, tolerance, step, enlargement):
    """Measure every scene.

    Parameters
    ----------
    scenes : dict
        Name -> parameters of a scene with one or two state variables.
    tolerance : float
        Of the spectral gap, relative.
    step : float
        Of the semigroup.
    enlargement : float
        Of the box on which the Poisson solution is bounded.

    Returns
    -------
    xarray.Dataset
        Over the scenes.

    Raises
    ------
    CheckError
        If the decay contradicts the spectral gap, or the Poisson solution exceeds its bound where
        the box ends.
    """
    gaps, rates, bounds = [], [], []
    for name, parameters in scenes.items():
        scene = Scene(**parameters)
        gap, rate = spectral_gap(scene, tolerance), decay_rate(scene, step)
        if abs(rate.value - gap.value) > rate.error + gap.error:
            raise CheckError(
                f"{name} forgets its start at the rate {rate.value:.5g} +- {rate.error:.1g}, but its "
                f"spectral gap is {gap.value:.5g} +- {gap.error:.1g}; one of the two is wrong"
            )
        bound = poisson_bound(scene, enlargement)
        if not bound.edge < bound.enlarged:
            raise CheckError(
                f"|u| / (V + 1) of {name} is largest, {bound.edge:.3g}, where the box ends; enlarge it"
            )
        gaps.append(gap)
        rates.append(rate)
        bounds.append(bound)

    def over(results, attribute, text):
        return "scene", [getattr(result, attribute) for result in results], text

    return artifact.dataset(
        "V-uniform ergodicity and the bound of the Poisson solution",
        "spectral gap, rate at which P_t f - m(f) decays in the V-norm, sup |u| / (V + 1)",
        {"scene": ("scene", list(scenes), "name of the scene")},
        {
            "gap": over(gaps, "value", "spectral gap"),
            "gap_error": over(gaps, "error", "difference of two grids"),
            "rate": over(rates, "value", "rate of decay in the V-norm"),
            "rate_error": over(rates, "error", "what step, grid and window change"),
            "bound": over(bounds, "constant", "C of |u| <= C (V + 1) on a box"),
            "bound_error": over(bounds, "error", "difference of two grids"),
            "enlarged": over(bounds, "enlarged", "C on the enlarged box"),
            "edge": over(
                bounds, "edge", "largest |u| / (V + 1) on the surface of the enlarged box"
            ),
        },
    )


if __name__ == "__main__":
    produce(measure, snakemake)
