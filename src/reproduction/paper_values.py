"""The numbers that the text of the paper quotes, spelt as they stand there.

`paper_values` collects them; each other public function does so for one section of the paper. All
numbers are strings, and computed ones carry their full value and error (`Quoted`). Formulas and
numbers in scientific notation are Typst mathematics.
"""

import json
from collections.abc import Mapping

import numpy as np
import tylax
import xarray as xr
from sympy import latex

from nonsmooth.scenes.formulas import parse
from nonsmooth.scenes.symbols import eta, x
from reproduction.plasticity import relaxation_time
from reproduction.rendering.printed import printed_values
from reproduction.rendering.quoted import (
    BOUND,
    EFFECTIVE,
    ERROR,
    INTERVAL,
    STANDARD,
    Quoted,
    decimal,
)
from reproduction.rendering.tables import penalization, scientific

SIGNIFICANT = 3.0  # standard errors; the text calls the formula too low if it is lower by more

CONSTANTS = ("diffusion", "kappa", "dispersion", "dipole", "kappa3", "h")


def paper_values(artifacts: Mapping, settings: Mapping) -> dict:
    """Collect the numbers of all sections.

    Parameters
    ----------
    artifacts : mapping
        Datasets by the names of the rule's inputs; `convergence` is a list with one for each n.
    settings : mapping
        Sections of the configuration by the names of the rule's parameters.

    Returns
    -------
    dict
        Section -> dict, nested, of strings.
    """
    a, s = artifacts, settings
    return {
        "variance": variance(a["spectral"], a["monte_carlo"], a["agreement"], s["variance"]),
        "convergence": convergence(
            a["convergence"], a["convergence_check"], s["horizon"], s["scheme"]
        ),
        "crossing": crossing(a["crossing"], s["sweep"]),
        "finite_p": finite_p(a["contained"], a["formulas"], s["finite_p"]),
        "trajectories": trajectories(s["trajectories"]),
        "sweep": every_scene(a["limit"], s["scenes"]),
        "rare_crossings": rare_crossings(a["rare"], s["rare_crossings"]),
        "density": density(s["density"]),
        "theorems": theorems(a["drift_condition"], s["theorems"]),
        "ergodicity": ergodicity(
            a["ergodicity"], s["theorems"]["ergodicity"], s["scenes"]["scenes"]
        ),
        "limit_theorem": limit_theorem(a["theorem"], s["limit_theorem"]),
        "rates": rates(a["rates"], s["limits"]),
        "crossing_rates": crossing_rates(a["crossing_rates"], s["limits"]),
        "plasticity": plasticity(a["deformation"], a["deformation_variance"], s["plasticity"]),
        "errata": errata(a["errata"]),
        "seed": str(s["seed"]),
    }


def variance(
    spectral: xr.Dataset, monte_carlo: xr.Dataset, agreement: xr.Dataset, section: Mapping
) -> dict:
    """Return the errors of the three methods of figure 2a, and how far they agree."""
    scheme = section["finite_difference"]
    deterministic_error = spectral["v_error"] / spectral["tau"]
    sampled = {
        name: float((monte_carlo[name] / monte_carlo["tau"])[-1])
        for name in ("v_error", "bias", "bias_error")
    }
    gamma2, gamma2_error = float(spectral["gamma2"]), float(spectral["gamma2_error"])
    return {
        "n": _short(section["scene"]["n"]),
        "gamma2": decimal(gamma2, 15, gamma2_error, BOUND),
        "gamma2_error": _bound(spectral["gamma2_error"]),
        "rounded": decimal(gamma2, 4, gamma2_error, BOUND),
        "printed": str(printed_values("fig:fpn-cmp-PDE-MC")["asymptotic_value"]),
        "horizon": _short(spectral["tau"].values[-1]),
        "deterministic_error": _bound(deterministic_error.max()),
        "nodes": str(scheme["nodes"]),
        "time_step": _short(scheme["time_step"]),
        "half_width": _short(scheme["half_width"]),
        "paths": _count(monte_carlo["paths"]),
        "step": _short(section["monte_carlo"]["step"]),
        "standard_error": _error(sampled["v_error"]),
        "bias": Quoted(_power(sampled["bias"]), sampled["bias"], sampled["bias_error"], STANDARD),
        "finite_difference_agreement": decimal(agreement["finite_difference"].max(), 2),
        # it is in units of `threshold` standard errors
        "monte_carlo_agreement": decimal(
            agreement["monte_carlo"].max(), 2, 1 / float(agreement["threshold"])
        ),
        "threshold": decimal(agreement["threshold"], 2),
        "false_alarm": _power(agreement["false_alarm"]),
    }


def convergence(
    solutions: list[xr.Dataset], agreement: xr.Dataset, horizon: float, scheme: Mapping
) -> dict:
    """Return the largest errors and deviations of table 4, and the sizes of the paper's scheme."""
    return {
        "finite_difference_agreement": decimal(agreement["finite_difference"].max(), 2),
        "horizon": _short(horizon),
        "v_over_time_error": _bound(max(run["v_over_time_error"] for run in solutions)),
        "gamma2_error": _bound(max(run["gamma2_error"] for run in solutions)),
        "half_width": _short(scheme["half_width"]),
        "nodes": _short(scheme["nodes"]),
        "time_step": _short(scheme["time_step"]),
    }


def crossing(check: xr.Dataset, section: Mapping) -> dict:
    """Return the sizes of figure 2b and its distance to the limit at the largest p."""
    largest = check.isel(p=-1)
    return {
        "n": _short(section["scene"]["n"]),
        "threshold": _short(section["threshold"]),
        "horizon": _short(section["horizon"]),
        "paths": _count(section["paths"]),
        "step": _short(section["step"]),
        "p": _list(section["p"]),
        "largest_p": _short(largest["p"]),
        "distance": decimal(largest["distance"], 4, largest["standard_error"]),
        "standard_error": decimal(largest["standard_error"], 4, 0, ERROR),
        "ratio": decimal(largest["distance"] / largest["standard_error"], 0, 1),
    }


def finite_p(contained: xr.Dataset, formulas: xr.Dataset, section: Mapping) -> dict:
    """Return constants and errors of the corrected formulas, and how often bands cover curves."""
    constants_error = max(float(formulas[f"{name}_error"]) for name in CONSTANTS)
    slopes = zip(formulas["slope"].values, formulas["slope_error"].values, strict=True)
    percent = {
        name: decimal(100 * contained[name], 1, 100 * contained[error], kind)
        for name, error, kind in (
            ("share", "spread", STANDARD),
            ("expected", "expected_standard_error", STANDARD),
            ("spread", "spread_standard_error", STANDARD),
            ("least", "least_half_interval", INTERVAL),
        )
    }
    return (
        {name: decimal(formulas[name], 8, formulas[f"{name}_error"], BOUND) for name in CONSTANTS}
        | {
            "constants_error": _bound(constants_error),
            "horizons": _list(section["horizons"]),
            "tabulated": _short(section["tabulated"]),
            "tolerance": _power(section["tolerance"]),
            "first_time": _short(section["first_time"]),
            "fit_from": _short(section["fit_from"]),
            "slopes": [decimal(slope, 2, error, BOUND) for slope, error in slopes],
            "rarely": _power(contained["rarely"]),
            "outside": _power(contained["outside"]),
            "standard_errors": decimal(contained["standard_errors"].max(), 1, 1),
        }
        | percent
        | _formula_errors(formulas)
    )


def _formula_errors(formulas):
    """Largest errors for each p, where the exact values resolve those of order 2.

    Also the p from which on order 2 is better than order 1.
    """
    p, distance, error = (formulas[name] for name in ("p", "distance", "distance_error"))
    p = p.values
    first, second = (distance.sel(formula=name).values for name in ("order 1", "order 2"))
    resolved = formulas["resolved"].any("horizon")
    known = resolved.sel(formula="order 2").values
    better = p[p > max(p[known & (second >= first)], default=0.0)]
    return {
        "errors": [
            {
                "p": _short(scale),
                "values": [
                    Quoted(_power(distance[i, k]), distance[i, k], error[i, k], BOUND)
                    if resolved[i, k]
                    else None
                    for i in range(formulas.sizes["formula"])
                ],
            }
            for k, scale in enumerate(p)
            if known[k]
        ],
        "order_2_better": _short(better[0]) if better.size else "oo",
    }


def trajectories(section: Mapping) -> dict:
    """Return what figures 3 to 5 assume."""
    return {
        "step": _short(section["step"]),
        "models": {
            _words(model): {
                "potential": parameters["potential"],
                "damping": _short(parameters["damping"]),
            }
            for model, parameters in section["models"].items()
        },
    }


def every_scene(limit: xr.Dataset, section: Mapping) -> dict:
    """Return the sizes of table 6 and figure 6."""
    times = section["variance"]["times"]
    longer = [entry["long_step"] for entry in section["scenes"].values()]
    return {
        "paths": _count(section["paths"]),
        "step": _short(section["step"]),
        "measured": _short(section["measured"]),
        "long_steps": [_short(min(longer)), _short(max(longer))],
        "settled": _short(times[0]),
        "end": _short(times[-1]),
        "horizon": _short(section["horizon"]),
        "n": ", ".join(
            sorted({_short(entry["scene"]["n"]) for entry in section["scenes"].values()})
        ),
        "allowed": _short(limit["allowed"]),
        "standard_error": f"{0.5 / section['paths'] ** 0.5 + 5e-5:.4f}",  # rounded up
    }


def rare_crossings(runs: list[xr.Dataset], section: Mapping) -> dict:
    """Return the scale of table 11, its smallest probability and its largest relative error."""
    relative = max(float((run["probability_error"] / run["probability"]).max()) for run in runs)
    least = min((run.isel(threshold=-1) for run in runs), key=lambda run: run["probability"])
    most = max(int(run["paths"]) for run in runs)
    return {
        "p": _short(section["p"]),
        "horizon": _short(section["horizon"]),
        "scenes": str(len(runs)),
        # so many as the weights ask for, which are random
        "paths": Quoted(_count(most), most, 0.0, EFFECTIVE),
        "least": Quoted(
            _power(least["probability"]),
            least["probability"],
            least["probability_error"],
            BOUND,
        ),
        "percent": decimal(100 * relative, 0, 0, ERROR),
    }


def density(section: Mapping) -> dict:
    """Return the sizes of figure 7."""
    return {
        "paths": _count(section["paths"]),
        "time": _short(section["time"]),
        "step": _short(section["step"]),
        "tolerances": [_power(tolerance) for tolerance in section["tolerances"]],
    }


def theorems(drift_condition: xr.Dataset, section: Mapping) -> dict:
    """Return what table 7 covers, and its smallest margins."""
    rounding = float(drift_condition["drift_error"].max())
    return {
        "cases": str(drift_condition.sizes["case"]),
        "points": _count(section["points"]),
        "reach": _power(section["reach"]),
        "damping": [_short(damping) for damping in section["damping"]],
        "n": [f"{n:,}" for n in section["n"]],
        "potentials": [_formula(U, x) for U in section["potentials"]["obstacle"]],
        "langevin": [_formula(v, eta) for v in section["langevin"]],
        "drift": decimal(drift_condition["drift"].min(), 2, rounding, BOUND),
        "printed": decimal(-drift_condition["forcing_printed"].min(), 2, rounding, BOUND),
        "rounding": _bound(rounding),
    }


def ergodicity(found: xr.Dataset, section: Mapping, scenes: Mapping) -> dict:
    """Return how well rates agree, and the scenes that forget a far start slower than the gap."""
    deviation = np.abs(found["rate"] - found["gap"]) / (found["rate_error"] + found["gap_error"])
    slower = found["far"] + found["far_error"] < found["gap"] - found["gap_error"]
    return {
        "step": _short(section["step"]),
        "enlargement": _short(section["enlargement"]),
        "deviation": decimal(deviation.max(), 2),
        "slower": [
            {
                "model": _words(scenes[name]["scene"]["model"]),
                "noise": scenes[name]["scene"]["noise"],
            }
            | {
                rate: decimal(
                    found[rate].sel(scene=name),
                    2,
                    found[f"{rate}_error"].sel(scene=name),
                    BOUND,
                )
                for rate in ("far", "gap")
            }
            for name in found["scene"].values[slower.values]
        ],
    }


def limit_theorem(theorem: xr.Dataset, section: Mapping) -> dict:
    """Return extreme distances of all scenes at the largest p, and how fast the maximum's fall."""
    last = theorem.isel(p=-1)
    p = theorem["p"].values[-2:]
    pair, error = (theorem[name].values[:, -2:] for name in ("maximum", "maximum_error"))
    exponents = np.log(pair[:, 1] / pair[:, 0]) / np.log(p[1] / p[0])
    exponent_errors = np.hypot(*(error / pair).T) / np.log(p[1] / p[0])

    def extreme(find, values, errors, digits):
        k = find(values)
        return decimal(values[k], digits, errors[k], INTERVAL)

    final, maximum = (
        (last[name].values, last[f"{name}_error"].values) for name in ("final", "maximum")
    )
    return {
        "paths": _count(section["paths"]),
        "p": _list(section["p"]),
        "largest_p": _short(p[1]),
        "before": _short(p[0]),
        "floor": decimal(theorem["floor"], 4),
        "false_alarm": _power(theorem["false_alarm"]),
        "final_largest": extreme(np.argmax, *final, 4),
        "maximum_smallest": extreme(np.argmin, *maximum, 3),
        "maximum_largest": extreme(np.argmax, *maximum, 3),
        "exponent_smallest": extreme(np.argmax, exponents, exponent_errors, 2),
        "exponent_largest": extreme(np.argmin, exponents, exponent_errors, 2),
    }


def rates(found: xr.Dataset, section: Mapping) -> dict:
    """Return the exponents of n with their errors, by scene."""

    def exponent(kind, scene):
        value, error = (
            float(found[f"{kind}_exponent{suffix}"].sel(scene=scene)) for suffix in ("", "_error")
        )
        return Quoted(f"{value:.2f} plus.minus {error:.2f}", value, error, INTERVAL)

    return {
        "paths": _count(section["paths"]),
        "horizon": _short(section["horizon"]),
        "weak_paths": _count(section["weak"]["paths"]),
        "weak_horizon": _short(section["weak"]["horizon"]),
        "exponents": {
            str(scene): {kind: exponent(kind, scene) for kind in ("pathwise", "weak")}
            for scene in found["scene"].values
        },
    }


def crossing_rates(runs: list[xr.Dataset], section: Mapping) -> dict:
    """Return the sizes of table 12, and the exponents of n of its scenes."""
    crossing = section["crossing"]
    found = []
    for name, run in zip(crossing["scenes"], runs, strict=True):
        scene = section["scenes"][name]["scene"]
        value, error = float(run["exponent"]), float(run["exponent_error"])
        spelt = Quoted(f"{value:.2f} plus.minus {error:.2f}", value, error, BOUND)
        found.append({"model": _words(scene["model"]), "noise": scene["noise"], "exponent": spelt})
    return {
        "p": _short(crossing["p"]),
        "horizon": _short(crossing["horizon"]),
        "ratio": _short(crossing["ratio"]),
        "exponents": found,
    }


def plasticity(deformation: xr.Dataset, constants: xr.Dataset, section: Mapping) -> dict:
    """Return the example's parameters, the differences for each limit, and code that computes it.

    Parameters
    ----------
    deformation : xarray.Dataset
        Both formulas against Monte Carlo, by limit and duration.
    constants : xarray.Dataset
        gamma^2 and kappa.
    section : mapping
        Of the configuration.

    Returns
    -------
    dict
    """
    oscillator, ground = section["oscillator"], section["ground"]
    gamma2, kappa = (
        (float(constants[name]), float(constants[f"{name}_error"])) for name in ("gamma2", "kappa")
    )
    runs = [run.squeeze("limit") for _, run in deformation.groupby("limit")]
    relaxation = relaxation_time(oscillator)
    return {
        "ground": {key: _short(value) for key, value in ground.items()},
        "frequency": _short(np.sqrt(ground["stiffness"])),
        "damping_ratio": f"{ground['damping'] / np.sqrt(ground['stiffness']) / 2:.2g}",
        "n": penalization(oscillator["n"]).strip("$").replace(r"\infty", "oo"),
        "damping": _short(oscillator["damping"]),
        "potential": oscillator["potential"],
        "paths": _count(section["paths"]),
        "duration": _short(section["duration"]),
        "periods": f"{section['duration'] / (2 * np.pi):.0f}",
        "relaxation": _short(relaxation),
        "relaxations": _short(section["duration"] / relaxation),
        "gamma2": decimal(gamma2[0], 4, gamma2[1]),
        "gamma2_error": _bound(gamma2[1]),
        "kappa": decimal(kappa[0], 2, kappa[1]),
        "kappa_error": decimal(kappa[1], 2, 0, ERROR),
        "limits": [_differences(run, *gamma2) for run in runs],
        "low": _low(runs),
        "significant": _short(SIGNIFICANT),
        "code": _example(section),
    }


def _differences(run, gamma2, gamma2_error):
    """Probabilities of one limit at the end, and where the formulas are off most."""
    duration, difference = run["duration"].values, run["difference"].values
    limit, formula, sampled = float(run["limit"]), run["probability"].values, _sampled(run)
    corrected = run["corrected_difference"].values
    errors = {str(name): run[name].values for name in run.data_vars if name.endswith("_error")}
    error = errors["difference_error"]
    most, least = np.argmax(np.abs(difference)), np.argmin(difference)
    corrected_most = np.argmax(np.abs(corrected))
    scaled = limit / np.sqrt(gamma2 * duration[-1])

    def place(k):
        # within one standard error of the extreme, another duration could be its place
        near = np.abs(difference - difference[k]) <= error[k]
        return Quoted(_short(duration[k]), duration[k], np.ptp(duration[near]), STANDARD)

    def there(values, k, own):
        near = np.abs(difference - difference[k]) <= error[k]
        return decimal(values[k], 4, own[k] + np.ptp(values[near]))

    return {
        "limit": _short(limit),
        "scaled": decimal(scaled, 2, scaled * gamma2_error / gamma2 / 2),
        "formula": decimal(formula[-1], 3, errors["probability_error"][-1]),
        "corrected": decimal(run["corrected"][-1], 3, errors["corrected_error"][-1]),
        "corrected_largest": decimal(
            corrected[corrected_most],
            3,
            errors["corrected_difference_error"][corrected_most],
            sign="+",
        ),
        "sampled": decimal(sampled[-1], 3, error[-1]),
        "largest": decimal(difference[most], 3, error[most], sign="+"),
        "largest_ratio": decimal(abs(difference[most]) / error[most], 0, 1),
        "largest_at": place(most),
        "low_formula": there(formula, least, errors["probability_error"]),
        "low_sampled": there(sampled, least, error),
        "low_at": place(least),
    }


def _sampled(run):
    return run["probability"].values - run["difference"].values


def _low(runs):
    """Largest probability that the asymptotic formula gives significantly too low.

    Its error is what one standard error more or less of the differences changes in it.
    """
    less, low, more = (
        max(_largest_underestimated(run, SIGNIFICANT + change) for run in runs)
        for change in (1, 0, -1)
    )
    return Quoted(f"{low:.2g}", low, more - less, STANDARD)


def _largest_underestimated(run, significant):
    too_low = run["difference"].values < -significant * run["difference_error"].values
    return max(_sampled(run)[too_low], default=0.0)


def _example(section):
    """Python that computes the example's last probability of the middle limit."""
    ground, oscillator = (
        ", ".join(f"{key}={_literal(value)}" for key, value in section[name].items())
        for name in ("ground", "oscillator")
    )
    limit = sorted(section["limits"])[len(section["limits"]) // 2]
    return "\n".join(
        [
            "import nonsmooth as ns",
            "",
            f"ground = ns.KanaiTajimi({ground})",
            'scene = ns.Scene("elasto_plastic", ground, observable="plastic_strain_rate",',
            f"                 {oscillator})",
            f"found = ns.asymptotic_variance(scene, tol={section['tolerance']:g}, "
            'method="monte_carlo")',
            "kappa = ns.extrapolation_length(scene)",
            f"limit, duration = {limit:g}, {section['duration']:g}",
            "ns.brownian_crossing((limit + kappa.value) / found.value**0.5, duration)",
        ]
    )


def _literal(value):
    return 'float("inf")' if value == float("inf") else json.dumps(value)


def errata(table: xr.Dataset) -> dict:
    """Return how many entries the errata have, and how many values."""
    entries = {str(entry).strip("abcd") for entry in table["entry"].values}
    return {"rows": str(table.sizes["entry"]), "entries": str(len(entries))}


# How numbers are spelt


def _short(value):
    return f"{float(value):g}"


def _count(value):
    return f"{int(value):,}"


def _list(values):
    return ", ".join(map(_short, values))


def _power(value):
    return tylax.latex_to_typst(scientific(value).strip("$"))


def _bound(value):
    return Quoted(tylax.latex_to_typst(scientific(value, bound=True).strip("$")), value, 0, ERROR)


def _error(value):
    return Quoted(_power(value), value, 0, ERROR)


def _formula(text, variable):
    return tylax.latex_to_typst(latex(parse(text, (variable,)), fold_short_frac=True))


def _words(name):
    return name.replace("_", "-")
