"""Run every hard case and judge what is returned there."""

from nonsmooth import artifact
from nonsmooth.errors import CheckError
from nonsmooth.hard_cases import CASES, DEVIATIONS, WRONG, examine
from nonsmooth.jobs import produce


def judge(paths):
    """Run the cases.

    Parameters
    ----------
    paths : int
        Number of paths of Monte Carlo; some cases take a part of them.

    Returns
    -------
    xarray.Dataset
        Over the cases.

    Raises
    ------
    CheckError
        If a result is off by more than it says, or is not a number and nothing says so.
    """
    outcomes = [examine(case, paths) for case in CASES]
    for case, outcome in zip(CASES, outcomes, strict=True):
        if outcome.verdict == WRONG:
            raise CheckError(
                f"{case.title}, {case.method}: {outcome.value:.8g} with a stated error of "
                f"{outcome.error:.2g} is off by {outcome.deviation:.2g}: detect and refuse it"
            )

    def values(name, of=outcomes):
        return "case", [getattr(item, name) for item in of]

    return artifact.dataset(
        "Hard cases",
        f"public functions in nasty cases, {paths} paths, against independent references",
        {
            "title": (*values("title", CASES), "the case, LaTeX"),
            "method": (*values("method", CASES), "what is called"),
            "verdict": (*values("verdict"), "met, warned or refused"),
            "message": (*values("message"), "the error or the warning"),
        },
        {
            "value": (*values("value"), "what is returned, not a number if it is refused"),
            "value_error": (
                *values("error"),
                f"stated error; of samples the step's bias and {DEVIATIONS:g} standard errors",
            ),
            "reference": (*values("reference"), "independent reference"),
            "deviation": (*values("deviation"), "distance to the reference"),
        },
    )


if __name__ == "__main__":
    produce(judge, snakemake)
