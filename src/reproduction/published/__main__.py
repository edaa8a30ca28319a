"""Write the record of a full run, or compare a run with it."""

import argparse
import sys
from pathlib import Path

from nonsmooth.errors import NonsmoothError
from reproduction.published.comparison import WITHIN, compare, spelled
from reproduction.published.record import gather, read, write


def main() -> int:
    """Read the command line; return 0 if the paper is reproduced."""
    parser = argparse.ArgumentParser(prog="python -m reproduction.published", description=__doc__)
    parser.add_argument("action", choices=["publish", "verify"])
    parser.add_argument("--results", type=Path, default=Path("results"))
    parser.add_argument("--record", type=Path, default=Path("paper/published.json"))
    arguments = parser.parse_args()
    try:
        found = gather(arguments.results)
        if arguments.action == "publish":
            write(found, arguments.record)
            return 0
        published = read(arguments.record)
        outcome = compare(published, found, str(arguments.results))
    except NonsmoothError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    print(spelled(outcome))
    if published.seed != found.seed:
        print(f"Another seed: {published.seed} was published, {found.seed} is here.")
    return _verdict(outcome)


def _verdict(outcome):
    states = [state for section in outcome.sections.values() for state in section]
    if outcome.off:
        print(f"error: {len(outcome.off)} of these are off; see above", file=sys.stderr)
        return 1
    alike = "within the stated errors" if WITHIN in states else "to the digit"
    print(f"The paper is reproduced {alike}.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
