"""Search for violations of the drift condition (HV2), its proof's bounds and (HV1)."""

import itertools
import warnings
from dataclasses import asdict

from nonsmooth.errors import AssumptionWarning
from nonsmooth.scenes.noises import Langevin, named
from nonsmooth.scenes.scene import Scene
from nonsmooth.theory.drift_condition import margins
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce

MARGINS = {
    "drift": "1 - sup(A_n V_n + epsilon V_n) / C",
    "boxed": "smallest relative room of the boxed bound of A_n V_n + epsilon V_n",
    "lower": "smallest relative room of the lower bound of V_n",
    "mechanical": "smallest relative room of claims S_1 and S_2, 1 if x is not confined",
    "forcing": "smallest relative room of claim S_3 or S_4, mended, 1 for white noise",
}


def search(potentials, langevin, damping, n, points, reach):
    """Search every combination of model, noise, potential, damping and n.

    Parameters
    ----------
    potentials : dict
        Model -> list of U.
    langevin : list of str
        Potentials v of the colored noise of type 1. White and Kanai-Tajimi noise are searched, too.
    damping, n : list of float
    points : int
        Points of the grid for each scene.
    reach : float
        Largest absolute value of each variable.

    Returns
    -------
    xarray.Dataset
        Over the cases.

    Raises
    ------
    CheckError
        If an inequality fails by more than rounding, other than Claim 10 of the paper as printed.
    """
    forcings = {"white": [("", named("white"))]}
    forcings["langevin"] = [(v, Langevin(v)) for v in langevin]
    forcings["hamiltonian"] = [("", named("hamiltonian"))]
    cases, found = [], []
    for model, kind in itertools.product(potentials, forcings):
        for (v, noise), U, c, k in itertools.product(forcings[kind], potentials[model], damping, n):
            with warnings.catch_warnings():
                # U = 0 is covered by the velocity alone
                warnings.simplefilter("ignore", AssumptionWarning)
                scene = Scene(model, noise, n=k, damping=c, potential=U)
            result = asdict(margins(scene, points, reach))
            case = (model, kind, v, U, float(c), float(k))
            for name in MARGINS:
                if result[name] < -result["rounding"]:
                    raise CheckError(
                        f"{name}: the inequality fails by {-result[name]:.3g} of its terms for "
                        f"{case}; the proof or its constants are wrong there"
                    )
            cases.append(case)
            found.append(result)
    columns = zip(*cases, strict=True)
    labels = ("model", "noise", "v", "U", "damping", "n")
    names = {
        "model": "mechanical model",
        "noise": "kind of noise",
        "v": "potential of the colored noise of type 1",
        "U": "potential",
        "damping": "C_b",
        "n": "penalization",
    }

    def values(name):
        return "case", [result[name] for result in found]

    ratios = MARGINS | {"forcing_printed": "the same as forcing, claim S_4 as printed"}
    return artifact.dataset(
        "Drift condition of every scene",
        "room of the inequalities of the paper's Lemma 2; negative where they fail",
        {
            label: ("case", list(column), names[label])
            for label, column in zip(labels, columns, strict=True)
        },
        {name: (*values(name), text) for name, text in ratios.items()}
        | {f"{name}_error": (*values("rounding"), f"rounding error of {name}") for name in ratios}
        | {
            "supremum": (*values("supremum"), "largest A_n V_n + epsilon V_n found"),
            "supremum_error": (*values("supremum_error"), "rounding error of supremum"),
            "constant": (*values("constant"), "C of (HV2) by the paper's bound"),
            "coefficient": (*values("coefficient"), "c in V_n >= c |z|^2 + 1"),
        },
    )


if __name__ == "__main__":
    produce(search, snakemake)
