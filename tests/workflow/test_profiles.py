"""The profiles fit the rules, and let nothing in."""

import re

import pytest
import yaml

from support import ROOT

PROFILE = yaml.safe_load((ROOT / "workflow/profiles/slurm/profile.yaml").read_text())
RULES = "\n".join(path.read_text() for path in (ROOT / "workflow/rules").glob("*.smk"))
ARRAYS = set(PROFILE["slurm-array-jobs"].split(","))
GROUPED = set(PROFILE["groups"])


def test_configurations_are_read_before_snakemake_reads_them():
    """It would run code in those that ask for it; how that is refused is tried with the default."""
    default = yaml.safe_load((ROOT / "workflow/profiles/default/profile.yaml").read_text())
    for profile in (default, PROFILE):
        assert profile["__use_yte__"] is True
        assert profile["__definitions__"][-1] == "require_readable()"


def test_every_rule_that_it_names_exists():
    """Snakemake itself would pass over a misspelt name."""
    named = ARRAYS | GROUPED | set(PROFILE["set-resources"])
    assert named <= set(re.findall(r"^(?:use )?rule (?:\w+ as )?(\w+)", RULES, re.MULTILINE))


def test_every_figure_is_in_the_group():
    """But the diagrams of speed, which are not for a cluster."""
    figures = set(re.findall(r"^(?:use )?rule (?:\w+ as )?(figure_\w+)", RULES, re.MULTILINE))
    assert figures - {"figure_speed"} == {name for name in GROUPED if name.startswith("figure_")}


def test_arrays_and_groups_are_apart():
    """A job of a group would not become one of an array."""
    assert not ARRAYS & GROUPED


@pytest.mark.parametrize("limit", ["jobs", "max-jobs-per-timespan"])
def test_no_limit_holds_jobs_of_arrays_back(limit):
    """The plugin loses jobs of an array that do not all come at once."""
    number = str(PROFILE[limit]).split("/")[0]
    assert number == "unlimited" or int(number) >= 100_000
