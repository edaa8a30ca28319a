"""Rate of V-uniform ergodicity against the spectral gap, and bound of the Poisson solution."""

from nonsmooth.scenes.relaxation import rate_at_infinity
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.spectral_gap import spectral_gap
from nonsmooth.theory.ergodicity import decay_rate, poisson_bound
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


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
        If the decay contradicts the spectral gap, or |u| / (V_n + 1) is largest where the box
        ends.
    """
    gaps, rates, far, bounds = [], [], [], []
    for name, parameters in scenes.items():
        scene = Scene(**parameters)
        gap, rate = spectral_gap(scene, tolerance), decay_rate(scene, step)
        if not abs(rate.value - gap.value) <= rate.error + gap.error:
            raise CheckError(
                f"{name} forgets its start at the rate {rate.value:.5g} +- {rate.error:.1g}, but "
                f"its spectral gap is {gap.value:.5g} +- {gap.error:.1g}; one of the two is wrong"
            )
        bound = poisson_bound(scene, enlargement)
        if not bound.edge < bound.constant - bound.error:
            raise CheckError(
                f"|u| / (V + 1) of {name} is {bound.edge:.3g} where the box ends, within the error "
                f"of its largest value {bound.constant:.3g}; choose a larger enlargement"
            )
        gaps.append(gap)
        rates.append(rate)
        far.append(rate_at_infinity(scene))
        bounds.append(bound)

    def over(values, text):
        return "scene", list(values), text

    return artifact.dataset(
        "V-uniform ergodicity and the bound of the Poisson solution",
        "spectral gap, rate at which P_t f - m(f) decays in the V-norm, sup |u| / (V + 1)",
        {"scene": ("scene", list(scenes), "name of the scene")},
        {
            "gap": over((gap.value for gap in gaps), "spectral gap"),
            "gap_error": over((gap.error for gap in gaps), "difference of two grids, rounding"),
            "rate": over((rate.value for rate in rates), "rate of decay in the V-norm on a box"),
            "rate_error": over(
                (rate.error for rate in rates), "what step, grid and earlier times change"
            ),
            "far": over((rate.value for rate in far), "rate of decay of P_t V / V at infinity"),
            "far_error": over((rate.error for rate in far), "difference of two distances"),
            "bound": over((bound.constant for bound in bounds), "C of |u| <= C (V + 1)"),
            "bound_error": over((bound.error for bound in bounds), "what grid and box change"),
        },
    )


if __name__ == "__main__":
    produce(measure, snakemake)
