"""Every erratum of the paper: printed, mended and reference values."""

from reproduction.errata.entries import ERRATA
from reproduction.errors import CheckError
from reproduction.jobs import artifact
from reproduction.jobs.job import produce
from reproduction.rendering.printed import numbered

TEXTS = (
    ("place", "where in the paper"),
    ("wrong", "what is printed there, LaTeX"),
    ("right", "what should be, LaTeX"),
)


def evaluate():
    """Evaluate all errata.

    Returns
    -------
    xarray.Dataset
        Over the entries.

    Raises
    ------
    CheckError
        If a printed value is right or a mended one wrong.
    """
    found = {erratum.label: erratum.evaluate() for erratum in ERRATA}
    for label, evidence in found.items():
        if evidence.holds(evidence.printed) or not evidence.holds(evidence.mended):
            raise CheckError(
                f"erratum {label}: printed {evidence.printed:.6g}, mended {evidence.mended:.6g}, "
                f"reference {evidence.reference:.6g}: mend the entry in "
                "src/reproduction/errata"
            )

    def values(name):
        return "entry", [getattr(evidence, name) for evidence in found.values()]

    def texts(name, records):
        return "entry", [numbered(getattr(record, name)) for record in records]

    return artifact.dataset(
        "Errata of the paper",
        "one quantity for each entry by the printed formula, the mended one, and independently",
        {
            "entry": ("entry", list(found), "number of the entry"),
            "quantity": (*texts("quantity", found.values()), "what is evaluated, LaTeX"),
            "relation": (*values("relation"), "what a right value is to the reference"),
            "kind": (*values("kind"), "kind of evidence"),
        }
        | {name: (*texts(name, ERRATA), meaning) for name, meaning in TEXTS},
        {
            "printed": (*values("printed"), "by the printed formula"),
            "mended": (*values("mended"), "by the mended formula"),
            "reference": (*values("reference"), "independent reference"),
            "reference_error": (*values("error"), "error allowed in the comparison"),
        },
    )


if __name__ == "__main__":
    produce(evaluate, snakemake)
