"""Run every hard case and judge what is returned there."""

import math

from reproduction.errors import CheckError
from reproduction.hard_cases.cases import CASES
from reproduction.hard_cases.record import DEVIATIONS, REFUSED, WRONG, examine
from reproduction.jobs import artifact
from reproduction.jobs.job import produce


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
        If a result is off by more than its stated error, or is not a number without a message.
    """
    outcomes = [examine(case, paths) for case in CASES]
    for case, outcome in zip(CASES, outcomes, strict=True):
        if outcome.verdict == WRONG:
            raise CheckError(
                f"{case.title}, {case.method}: {outcome.value:.8g} with a stated error of "
                f"{outcome.error:.2g} is off by {outcome.deviation:.2g}: detect and refuse it"
            )

    compared = [k for k, outcome in enumerate(outcomes) if math.isfinite(outcome.deviation)]

    def texts(name, of):
        return "case", [getattr(item, name) for item in of]

    def numbers(name):
        return "result", [getattr(outcomes[k], name) for k in compared]

    return artifact.dataset(
        "Hard cases",
        f"public functions in hard cases, {paths} paths, against independent references",
        {
            "title": (*texts("title", CASES), "the case, LaTeX"),
            "method": (*texts("method", CASES), "what is called"),
            "verdict": (*texts("verdict", outcomes), "met, warned or refused"),
            "message": (*texts("message", outcomes), "the error or the warning"),
            "of_case": ("result", compared, "number of the case, from 0; the others have no value"),
        },
        {
            "refused": (
                "case",
                [int(outcome.verdict == REFUSED) for outcome in outcomes],
                "1 where the case is refused",
            ),
            "value": (*numbers("value"), "what is returned"),
            "value_error": (
                *numbers("error"),
                f"stated error; of samples the step's bias and {DEVIATIONS:g} standard errors",
            ),
            "reference": (*numbers("reference"), "independent reference"),
            "deviation": (*numbers("deviation"), "distance to the reference"),
        },
    )


if __name__ == "__main__":
    produce(judge, snakemake)
