"""Configuration files on snakemake's command line, read before snakemake itself reads them."""

import argparse
import sys
from collections.abc import Sequence

from reproduction.configuration.files import read
from reproduction.errors import ConfigError


def require_readable(arguments: Sequence[str] | None = None) -> None:
    """End the program in one line if a file of --configfile cannot be read.

    Parameters
    ----------
    arguments : sequence of str, optional
        Of snakemake's command line; those of this process by default.

    Raises
    ------
    SystemExit
    """
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--configfile", "--configfiles", nargs="+", default=[])
    known, _ = parser.parse_known_args(sys.argv[1:] if arguments is None else arguments)
    try:
        for file in known.configfile:
            read(file)
    except ConfigError as error:
        sys.exit(f"error: {error}")
