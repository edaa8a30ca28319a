"""The numbers of the text are those of the artifacts, spelt as they stand there."""

import ast
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from reproduction import paper_values
from reproduction.rendering.quoted import BOUND, ERROR, ROUNDING, STANDARD, Quoted, decimal


def formulas():
    """Errors at p = 1, 10, 100; the exact values do not resolve order 3 at the last two."""
    distance = [[0.3, 0.1, 0.03], [0.02, 0.01, 0.001], [0.03, 1e-3, 1e-5], [0.02, 1e-5, 1e-9]]
    resolved = np.ones((4, 3, 1), dtype=bool)
    resolved[3, 1:] = False
    names = ["asymptotic", "order 1", "order 2", "order 3"]
    constants = dict.fromkeys(paper_values.CONSTANTS, 0.5)
    constants |= {f"{name}_error": 1e-9 for name in paper_values.CONSTANTS}
    return xr.Dataset(
        {
            "distance": (("formula", "p"), distance),
            "resolved": (("formula", "p", "horizon"), resolved),
            "distance_error": (("formula", "p"), np.full((4, 3), 1e-9)),
            "slope": ("formula", [-0.5, -1.0, -1.5, -2.0]),
            "slope_error": ("formula", [0.01] * 4),
        }
        | constants,
        {"formula": names, "p": [1.0, 10.0, 100.0]},
    )


@pytest.fixture
def corrected():
    """Spell the section on corrected formulas."""
    contained = dict.fromkeys(("share", "expected", "spread", "least"), 0.947)
    contained |= {"expected_standard_error": 1e-4, "spread_standard_error": 1e-4}
    contained |= {"least_half_interval": 2e-3}
    contained |= {"rarely": 1e-3, "outside": 1e-6, "standard_errors": ("p", [1.0, 2.0])}
    section = {
        "horizons": [1, 2],
        "tabulated": 2,
        "tolerance": 1e-6,
        "first_time": 0.5,
        "fit_from": 100,
    }
    return paper_values.finite_p(xr.Dataset(contained), formulas(), section)


def test_errors_are_quoted_where_exact_values_resolve_them(corrected):
    """Others are None; order 2 is better than order 1 from p = 10 on."""
    assert [row["p"] for row in corrected["errors"]] == ["1", "10", "100"]
    assert [row["values"][3] is None for row in corrected["errors"]] == [False, True, True]
    assert corrected["order_2_better"] == "10"


def test_shares_have_errors_of_their_simulation(corrected):
    """In percent: another machine draws other shares, by more than the digits shown."""
    errors = {name: corrected[name].error for name in ("share", "expected", "spread", "least")}
    assert errors == pytest.approx({"share": 94.7, "expected": 0.01, "spread": 0.01, "least": 0.2})


def test_bounds_are_rounded_up(corrected):
    """1e-9 is below what is printed as its bound, also after rounding."""
    assert corrected["constants_error"].startswith("1.1 times")
    assert corrected["kappa"] == "0.50000000"
    assert corrected["share"] == "94.7"


def test_numbers_know_their_errors(corrected):
    """The stated one; half a unit of the last digit where there is none; none for parameters."""
    kappa, rounded = corrected["kappa"], decimal(94.7234, 1)
    assert (kappa.value, kappa.error, kappa.kind) == (0.5, 1e-9, BOUND)
    assert (rounded.value, rounded.kind) == (94.7234, ROUNDING)
    assert rounded.error == pytest.approx(0.05)
    assert (corrected["share"].error, corrected["share"].kind) == (pytest.approx(94.7), STANDARD)
    assert not isinstance(corrected["tabulated"], Quoted)
    assert corrected["constants_error"].kind == ERROR


def test_no_computed_number_is_spelt_without_its_error():
    """Numbers of artifacts are spelt by `decimal` or `Quoted`."""
    source = Path(paper_values.__file__).read_text(encoding="utf-8")
    assert not re.findall(r'f"\{float\(.*:[+]?\.\d', source)


def test_scenes_in_which_infinity_is_slower_than_the_gap():
    """Those whose rate at infinity is below the gap by more than both errors."""
    found = xr.Dataset(
        {
            "rate": ("scene", [2.5, 1.0]),
            "rate_error": ("scene", [0.1, 0.1]),
            "gap": ("scene", [2.54, 1.0]),
            "gap_error": ("scene", [0.1, 0.1]),
            "far": ("scene", [2.0, 0.9]),
            "far_error": ("scene", [0.1, 0.1]),
        },
        {"scene": ["a", "b"]},
    )
    scenes = {name: {"scene": {"model": "elasto_plastic", "noise": "white"}} for name in "ab"}
    values = paper_values.ergodicity(found, {"step": 0.1, "enlargement": 2}, scenes)
    assert values["slower"] == [
        {"model": "elasto-plastic", "noise": "white", "far": "2.00", "gap": "2.54"}
    ]
    assert values["deviation"] == "0.20"


def test_the_example_of_the_earthquake():
    """The code names the configured parameters; the tail counts only significant differences."""
    section = {
        "ground": {"stiffness": 6.25, "damping": 3.0, "sigma": 3.0},
        "oscillator": {"n": float("inf"), "damping": 0.1, "potential": "x**2/2"},
        "paths": 30_000,
        "duration": 400,
        "limits": [2, 4, 8],
        "tolerance": 0.02,
    }
    over = ("limit", "duration")
    deformation = xr.Dataset(
        {
            "probability": (over, [[0.01, 0.4, 0.7]]),
            "probability_error": (over, [[1e-3] * 3]),
            "corrected_error": (over, [[1e-3] * 3]),
            "corrected_difference_error": (over, [[0.005] * 3]),
            "difference": (over, [[-0.02, -0.001, 0.1]]),
            "difference_error": (over, [[0.005, 0.005, 0.005]]),
            "corrected": (over, [[0.02, 0.4, 0.6]]),
            "corrected_difference": (over, [[0.0, -0.01, 0.005]]),
        },
        {"limit": [4.0], "duration": [10.0, 100.0, 400.0]},
    )
    constants = xr.Dataset({"gamma2": 0.05, "gamma2_error": 1e-4, "kappa": 0.3, "kappa_error": 0.1})
    values = paper_values.plasticity(deformation, constants, section)
    code = ast.parse(values["code"])
    assert isinstance(code.body[-1], ast.Expr)
    assert 'n=float("inf")' in values["code"]
    assert "limit, duration = 4, 400" in values["code"]
    assert values["n"] == "oo"
    assert values["low"] == "0.03"
    # it is low by four standard errors, which is not more than one above the significant three
    assert (values["low"].value, values["low"].error) == pytest.approx((0.03, 0.03))
    (row,) = values["limits"]
    assert (row["largest"], row["largest_ratio"], row["largest_at"]) == ("+0.100", "20", "400")
    assert (row["low_formula"], row["low_sampled"], row["low_at"]) == ("0.0100", "0.0300", "10")


def test_entries_of_the_errata_are_counted_without_their_letters():
    """1, 2a and 2b are three values of two entries."""
    table = xr.Dataset(coords={"entry": ["1", "2a", "2b"]})
    assert paper_values.errata(table) == {"rows": "3", "entries": "2"}
