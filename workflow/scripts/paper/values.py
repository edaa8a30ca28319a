"""The numbers that the text of the paper quotes, spelt as they stand there."""

import json

import numpy as np
import tylax
import yaml
from sympy import latex

from nonsmooth.scenes.formulas import parse
from nonsmooth.scenes.symbols import eta, x
from reproduction.files import whole
from reproduction.jobs import inputs, job
from reproduction.plasticity import relaxation_time
from reproduction.tables import penalization, scientific

PRINTED = "paper/printed.yaml"
SIGNIFICANT = 3.0  # standard errors from which on the text calls the formula too low


def values(
    spectral,
    monte_carlo,
    agreement,
    crossing,
    contained,
    formulas,
    limit,
    convergence,
    drift_condition,
    ergodicity,
    errata,
    theorem,
    deformation,
    deformation_variance,
    rates,
    variance,
    sweep,
    finite_p,
    horizon,
    scheme,
    trajectories,
    scenes,
    theorems,
    density,
    limit_theorem,
    plasticity,
    limits,
    seed,
):
    """Collect numbers from the artifacts and the configuration.

    Parameters
    ----------
    spectral, monte_carlo, agreement, crossing, limit, theorem : xarray.Dataset
        The artifacts.
    contained, formulas : xarray.Dataset
        Figure 2b's bands against exact curves; the corrected formulas.
    deformation, deformation_variance : xarray.Dataset
        The formulas for the permanent deformation against Monte Carlo, and their constants.
    rates : xarray.Dataset
        Table 10.
    convergence : list of xarray.Dataset
        Spectral solutions of table 4, one per n.
    drift_condition, ergodicity, errata : xarray.Dataset
        Tables 7 and 7b, and the table of errata.
    variance, sweep, finite_p, trajectories, scenes : dict
        Sections of the configuration: figure 2a, figure 2b, the corrected formulas, trajectories,
        every scene.
    theorems, density, limit_theorem, plasticity, limits : dict
        Sections, too: table 7, figure 7, figure 8, figure 9, figure 12.
    horizon, scheme
        Horizon and finite differences of table 4.
    seed : int

    Returns
    -------
    dict
        Nested, of strings.
    """
    with open(PRINTED, encoding="utf-8") as file:
        printed = yaml.safe_load(file)
    tau = spectral["time"].values
    largest = crossing.isel(p=-1)
    return {
        "variance": {
            "n": f"{variance['scene']['n']:g}",
            "gamma2": f"{float(spectral['gamma2']):.15f}",
            "gamma2_error": _scientific(spectral["gamma2_error"], bound=True),
            "horizon": f"{tau[-1]:g}",
            "spectral_error": _scientific(
                (spectral["v_error"] / spectral["time"]).max(), bound=True
            ),
            "paths": f"{int(monte_carlo['paths']):,}",
            "step": f"{variance['monte_carlo']['step']:g}",
            "standard_error": _scientific((monte_carlo["v_error"] / monte_carlo["time"])[-1]),
            "bias": _scientific((monte_carlo["bias"] / monte_carlo["time"])[-1]),
            "finite_difference_agreement": f"{float(agreement['finite_difference'].max()):.2f}",
            "monte_carlo_agreement": f"{float(agreement['monte_carlo'].max()):.2f}",
            "threshold": f"{float(agreement['threshold']):.2f}",
            "false_alarm": _scientific(agreement["false_alarm"]),
            "printed": str(printed["fig:fpn-cmp-PDE-MC"]["asymptotic_value"]),
            "rounded": f"{float(spectral['gamma2']):.4f}",
            "nodes": f"{variance['finite_difference']['nodes']}",
            "time_step": f"{variance['finite_difference']['time_step']:g}",
            "half_width": f"{variance['finite_difference']['half_width']:g}",
        },
        "crossing": {
            "n": f"{sweep['scene']['n']:g}",
            "threshold": f"{sweep['threshold']:g}",
            "horizon": f"{sweep['horizon']:g}",
            "paths": f"{sweep['paths']:,}",
            "step": f"{sweep['step']:g}",
            "p": ", ".join(f"{p:g}" for p in sweep["p"]),
            "largest_p": f"{float(largest['p']):g}",
            "distance": f"{float(largest['distance']):.4f}",
            "standard_error": f"{float(largest['standard_error']):.4f}",
            "ratio": f"{float(largest['distance'] / largest['standard_error']):.0f}",
        },
        "finite_p": _finite_p(contained, formulas, finite_p),
        "convergence": {
            "horizon": f"{horizon:g}",
            "growth_error": _scientific(
                max(r["v_over_time_error"] for r in convergence), bound=True
            ),
            "gamma2_error": _scientific(max(r["gamma2_error"] for r in convergence), bound=True),
        }
        | {key: f"{scheme[key]:g}" for key in ("half_width", "nodes", "time_step")},
        "sweep": {
            "paths": f"{scenes['paths']:,}",
            "step": f"{scenes['step']:g}",
            "settled": f"{scenes['variance']['times'][0]:g}",
            "end": f"{scenes['variance']['times'][-1]:g}",
            "horizon": f"{scenes['horizon']:g}",
            "n": ", ".join(
                sorted({f"{entry['scene']['n']:g}" for entry in scenes["scenes"].values()})
            ),
            "allowed": f"{float(limit['allowed']):g}",
            "standard_error": f"{0.5 / scenes['paths'] ** 0.5 + 5e-5:.4f}",
        },
        "density": {
            "paths": f"{density['paths']:,}",
            "time": f"{density['time']:g}",
            "step": f"{density['step']:g}",
            "tolerances": [_scientific(tolerance) for tolerance in density["tolerances"]],
        },
        "limit_theorem": _limit_theorem(theorem, limit_theorem),
        "rates": _rates(rates, limits),
        "plasticity": _plasticity(deformation, deformation_variance, plasticity),
        "trajectories": {
            "step": f"{trajectories['step']:g}",
            "models": {
                model.replace("_", "-"): {
                    "potential": parameters["potential"],
                    "damping": f"{parameters['damping']:g}",
                }
                for model, parameters in trajectories["models"].items()
            },
        },
        "theorems": {
            "cases": str(drift_condition.sizes["case"]),
            "points": f"{theorems['points']:,}",
            "reach": _scientific(theorems["reach"]),
            "damping": ", ".join(f"{c:g}" for c in theorems["damping"]),
            "n": ", ".join(f"{n:,}" for n in theorems["n"]),
            "potentials": [_formula(U, x) for U in theorems["potentials"]["obstacle"]],
            "langevin": [_formula(v, eta) for v in theorems["langevin"]],
            "drift": f"{float(drift_condition['drift'].min()):.2f}",
            "printed": f"{-float(drift_condition['forcing_printed'].min()):.2f}",
            "rounding": _scientific(drift_condition["drift_error"].max(), bound=True),
        },
        "ergodicity": _ergodicity(ergodicity, theorems["ergodicity"], scenes["scenes"]),
        "errata": {
            "rows": str(errata.sizes["entry"]),
            "entries": str(len({str(entry).strip("abcd") for entry in errata["entry"].values})),
        },
        "seed": str(seed),
    }


def _formula(text, variable):
    return tylax.latex_to_typst(latex(parse(text, (variable,))))


def _ergodicity(found, section, scenes):
    """How well rates agree, and the scenes in which infinity is slower than the spectral gap."""
    deviation = np.abs(found["rate"] - found["gap"]) / (found["rate_error"] + found["gap_error"])
    slower = found["far"] + found["far_error"] < found["gap"] - found["gap_error"]
    return {
        "step": f"{section['step']:g}",
        "enlargement": f"{section['enlargement']:g}",
        "deviation": f"{float(deviation.max()):.2f}",
        "slower": [
            {
                "model": scenes[name]["scene"]["model"].replace("_", "-"),
                "noise": scenes[name]["scene"]["noise"],
                "far": f"{float(found['far'].sel(scene=name)):.2f}",
                "gap": f"{float(found['gap'].sel(scene=name)):.2f}",
            }
            for name in found["scene"].values[slower.values]
        ],
    }


def _finite_p(contained, formulas, section):
    """Constants and errors of the corrected formulas, and how often bands contain exact curves."""
    constants = ("diffusion", "kappa", "dispersion", "corner", "stretch", "start")
    p, distance = formulas["p"].values, formulas["distance"]
    first, second = (distance.sel(formula=name).values for name in ("order 1", "order 2"))
    resolved = formulas["resolved"].any("horizon")
    known = resolved.sel(formula="order 2").values
    better = p[p > max(p[known & (second >= first)], default=0.0)]
    return {name: f"{float(formulas[name]):.8f}" for name in constants} | {
        "constants_error": _scientific(
            max(float(formulas[f"{name}_error"]) for name in constants), bound=True
        ),
        "horizons": ", ".join(f"{T:g}" for T in section["horizons"]),
        "tabulated": f"{section['tabulated']:g}",
        "tolerance": _scientific(section["tolerance"]),
        "first_time": f"{section['first_time']:g}",
        "fit_from": f"{section['fit_from']:g}",
        "slopes": [f"{slope:.2f}" for slope in formulas["slope"].values],
        "errors": [
            {"p": f"{scale:g}"}
            | {
                str(name): _scientific(distance.sel(formula=name)[k])
                if resolved.sel(formula=name)[k]
                else None
                for name in distance["formula"].values
            }
            for k, scale in enumerate(p)
            if known[k]
        ],
        "order_2_better": f"{better[0]:g}" if better.size else "oo",
        "share": f"{100 * float(contained['share']):.1f}",
        "expected": f"{100 * float(contained['expected']):.1f}",
        "spread": f"{100 * float(contained['spread']):.1f}",
        "least": f"{100 * float(contained['least']):.1f}",
        "rarely": _scientific(contained["rarely"]),
        "outside": _scientific(contained["outside"]),
        "standard_errors": f"{float(contained['standard_errors'].max()):.1f}",
    }


def _limit_theorem(theorem, section):
    """Extreme distances of all scenes at the largest p, and how fast the maximum's fall there."""
    last = theorem.isel(p=-1)
    p = theorem["p"].values[-2:]
    pair = theorem["maximum"].values[:, -2:]
    exponents = np.log(pair[:, 1] / pair[:, 0]) / np.log(p[1] / p[0])
    return {
        "paths": f"{section['paths']:,}",
        "p": ", ".join(f"{p:g}" for p in section["p"]),
        "largest_p": f"{p[1]:g}",
        "before": f"{p[0]:g}",
        "floor": f"{float(theorem['floor']):.4f}",
        "false_alarm": _scientific(theorem["false_alarm"]),
        "final_largest": f"{float(last['final'].max()):.4f}",
        "maximum_smallest": f"{float(last['maximum'].min()):.3f}",
        "maximum_largest": f"{float(last['maximum'].max()):.3f}",
        "exponent_smallest": f"{exponents.max():.2f}",
        "exponent_largest": f"{exponents.min():.2f}",
    }


def _rates(rates, section):
    """Exponents of n with their errors, by scene."""
    return {
        "paths": f"{section['paths']:,}",
        "horizon": f"{section['horizon']:g}",
        "weak_paths": f"{section['weak']['paths']:,}",
        "weak_horizon": f"{section['weak']['horizon']:g}",
        "exponents": {
            str(name): {
                kind: " plus.minus ".join(
                    f"{float(rates[f'{kind}_exponent{suffix}'].sel(scene=name)):.2f}"
                    for suffix in ("", "_error")
                )
                for kind in ("pathwise", "weak")
            }
            for name in rates["scene"].values
        },
    }


def _plasticity(deformation, variance, section):
    """Parameters of the example, the differences for each limit, the code that computes it."""
    oscillator, ground = section["oscillator"], section["ground"]
    duration, gamma2 = deformation["duration"].values, float(variance["gamma2"])
    limits, low = [], 0.0
    for limit, run in deformation.groupby("limit"):
        run = run.squeeze("limit")
        formula, difference, error = (
            run[name].values for name in ("probability", "difference", "difference_error")
        )
        sampled, corrected = formula - difference, run["corrected_difference"].values
        largest, least = np.argmax(np.abs(difference)), np.argmin(difference)
        too_low = difference < -SIGNIFICANT * error
        low = max(low, *sampled[too_low], 0.0)
        limits.append(
            {
                "limit": f"{limit:g}",
                "scaled": f"{limit / np.sqrt(gamma2 * duration[-1]):.2f}",
                "formula": f"{formula[-1]:.3f}",
                "corrected": f"{float(run['corrected'][-1]):.3f}",
                "corrected_largest": f"{corrected[np.argmax(np.abs(corrected))]:+.3f}",
                "sampled": f"{sampled[-1]:.3f}",
                "largest": f"{difference[largest]:+.3f}",
                "largest_ratio": f"{abs(difference[largest]) / error[largest]:.0f}",
                "largest_at": f"{duration[largest]:g}",
                "low_formula": f"{formula[least]:.4f}",
                "low_sampled": f"{sampled[least]:.4f}",
                "low_at": f"{duration[least]:g}",
            }
        )
    return {
        "ground": {key: f"{value:g}" for key, value in ground.items()},
        "frequency": f"{np.sqrt(ground['stiffness']):g}",
        "damping_ratio": f"{ground['damping'] / np.sqrt(ground['stiffness']) / 2:.2g}",
        "n": penalization(oscillator["n"]).strip("$").replace(r"\infty", "oo"),
        "damping": f"{oscillator['damping']:g}",
        "potential": oscillator["potential"],
        "paths": f"{section['paths']:,}",
        "duration": f"{section['duration']:g}",
        "periods": f"{section['duration'] / (2 * np.pi):.0f}",
        "relaxation": f"{relaxation_time(oscillator):g}",
        "relaxations": f"{section['duration'] / relaxation_time(oscillator):g}",
        "gamma2": f"{gamma2:.4f}",
        "gamma2_error": _scientific(variance["gamma2_error"], bound=True),
        "kappa": f"{float(variance['kappa']):.2f}",
        "kappa_error": f"{float(variance['kappa_error']):.2f}",
        "limits": limits,
        "low": f"{low:.2g}",
        "significant": f"{SIGNIFICANT:g}",
        "code": _example(section),
    }


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


def _scientific(value, bound=False):
    return tylax.latex_to_typst(scientific(value, bound=bound).strip("$"))


if __name__ == "__main__":
    with job(snakemake.log[0]):
        result = values(**inputs(snakemake), **dict(snakemake.params.items()))
        with whole(snakemake.output[0]) as partial:
            partial.write_text(json.dumps(result, indent=1), encoding="utf-8")
