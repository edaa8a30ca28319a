"""The checks of the workflow fail when results contradict each other."""

import runpy
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from scipy.special import ndtr, ndtri
from scipy.stats import binom

from nonsmooth.crossing.brownian import brownian_crossing
from nonsmooth.crossing.proportions import crossing_estimate
from nonsmooth.estimate import Estimate
from nonsmooth.scenes.scene import Scene
from nonsmooth.theory.drift_condition import margins
from nonsmooth.theory.ergodicity import Bound
from reproduction.errata.record import Erratum, Evidence
from reproduction.errors import CheckError, ConfigError
from support import ROOT

TAU = np.array([0.1, 1.0, 10.0])
SCRIPTS = ROOT / "workflow" / "scripts"
PRINTED = {"model": "friction", "noise": "white"}
binned = runpy.run_path(str(SCRIPTS / "density" / "check.py"))["agreement"]
biases = runpy.run_path(str(SCRIPTS / "sweep" / "check.py"))["biases"]
limit_of = runpy.run_path(str(SCRIPTS / "sweep" / "limit.py"))["limit"]
agreement = runpy.run_path(str(SCRIPTS / "convergence" / "check.py"))["agreement"]
scheme = runpy.run_path(str(SCRIPTS / "convergence" / "finite_difference.py"))["paper_scheme"]
deviations = runpy.run_path(str(SCRIPTS / "variance" / "check.py"))["deviations"]
evaluate = runpy.run_path(str(SCRIPTS / "errata" / "errata.py"))["evaluate"]
search = runpy.run_path(str(SCRIPTS / "theorems" / "drift_condition.py"))["search"]
compare = runpy.run_path(str(SCRIPTS / "crossing" / "check.py"))["compare"]
distances = runpy.run_path(str(SCRIPTS / "limit_theorem" / "check.py"))["distances"]
ergodicity = runpy.run_path(str(SCRIPTS / "theorems" / "ergodicity.py"))["measure"]
containment = runpy.run_path(str(SCRIPTS / "finite_p" / "check.py"))["containment"]
deformation = runpy.run_path(str(SCRIPTS / "plasticity" / "check.py"))["compare"]


def three_methods(**changes):
    """Artifacts of figure 2a that agree, but for changes to Monte Carlo or finite differences."""
    v = 0.1 * TAU
    monte_carlo = {"v": v + 1e-4, "v_error": 1e-4, "bias": 5e-5, "bias_error": 1e-5}
    monte_carlo |= {k: c for k, c in changes.items() if k in monte_carlo}
    difference = {"v": v + changes.get("shift", 1e-6), "v_error": 2e-6}
    return [
        xr.Dataset(
            {k: ("tau", np.broadcast_to(c, 3).astype(float)) for k, c in values.items()},
            coords={"tau": TAU},
        )
        for values in ({"v": v, "v_error": 1e-12}, difference, monte_carlo)
    ]


def test_agreement_passes():
    """Deviations in units of the allowed error are at most one."""
    result = deviations(*three_methods())
    assert float(result["monte_carlo"].max()) < 1
    assert float(result["finite_difference"].max()) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"shift": 3e-6}, "finite_difference deviates"),
        ({"v": 0.1 * TAU + [0, 0, 7e-4]}, r"monte_carlo deviates .* at tau = 10"),
        ({"v": 0.1 * TAU + np.nan}, "monte_carlo deviates"),
        ({"v": 0.1 * TAU + 3e-4, "bias": 3e-4}, "bias is above the standard error"),
    ],
)
def test_contradictions_fail(changes, message):
    """Each method, a value that is not a number, and a bias that dominates."""
    with pytest.raises(CheckError, match=message):
        deviations(*three_methods(**changes))


def test_useless_finite_differences_fail():
    """They agree with the reference within errors as large as v/tau."""
    spectral, difference, monte_carlo = three_methods()
    difference["v_error"] += 0.5
    with pytest.raises(CheckError, match=r"stated error .* enlarge variance\.finite_diff"):
        deviations(spectral, difference, monte_carlo)


def table_4(**changes):
    """Artifacts of table 4 for n = 2 and infinity; the value of n = 2 is the printed one."""

    def column(n, value, error):
        found = {"n": n, "v_over_time": value, "v_over_time_error": error}
        return xr.Dataset(found)

    spectral = [column(np.inf, 0.13676692, 1e-11), column(2.0, 0.17446659, 1e-11)]
    values = {"v_over_time": 0.17446, "v_over_time_error": 1e-5} | changes
    return spectral, [column(2.0, values["v_over_time"], values["v_over_time_error"])]


def test_table_4_passes():
    """Finite differences within their error, and one printed value."""
    result = agreement(*table_4(), PRINTED, 100)
    assert float(result["finite_difference"][0]) == pytest.approx(0.659, rel=1e-3)
    assert int(result["printed"]) == 1


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"v_over_time": 0.17448}, r"at n = 2; enlarge convergence\.finite_difference\.half_width"),
        ({"v_over_time": 5.3e-9, "v_over_time_error": 9.8e-9}, "deviates .* at n = 2; enlarge"),
        ({"v_over_time": np.nan}, "deviates .* at n = 2"),
        ({"v_over_time": 0.1, "v_over_time_error": 0.1}, "stated error .* is 57%"),
    ],
)
def test_wrong_finite_differences_of_table_4_fail(changes, message):
    """Off, on a far too narrow domain, not a number, and of an error that says nothing."""
    with pytest.raises(CheckError, match=message):
        agreement(*table_4(**changes), PRINTED, 100)


def test_a_value_that_the_paper_does_not_print_fails():
    """It is compared where scene and horizon are the paper's, and only there."""
    spectral, difference = table_4(v_over_time=0.17447)
    spectral[1]["v_over_time"] += 3e-6
    with pytest.raises(CheckError, match=r"what table 4 prints deviates .* at n = 2"):
        agreement(spectral, difference, PRINTED, 100)
    for other in ((PRINTED, 50), (PRINTED | {"damping": 2.0}, 100)):
        assert int(agreement(spectral, difference, *other)["printed"]) == 0


def test_a_narrow_domain_names_its_key():
    """Table 4 with half_width = 0.01 is refused before it has a number."""
    with pytest.raises(ConfigError, match=r"'convergence\.finite_difference': half_width = 0\.01"):
        scheme(PRINTED, 2.0, 100, 0.01, 1001, 0.05)


def crossings(bias=5e-4, bias_error=4e-4, gamma2=1e-3):
    """Artifacts of figure 2b for p = 10 and 1000."""
    horizon = {"horizon": [1.0, 2.0]}
    run = {
        "probability": ("horizon", [0.2, 0.5]),
        "probability_error": ("horizon", [1e-3, 1.6e-3]),
        "slope": 0.45,
        "bias": bias,
        "bias_error": bias_error,
    }
    limit = xr.Dataset({"probability": ("horizon", [0.21, 0.52])}, coords=horizon)
    rate = xr.Dataset({"bias": gamma2, "bias_error": 2e-4})
    runs = [xr.Dataset(run, coords=horizon | {"p": p}) for p in (1000.0, 10.0)]
    return runs, limit, rate


def test_small_bias_passes_and_is_sorted_by_p():
    """The distance to the limit is the largest over T."""
    result = compare(*crossings())
    assert list(result["p"]) == [10.0, 1000.0]
    assert np.allclose(result["distance"], 0.02)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"gamma2": 4e-3}, "not below the standard error"),
        ({"bias": 8e-3, "gamma2": 1.5e-3}, "contradict"),
        ({"bias": -8e-3}, "contradict"),
    ],
)
def test_large_bias_fails(changes, message):
    """By the precise measurement or by the direct one."""
    with pytest.raises(CheckError, match=message):
        compare(*crossings(**changes))


@pytest.mark.parametrize(("printed", "mended"), [(1.0, 1.0), (2.0, 3.0)])
def test_a_wrong_erratum_fails(monkeypatch, printed, mended):
    """What is printed is right, or what is mended is wrong."""
    wrong = Erratum("1", "", "", "", lambda: Evidence("", printed, mended, 1.0))
    monkeypatch.setitem(evaluate.__globals__, "ERRATA", [wrong])
    with pytest.raises(CheckError, match="erratum 1: printed"):
        evaluate()


def test_a_violated_bound_fails(monkeypatch):
    """It fails beyond rounding; claim S_4 may be violated as printed."""
    case = {"friction": ["x**2/2"]}, ["eta**2/2"], [1], [2]
    good = margins(Scene("friction", n=2, potential="x**2/2"), points=300)
    for change, fails in (
        ({"forcing_printed": -0.5}, False),
        ({"lower": -good.rounding}, False),
        ({"lower": -3 * good.rounding}, True),
        ({"drift": -0.1}, True),
    ):
        wrong = replace(good, **change)
        monkeypatch.setitem(search.__globals__, "margins", lambda *given, wrong=wrong: wrong)
        if fails:
            with pytest.raises(CheckError, match="the inequality fails by"):
                search(*case, points=300, reach=10.0)
        else:
            assert search(*case, points=300, reach=10.0).sizes["case"] == 3


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({}, None),
        ({"decay_rate": Estimate(2.4, 0.05, "", 0.0)}, r"rate 2.4 \+- 0.05, but"),
        ({"decay_rate": Estimate(np.nan, 0.05, "", 0.0)}, "one of the two is wrong"),
        ({"poisson_bound": Bound(0.1, 0.01, 0.095)}, "larger enlargement"),
    ],
)
def test_a_contradicted_theorem_fails(monkeypatch, changes, message):
    """A rate that is not the spectral gap's; a bound that is attained where the box ends."""
    scenes = {"friction": {"model": "friction"}}
    for name, result in changes.items():
        monkeypatch.setitem(ergodicity.__globals__, name, lambda *_, result=result: result)
    if message is None:
        assert ergodicity(scenes, 1e-3, 0.1, 2.0).sizes["scene"] == 1
    else:
        with pytest.raises(CheckError, match=message):
            ergodicity(scenes, 1e-3, 0.1, 2.0)


P = np.array([10.0, 100.0, 1000.0])


def theorem(gamma=1.0, shift=0.5, paths=20_000):
    """Artifacts of figure 8: normal and maximal quantiles, shifted by shift / sqrt(p).

    Equidistant quantiles in the place of random numbers: nothing here happens by chance.
    """
    level = (np.arange(paths) + 0.5) / paths
    final = ndtri(level)
    grid = np.linspace(0.05, 6, 4001)
    maximum = np.interp(level, 1 - brownian_crossing(grid, 1.0), grid)
    moved = [gamma * (values + shift / np.sqrt(P)[:, None]) for values in (final, maximum)]
    samples = xr.Dataset(
        {name: (("p", "path"), v) for name, v in zip(("final", "maximum"), moved, strict=True)},
        coords={"p": P},
    )
    limit = xr.Dataset(
        {"gamma2": ("scene", [1.0]), "gamma2_error": ("scene", [1e-3])}, coords={"scene": ["a"]}
    )
    return [samples], limit, ["a"], 0.05


def test_distances_that_fall_pass():
    """Exact laws shifted by s have the distances 2 Phi(s/2) - 1 for the normal law."""
    result = distances(*theorem())
    expected = 2 * ndtr(0.25 / np.sqrt(P)) - 1
    assert np.allclose(result["final"].sel(scene="a"), expected, atol=1e-4)
    assert np.all(np.diff(result["maximum"].sel(scene="a")) < 0)
    assert np.all(result["final_error"] > result["floor"])


@pytest.mark.parametrize("changes", [{"gamma": 1.25}, {"gamma": 0.8}, {"gamma": np.nan}])
def test_a_wrong_gamma_fails(changes):
    """Distances that stay, and samples that are not numbers."""
    with pytest.raises(CheckError, match=r"a: at p = 1000 .* look for a mistake"):
        distances(*theorem(**changes))


def exceedances(bias=1e-3, bias_error=1e-3):
    """Artifacts of figure 9 for two limits; Monte Carlo is 0.1 below the formula."""
    duration = {"duration": TAU}
    runs = []
    for limit in (1.0, 2.0):
        values = {
            "probability": brownian_crossing(limit / 0.5, TAU) - 0.1,
            "probability_error": 2e-3,
            "bias": bias,
            "bias_error": bias_error,
        }
        runs.append(
            xr.Dataset(
                {k: ("duration", np.broadcast_to(v, 3)) for k, v in values.items()},
                coords=duration | {"limit": limit},
            )
        )
    constants = {"gamma2": 0.25, "gamma2_error": 1e-3, "kappa": 0.3, "kappa_error": 0.02}
    return xr.Dataset(constants), runs


def test_differences_of_formulas_and_monte_carlo():
    """They are what they were made to be, and their errors have both parts."""
    result = deformation(*exceedances())
    assert np.allclose(result["difference"], 0.1)
    parts = np.hypot(result["probability_error"], 2e-3)
    assert np.allclose(result["difference_error"], parts)
    farther = brownian_crossing(1.3 / 0.5, TAU)
    assert np.allclose(result["corrected"].sel(limit=1), farther)
    less = farther - brownian_crossing(1.32 / 0.5, TAU)
    assert np.all(result["corrected_error"].sel(limit=1) >= less)


def test_a_large_bias_of_the_deformation_fails():
    """Significantly above the standard error."""
    with pytest.raises(CheckError, match="bias at the limit 1"):
        deformation(*exceedances(bias=2e-2))


def bands(shift=0.0, bias=0.0, paths=10_000):
    """Artifacts of figure 2b: expected counts in the place of random ones, shifted by `shift`.

    The shift and the bias are in units of dW/dlog T, those of a relative change of all times.
    """
    horizon = np.linspace(0.5, 10, 20)
    truth = brownian_crossing(1.6, horizon)
    slope = horizon * np.gradient(truth, horizon)
    counts = np.round(paths * (truth + shift * slope))
    estimate = crossing_estimate(counts, paths)
    scalars = {"slope": slope.max(), "bias": bias * slope.max(), "bias_error": 0.0, "paths": paths}
    values = {name: ("horizon", value) for name, value in estimate.items()} | scalars
    runs = [xr.Dataset(values, coords={"horizon": horizon, "p": p}) for p in (10.0, 1.0)]
    curves = [
        xr.Dataset({"probability": ("horizon", truth[2:])}, coords={"horizon": horizon[2:], "p": p})
        for p in (1.0, 10.0)
    ]
    return runs, curves, 1


def test_bands_around_the_curves_pass():
    """All contain them; what chance allows is below 95 %, of which the expectation is close."""
    result = containment(*bands())
    assert list(result["p"]) == [1.0, 10.0]
    assert float(result["share"]) == 1
    # the mean of 10 000 replicates: six of its standard errors, and the steps of the counts
    allowed = 6 * float(result["expected_standard_error"]) + 0.01
    assert abs(float(result["expected"]) - 0.95) < allowed
    assert float(result["least"]) < 0.95


def test_simulated_shares_state_their_errors():
    """Between two seeds they differ by less than six standard errors, once in 10^8 by chance."""
    one, other = (containment(*bands()[:2], seed) for seed in (1, 2))
    for name, error, standard in (
        ("expected", "expected_standard_error", 1.0),
        ("spread", "spread_standard_error", 1.0),
        ("least", "least_half_interval", 1.96),
    ):
        allowed = 6 / standard * np.hypot(one[error], other[error])
        assert 0 < abs(one[name] - other[name]) < allowed


def test_a_known_bias_is_allowed_for():
    """A shift that would be refused passes if halving the step has found it."""
    assert float(containment(*bands(shift=0.025, bias=0.025))["share"]) < 0.5


@pytest.mark.parametrize(
    ("shift", "message"), [(0.1, "simultaneous band"), (0.025, "95 % bands contain")]
)
def test_bands_beside_the_curves_fail(shift, message):
    """They fail by ten standard errors, and by 2.5, which few pointwise bands contain."""
    with pytest.raises(CheckError, match=message):
        containment(*bands(shift=shift))


def histogram(paths=10_000, shift=0.0, bias=0.0):
    """Figure 7 of a normal velocity; expected counts in the place of random ones, shifted."""
    edges = np.linspace(-3, 3, 13)
    exact, sampled = (np.diff(ndtr(edges - moved)) / np.diff(edges) for moved in (0.0, shift))
    values = {
        "density_y": exact,
        "density_y_error": 1e-9 + 0 * exact,
        "histogram_y": np.round(sampled * 0.5 * paths) / 0.5 / paths + bias,
        "histogram_y_bias": bias + 0 * exact,
    }
    return xr.Dataset(
        {name: ("y", value) for name, value in values.items()} | {"factor": 4 / 3},
        coords={"y": (edges[1:] + edges[:-1]) / 2},
    )


def test_histograms_of_the_density_pass():
    """So they do with a bias that halving the step has found."""
    result = binned([histogram(), histogram(bias=0.2)], ["a", "b"], 10_000)
    assert np.all(result["deviation"] < 0.01)


def test_what_chance_allows_in_a_bin_is_a_bound():
    """Bernstein's is above the binomial quantile of the same probability, if not far above it."""
    allowed = binned.__globals__["_allowed"]
    level, found, paths = 1e-7, histogram().assign(factor=1.0), 10_000
    probability = found["density_y"].values * 0.5
    exact = (binom.isf(level / 2, paths, probability) - paths * probability) / paths / 0.5
    assert np.all(allowed(found, "y", paths, level) > exact)
    assert np.all(allowed(found, "y", paths, level) < 2 * exact)


@pytest.mark.parametrize("wrong", [{"shift": 0.4}, {"shift": np.nan}])
def test_histograms_beside_the_density_fail(wrong):
    """A stationary law that is not reached yet, or is solved wrongly; and what is not a number."""
    with pytest.raises(CheckError, match=r"histogram of y of b .* lengthen density\.time"):
        binned([histogram(), histogram(**wrong)], ["a", "b"], 10_000)


def swept(bias):
    """Figure 6 of one scene at two p, with a standard error of the bias of 1e-3."""
    values = {"bias": bias, "bias_error": 1e-3, "probability_error": 2e-3}
    run = xr.Dataset({k: ("horizon", np.full(2, v)) for k, v in values.items()})
    return [run, run], {"a": {}}, [1.0, 10.0]


def test_a_bias_of_the_sweep_fails():
    """It may be the standard error and what chance explains."""
    z = -ndtri(1e-6 / 8)
    assert float(biases(*swept(1.9e-3 + z * 1e-3))["excess"].max()) == pytest.approx(0.95)
    with pytest.raises(CheckError, match=r"bias of a at p = 1 .* reduce sweep\.step"):
        biases(*swept(2.1e-3 + z * 1e-3))


@pytest.mark.parametrize(
    ("sampled", "solved", "message"),
    [
        (0.5, 0.5, None),
        (0.5, 0.56, "gamma.2 of a is 0.56 .* by Monte Carlo; one of the two is wrong"),
        (-0.01, 0.5, r"may be 0; increase sweep\.variance\.paths"),
        (0.04, 0.04, "may be 0"),
    ],
)
def test_gamma2_of_the_sweep_is_above_0_and_that_of_the_solver(sampled, solved, message):
    """Otherwise the limits of figure 6 would be drawn for a wrong gamma."""
    names = ("mean", "mean_error", "settling", "settling_error", "bias", "bias_error")
    run = xr.Dataset(dict.fromkeys(names, 0.0) | {"gamma2": sampled, "gamma2_error": 0.01})
    exact = xr.Dataset({"gamma2": solved, "gamma2_error": 1e-6})
    given = [run], [exact], {"a": {"threshold": 1.0}}, ["a"], 2.0, 4
    if message is None:
        assert float(limit_of(*given)["gamma2"][0]) == 0.5
    else:
        with pytest.raises(CheckError, match=message):
            limit_of(*given)
