"""Every script of the gallery is short, runs, and draws what it shows."""

import runpy

import matplotlib as mpl
import matplotlib.pyplot as plt
import pytest

from support import ROOT

SCRIPTS = sorted((ROOT / "examples").glob("*.py"))
MOST_LINES = 40
SLOW = {
    "corrected_formula",
    "dead_zone",
    "far_start",
    "my_oscillator",
    "own_formulas",
    "rare_crossing",
    "sliding_isolator",
    "which_method",
}  # 5 s and more


@pytest.mark.parametrize(
    "path",
    [pytest.param(p, id=p.stem, marks=[pytest.mark.slow] * (p.stem in SLOW)) for p in SCRIPTS],
)
def test_an_example_runs_and_draws(path, monkeypatch):
    """As a script, without warnings; matplotlib lays out every picture."""
    mpl.use("agg")
    monkeypatch.setattr(plt, "show", lambda: None)
    plt.close("all")
    runpy.run_path(str(path), run_name="__main__")
    assert plt.get_fignums()
    for number in plt.get_fignums():
        plt.figure(number).draw_without_rendering()
    plt.close("all")


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_an_example_is_short_and_listed(path):
    """At most forty lines, and it has its place in the order of the manual's gallery."""
    assert len(path.read_text(encoding="utf-8").splitlines()) <= MOST_LINES
    assert f'"{path.name}"' in (ROOT / "docs" / "conf.py").read_text(encoding="utf-8")
