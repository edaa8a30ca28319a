"""The numbers that the text of the paper quotes, spelt as they stand there."""

import json

import tylax
import yaml
from sympy import latex

from nonsmooth.expressions import parse
from nonsmooth.files import whole
from nonsmooth.jobs import inputs, job
from nonsmooth.models import eta, x
from nonsmooth.tables import scientific

PRINTED = "paper/printed.yaml"


def values(
    spectral,
    monte_carlo,
    agreement,
    crossing,
    limit,
    convergence,
    drift_condition,
    errata,
    variance,
    sweep,
    horizon,
    scheme,
    trajectories,
    scenes,
    theorems,
    seed,
):
    """Collect numbers from the artifacts and the configuration.

    Parameters
    ----------
    spectral, monte_carlo, agreement, crossing, limit : xarray.Dataset
        The artifacts.
    convergence : list of xarray.Dataset
        Spectral solutions of table 4, one per n.
    drift_condition, errata : xarray.Dataset
        Table 7 and the table of errata.
    variance, sweep, trajectories, scenes, theorems : dict
        Sections of the configuration: figure 2a, figure 2b, trajectories, every scene, table 7.
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
        "convergence": {
            "horizon": f"{horizon:g}",
            "growth_error": _scientific(max(r["growth_error"] for r in convergence), bound=True),
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
        "errata": {
            "rows": str(errata.sizes["entry"]),
            "entries": str(len({str(entry).strip("abcd") for entry in errata["entry"].values})),
        },
        "seed": str(seed),
    }


def _formula(text, variable):
    return tylax.latex_to_typst(latex(parse(text, (variable,))))


def _scientific(value, bound=False):
    return tylax.latex_to_typst(scientific(value, bound=bound).strip("$"))


if __name__ == "__main__":
    with job(snakemake.log[0]):
        result = values(**inputs(snakemake), **dict(snakemake.params.items()))
        with whole(snakemake.output[0]) as partial:
            partial.write_text(json.dumps(result, indent=1), encoding="utf-8")
