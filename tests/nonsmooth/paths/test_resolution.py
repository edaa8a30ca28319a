"""The step and the number of paths that a tolerance asks for."""

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.paths.resolution import (
    halved_step_bias,
    halving_paths,
    require_possible,
    require_resolved,
    sampled_step_bias,
)
from nonsmooth.paths.sampling import Sampling
from nonsmooth.paths.simulation import simulate
from nonsmooth.paths.tuning import MONTE_CARLO
from references import FALSE_ALARM, FRICTION


@pytest.mark.slow
def test_tolerance_is_met():
    """The variance within tol of the reference: error bars and bias included, step chosen."""
    limit = ns.Scene("friction", n=np.inf)
    for scene, scheme in ((FRICTION, "strang"), (limit, "strang"), (limit, "dry_friction")):
        run = simulate(scene, 10.0, tol=0.02, times=[10.0], seed=4, scheme=scheme)
        exact = float(ns.variance(scene, [10.0])["v"][0])
        z = stats.norm.isf(FALSE_ALARM / 2)
        slack = abs(run["variance_bias"]) + z * np.hypot(
            run["variance_error"], run["variance_bias_error"]
        )
        assert abs(run["variance"] - exact)[0] < slack[0]
        assert 2 * run["variance_error"][0] < 0.02 * exact
        assert abs(run["variance_bias"])[0] < 0.02 * exact


def test_a_bias_is_measured_on_as_few_paths_as_its_error_asks_for():
    """A pilot where that is enough, else what makes it half of the error of the moment, or all."""
    sampling, pilot = Sampling(0.1, 80_000, 3), MONTE_CARLO.pilot_paths

    def measured(paths):
        halving = replace(sampling.labelled("halving"), paths=paths)
        return halved_step_bias(FRICTION, [1.0], halving)

    first = {name: error for name, (_, error) in measured(pilot).items()}
    for share, paths in ((0.3, pilot), (1.0, halving_paths(sampling.paths))):
        errors = {f"{name}_error": error / share for name, error in first.items()}
        assert sampled_step_bias(FRICTION, [1.0], sampling, errors) == measured(paths)
    errors = {f"{name}_error": error / 0.6 for name, error in first.items()}
    for name, (_, error) in sampled_step_bias(FRICTION, [1.0], sampling, errors).items():
        assert error == pytest.approx(0.5 * errors[f"{name}_error"], rel=0.2)  # of some 1 %


def test_what_would_take_for_ever_is_refused():
    """The error is one line with a tolerance that would not."""
    with pytest.raises(ToleranceError, match="use tol >="):
        simulate(FRICTION, 10.0, tol=1e-9)


@pytest.mark.parametrize("tol", [1e-9, 9.7e-5, 9.7e-3])
def test_the_tolerance_advised_is_accepted(tol):
    """The work falls with its square; rounding the number in the message takes nothing away."""
    for work in (1.0001, 1.2, 40.0, 1e9):
        with pytest.raises(ToleranceError) as refused:
            require_possible(work, 1.0, "no answer", tol, most=1.0)
        advised = float(re.search(r"use tol >= (.*)", str(refused.value))[1])
        assert tol < advised
        require_possible(work * (tol / advised) ** 2, 1.0, "no answer", advised, most=1.0)


def test_a_step_above_all_time_scales_is_refused():
    """The message says to choose a smaller step."""
    with pytest.raises(ToleranceError, match="choose a smaller step"):
        ns.simulate(FRICTION, horizon=500, step=50.0, paths=1000)
    with pytest.raises(ToleranceError, match="choose a smaller step"):
        ns.crossing_probability(FRICTION, 0.6, [2.0], p=250, step=50.0, paths=1000)


def test_a_bias_without_a_variance_is_refused():
    """A single path has no variance that its bias could be compared with."""
    with pytest.raises(ToleranceError, match="choose a smaller step"):
        require_resolved(0.1, variance=0.0, bias=1e-3, error=0.0)
