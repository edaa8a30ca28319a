"""Structures in SI units: a simulation in these units knows nothing of scenes, and agrees."""

import math

import numpy as np
import pytest

from nonsmooth.dimensions import Structure
from nonsmooth.errors import SceneError
from nonsmooth.scenes.noises import White
from nonsmooth.statistics.variance import variance

PATHS = 8_000
STANDARD_ERRORS = 4.5  # one false alarm in 150,000 comparisons
WHITE = {"spectral_density": 0.03}
FILTERED = WHITE | {"ground_frequency": 9.0, "ground_damping": 0.6}
STRUCTURES = {
    "friction": Structure("friction", mass=1200, damping=3000, limit=700, **WHITE),
    "friction, filtered": Structure("friction", mass=1200, damping=3000, limit=700, **FILTERED),
    "yielding": Structure(
        "elasto_plastic", mass=800, damping=900, limit=300, stiffness=3e4, **FILTERED
    ),
    "stops": Structure("obstacle", mass=50, damping=60, limit=0.02, stiffness=2e3, **WHITE),
    "stops, filtered, no spring": Structure(
        "obstacle", mass=50, damping=60, limit=0.02, **FILTERED
    ),
}
N = 20.0  # small, so that steps in SI units resolve the penalty


def reaction(structure, position, velocity):
    """Force of the element and the rate of plastic deformation, in SI units."""
    length, time = structure.scales.length, structure.scales.time
    d = structure.limit / structure.stiffness if structure.model == "elasto_plastic" else None
    if structure.model == "friction":
        slope = N * structure.limit / (length / time)
        return np.clip(slope * velocity, -structure.limit, structure.limit), 0.0
    if structure.model == "elasto_plastic":
        return 0.0, N / time * (position - np.clip(position, -d, d))
    gap = structure.limit
    contact = N * structure.mass / time**2
    return contact * (position - np.clip(position, -gap, gap)), 0.0


def simulated(structure, end, steps, noise):
    """Integral of what is observed over a time, by Heun's scheme in SI units from rest."""
    dt = end / steps
    S0, omega = structure.spectral_density, structure.ground_frequency
    a = rate = position = velocity = total = np.zeros(PATHS)

    def slopes(a, rate, position, velocity):
        force, flow = reaction(structure, position, velocity)
        pushed = structure.damping * velocity + structure.stiffness * position + force
        acceleration = -pushed / structure.mass - a
        g = {"friction": velocity, "elasto_plastic": flow, "obstacle": position}[structure.model]
        if omega is None:
            return 0.0, 0.0, velocity - flow, acceleration, g
        drift = -2 * structure.ground_damping * omega * rate - omega**2 * a
        return rate, drift, velocity - flow, acceleration, g

    for dW in noise:  # of variance 2 pi S_0 dt
        kick = dW * math.sqrt(2 * math.pi * S0 * dt)
        onto_rate, onto_velocity = (omega**2 * kick, 0.0) if omega else (0.0, -kick)
        first = slopes(a, rate, position, velocity)
        guess = (a + dt * first[0], rate + dt * first[1] + onto_rate,
                 position + dt * first[2], velocity + dt * first[3] + onto_velocity)  # fmt: skip
        second = slopes(*guess)
        mean = [(one + two) / 2 for one, two in zip(first, second, strict=True)]
        a, rate = a + dt * mean[0], rate + dt * mean[1] + onto_rate
        position, velocity = position + dt * mean[2], velocity + dt * mean[3] + onto_velocity
        total = total + dt * mean[4]
    return total


@pytest.mark.slow
@pytest.mark.parametrize("name", STRUCTURES)
def test_agrees_with_a_simulation_in_si_units(name):
    """The variance of the integral is that of the scene in the scene's units.

    The simulation's bias is measured by doubling its step on the same noise; the scheme's order is
    one at least, so that the bias is at most the difference of the two.
    """
    structure = STRUCTURES[name]
    scales = structure.scales
    time = 8.0
    end, steps = time * scales.time, 600
    fine = np.random.default_rng(7).standard_normal((steps, PATHS))
    coarse = (fine[::2] + fine[1::2]) / math.sqrt(2)
    sample = simulated(structure, end, steps, fine)
    doubled = simulated(structure, end, steps // 2, coarse)
    bias = abs(sample.var() - doubled.var())
    standard_error = np.std((sample - sample.mean()) ** 2) / math.sqrt(PATHS)

    observable = {"elasto_plastic": "plastic_strain_rate"}.get(structure.model)
    scene = structure.scene(observable, N)
    unit = scales.length * (scales.time if structure.model == "obstacle" else 1)
    # of v(tau)/tau in the scene's units; 3 % of it
    tol = 0.03 * sample.var() / unit**2 / time
    found = variance(scene, [time], tol, method="monte_carlo", seed=1)
    value, error = (float(found[v].values[0]) * unit**2 for v in ("v", "v_error"))
    allowed = STANDARD_ERRORS * math.hypot(standard_error, error) + bias
    assert allowed < 0.3 * value, "the comparison would not see a wrong factor"
    assert abs(sample.var() - value) < allowed


def test_the_element_has_the_size_1():
    """The slip force, the yield displacement and the gap are the units of the scene."""
    for structure in STRUCTURES.values():
        force = structure.scales.force
        if structure.model == "obstacle":
            assert structure.scales.length == structure.limit
        elif structure.model == "friction":
            assert structure.limit == pytest.approx(force)
        else:
            assert structure.limit == pytest.approx(structure.stiffness * structure.scales.length)


def test_white_noise_without_a_spring_has_the_intensity_1():
    """The unit of time is chosen so."""
    for model, limit in (("friction", 700.0), ("obstacle", 0.02)):
        noise = Structure(model, mass=1200, damping=3000, limit=limit, **WHITE).noise
        assert isinstance(noise, White)
        assert noise.sigma == pytest.approx(1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mass": 0}, "mass is 0; give a positive"),
        ({"model": "rubber"}, "model is 'rubber'"),
        ({"model": "elasto_plastic"}, "stiffness is 0.0; give a positive"),
        ({"stiffness": np.ones(2)}, r"stiffness is array\(\[1., 1.\]\); give a positive"),
        ({"ground_frequency": 3.0}, "ground_damping is None; give both"),
        ({"ground_damping": np.ones((2, 2))}, r"is array\(\[\[1., 1.\], \[1., 1.\]\]\); give both"),
    ],
)
def test_what_is_refused(change, message):
    """One line names the parameter and the cure."""
    usual = {"model": "friction", "mass": 1.0, "damping": 1.0, "limit": 1.0}
    with pytest.raises(SceneError, match=message):
        Structure(**(usual | {"spectral_density": 1.0} | change))
