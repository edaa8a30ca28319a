"""Answers: the library's numbers in the user's units, kept so that nothing is computed twice."""

import math

import numpy as np
import pytest
from scipy.special import ndtri

from nonsmooth.scenes.noises import White
from nonsmooth.scenes.scene import Scene
from nonsmooth.statistics.asymptotic_variance import asymptotic_variance
from nonsmooth.statistics.density.invariant_density import invariant_density
from reproduction.jobs import artifact
from studies import answers
from studies.answers import answer, answer_batch
from studies.questions import QUESTIONS

SCENE = {"model": "friction", "n": 10}
STRUCTURE = {
    "model": "friction",
    "mass": "10 kg",
    "damping": "3 N s/m",
    "slip_force": "5 N",
    "ground_spectral_density": "0.1 m^2/s^3",
    "n": 10,
}
SPREAD = {"ask": "asymptotic_variance"}


def test_a_dimensionless_scene_has_the_numbers_of_the_library():
    """With the method and the error."""
    found, direct = answer(SCENE, SPREAD, {}, 0), asymptotic_variance(Scene("friction", n=10))
    assert float(found["gamma2"]) == direct.value
    assert float(found["gamma2_error"]) == direct.error
    assert found["gamma2"].attrs["units"] == "1"
    assert found["gamma2"].attrs["method"] == direct.method


def test_gamma2_in_the_units_of_the_user():
    """As computed by hand: T = 2 pi S_0 m^2 / F^2 makes the noise 1, L = F T^2 / m."""
    time = 2 * math.pi * 0.1 * (10 / 5) ** 2
    length = 5 * time**2 / 10
    direct = asymptotic_variance(Scene("friction", White(), n=10, damping=3 * time / 10))
    found = answer(STRUCTURE, SPREAD, {"length": "mm"}, 0)
    assert found["gamma2"].attrs["units"] == "mm2 s-1"
    assert float(found["gamma2"]) == pytest.approx(direct.value * 1e6 * length**2 / time)


def test_densities_integrate_to_one():
    """In the user's units, too."""
    found = answer(STRUCTURE, {"ask": "invariant_density"}, {"length": "mm"}, 0)
    assert found["density_y"].attrs["units"] == "s mm-1"
    total = np.trapezoid(found["density_y"], found["y"])
    scaled = invariant_density(Scene("friction", White(), n=10, damping=0.753982))
    assert total == pytest.approx(np.trapezoid(scaled["density_y"], scaled["y"]), abs=1e-6)


def test_a_missed_tolerance_is_told_and_not_hidden():
    """The best that was reached comes with a comment."""
    found = answer(SCENE, {"ask": "asymptotic_variance", "tol": 1e-15}, {}, 0)
    assert "above tol" in found["gamma2"].attrs["comment"]
    assert float(found["gamma2_error"]) > 1e-15 * float(found["gamma2"])


def test_every_question_takes_its_arguments():
    """The arguments of the table are those of the functions."""
    import inspect

    for name, asked in QUESTIONS.items():
        taken = inspect.signature(asked.solve).parameters
        assert set(asked.arguments) | set(asked.required) <= set(taken), name
        assert asked.sampled == ("seed" in taken), name


def test_a_batch_computes_what_is_new_alone(tmp_path, monkeypatch):
    """A scene that is changed is computed; the others are read."""
    computed = []

    def counted(scene, **others):
        computed.append(scene)
        return answer(scene, **others)

    monkeypatch.setattr(answers, "answer", counted)
    source = tmp_path / "source.py"
    source.write_text("1")
    scenes = {f"s{k}": SCENE | {"damping": k} for k in (1, 2, 3)}

    def batch():
        computed.clear()
        return answer_batch(scenes, SPREAD, {}, 0, tmp_path / "store", [str(source)])

    first = batch()
    assert len(computed) == 3
    scenes["s2"] = SCENE | {"damping": 2.5}
    second = batch()
    assert computed == [scenes["s2"]]
    assert second["gamma2"].values[[0, 2]].tolist() == first["gamma2"].values[[0, 2]].tolist()
    kept = sorted((tmp_path / "store").glob("*.nc"))
    assert len(kept) == 4
    kept[0].write_bytes(b"damaged")
    assert artifact.read(kept[1])["gamma2"].attrs["units"] == "1"
    batch()
    assert len(computed) <= 1
    source.write_text("2")
    batch()
    assert len(computed) == 3


@pytest.mark.parametrize(
    ("question", "name", "unit"),
    [
        ({"ask": "mean_time_to_failure", "threshold": "2 m"}, "time", "s"),
        ({"ask": "asymptotic_variance_sensitivity", "parameter": "n"}, "derivative", "mm2 s-1"),
        ({"ask": "hazard_rate", "threshold": "2 m", "horizons": ["9 s"]}, "hazard_rate", "s-1"),
        (
            {"ask": "reliability_index", "threshold": ["1 m", "2 m"], "horizons": ["9 s"]},
            "reliability_index",
            "1",
        ),
        (
            {"ask": "state_reliability_index", "variable": "y", "threshold": "2 m/s"}
            | {"horizons": ["2 s"]},
            "reliability_index",
            "1",
        ),
        ({"ask": "failure_time", "threshold": "2 m", "method": "asymptotic"}, "time", "s"),
        (
            {"ask": "state_crossing_probability", "variable": "y", "threshold": "2 m/s"}
            | {"horizons": ["2 s"]},
            "probability",
            "1",
        ),
    ],
)  # fmt: skip
def test_units_of_answers(question, name, unit):
    """Each answer has those of what it is; and it is an artifact as it stands."""
    found = answer(STRUCTURE, question, {"length": "mm"}, 0)
    assert found[name].attrs["units"] == unit
    assert found[f"{name}_error"].attrs["units"] == unit
    assert np.all(np.isfinite(found[name]))


def test_indices_are_those_of_the_probabilities():
    """Of each threshold; the threshold keeps its unit."""
    asked = {"threshold": ["1 m", "2 m"], "horizons": ["9 s", "12 s"]}
    crossing = answer(STRUCTURE, {"ask": "crossing_probability"} | asked, {"length": "mm"}, 0)
    found = answer(STRUCTURE, {"ask": "reliability_index"} | asked, {"length": "mm"}, 0)
    assert found["reliability_index"].values == pytest.approx(-ndtri(crossing["probability"]))
    assert found["threshold"].values == pytest.approx([1000, 2000])
    assert found["threshold"].attrs["units"] == "mm"


NEVER = {"ask": "reliability_index", "threshold": "40 m", "horizons": ["2 s"], "paths": 500}


def test_what_no_path_tells_is_infinite_and_says_so(tmp_path):
    """Of 500 paths none crosses: beta is above a limit; alone and in a batch it can be kept."""
    found = answer(STRUCTURE, NEVER, {}, 0)
    assert np.isinf(found["reliability_index_error"]).all()
    assert found["reliability_index_error"].attrs["infinite"]
    # counting alone tells with 97.5 % that W is below; the limit has the bias of the step, too
    counted = -np.log(0.025) / 500
    assert -ndtri(2 * counted) < float(found["lower"][0]) < -ndtri(counted)
    artifact.write(found, tmp_path / "never.nc", "test")
    shaken = STRUCTURE | {"ground_spectral_density": "20 m^2/s^3"}
    both = {"strong": shaken, "weak": STRUCTURE}
    merged = answer_batch(both, NEVER, {}, 0, tmp_path / "store", [])
    assert np.isfinite(merged["reliability_index"].values).tolist() == [[True], [False]]
    artifact.write(merged, tmp_path / "both.nc", "test")


def test_an_envelope_is_in_the_users_time():
    """A loop in SI units agrees: 10 kg that slip at 5 N, with the noise exp(-t / 1 s) sqrt(2 pi S).

    The unit of time of the scene is 2.5 s; the same formula in that time is far off.
    """
    paths, steps, end, sigmas = 20_000, 500, 5.0, 4.5  # one false alarm in 150,000
    # n = 10 times the slip force at the unit of velocity
    slope = 10 * 5 / (5 / 10 * 2 * math.pi * 0.1 * (10 / 5) ** 2)
    dt, noise = end / steps, np.random.default_rng(3)
    v, z, crossed = np.zeros(paths), np.zeros(paths), np.zeros(paths, bool)
    for k in range(steps):
        friction = np.clip(slope * v, -5, 5)
        spread = math.exp(-(k + 0.5) * dt) * math.sqrt(2 * math.pi * 0.1 * dt)
        moved = v - dt * (3 * v + friction) / 10 + spread * noise.standard_normal(paths)
        z += dt * (v + moved) / 2
        v = moved
        crossed |= np.abs(z) >= 0.25
    asked = {"ask": "crossing_probability", "threshold": "250 mm", "horizons": ["5 s"]}
    asked |= {"tol": 0.02}
    found = answer(STRUCTURE, asked | {"envelope": "exp(-t)"}, {"length": "mm"}, 1)
    W = crossed.mean()
    error = math.hypot(math.sqrt(W * (1 - W) / paths), float(found["standard_error"][0]))
    allowed = sigmas * error + 2 * dt  # the loop's scheme is of the order 1
    assert abs(W - float(found["probability"][0])) < allowed
    wrong = answer(STRUCTURE, asked | {"envelope": "exp(-t/2.513)"}, {"length": "mm"}, 1)
    assert abs(W - float(wrong["probability"][0])) > 3 * allowed
    spread = {"ask": "variance", "times": ["5 s"], "tol": "200 mm^2/s", "envelope": "exp(-t)"}
    v = answer(STRUCTURE, spread, {"length": "mm"}, 1)["v"]
    assert v.attrs["units"] == "mm2"
    own = 1e6 * z.var()
    assert abs(own - float(v[0])) < sigmas * own * math.sqrt(2 / paths) + own * 2 * dt + 1000
    minutes = answer(STRUCTURE, asked | {"envelope": "exp(-60*t)"}, {"time": "min"}, 1)
    assert minutes["probability"].values == pytest.approx(found["probability"].values, abs=1e-12)


@pytest.mark.slow
def test_the_derivative_by_the_threshold_is_that_of_the_answers():
    """In the user's units: a difference of two probabilities over a difference of millimetres."""
    crossing = {"ask": "crossing_probability", "threshold": ["1995 mm", "2005 mm"]}
    shared = {"horizons": ["9 s"]}
    both = answer(STRUCTURE, crossing | shared, {"length": "mm"}, 0)["probability"].values[:, 0]
    slope = {"ask": "crossing_sensitivity", "threshold": "2 m", "parameter": "threshold"}
    found = answer(STRUCTURE, slope | shared, {"length": "mm"}, 0)
    # the third derivative adds (5/2000)^2 relative
    assert float(found["derivative"][0]) == pytest.approx((both[1] - both[0]) / 10, rel=1e-3)
