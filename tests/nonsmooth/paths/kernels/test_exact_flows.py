"""The sub-flows are exact: they satisfy their equation and the semigroup property."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from nonsmooth.paths.kernels import exact_flows

RNG = np.random.default_rng(11)


def reference(right_hand_side, start, t):
    """Integrate an ODE with a high-order method whose steps resolve the kinks."""
    solution = solve_ivp(
        right_hand_side, (0, t), np.atleast_1d(start), rtol=1e-11, atol=1e-12, max_step=t / 2000
    )
    return solution.y[:, -1]


@pytest.mark.parametrize("rate", [0.0, 1.3])
@pytest.mark.parametrize(("knot", "inner", "outer"), [(0.1, 10.0, 0.0), (1.0, 0.0, 20.0)])
def test_penalised_flow_solves_its_equation(rate, knot, inner, outer):
    """The flow is that of an ODE solver, over all passages through the pieces."""
    for _ in range(12):
        z, drive, t = RNG.normal(scale=2), RNG.normal(scale=3), RNG.uniform(0.05, 1.5)

        def force(z):
            a = np.abs(z)
            return np.sign(z) * np.where(a <= knot, inner * a, inner * knot + outer * (a - knot))

        exact = reference(lambda _, z, d=drive, f=force: d - rate * z - f(z), z, t)[0]
        # a kink inside a step of length t/2000 costs at most its square times the jump of f'
        assert exact_flows.penalised(z, t, drive, rate, knot, inner, outer) == pytest.approx(
            exact, abs=2e-6
        )


@pytest.mark.parametrize("n", [2.0, 100.0, 1e6])
def test_spring_contact_solves_its_equation_and_keeps_the_energy(n):
    """Energy y^2/2 + chi_n(x) to rounding, and two half flows are one flow."""
    for _ in range(50):
        y, x, t = RNG.normal(scale=2), RNG.uniform(-1.2, 1.2), RNG.uniform(0.1, 3)
        omega = np.sqrt(n)
        end = exact_flows.spring_contact(y, x, t, omega)
        half = exact_flows.spring_contact(
            *exact_flows.spring_contact(y, x, t / 2, omega), t / 2, omega
        )

        def energy(y, x):
            return y**2 / 2 + n / 2 * max(abs(x) - 1, 0) ** 2

        assert energy(*end) == pytest.approx(energy(y, x), rel=1e-11)
        assert np.allclose(half, end, atol=1e-7 * np.sqrt(n))


def test_spring_contact_against_an_ode_solver():
    """The flow is that of an ODE solver, for one penetration and several."""

    def motion(_, z):
        y, x = z
        return [-20.0 * (x - np.clip(x, -1, 1)), y]

    for y, x, t in [(1.5, 0.3, 2.0), (-4.0, 0.9, 3.0), (0.2, 1.4, 1.0)]:
        exact = reference(motion, [y, x], t)
        assert np.allclose(exact_flows.spring_contact(y, x, t, np.sqrt(20.0)), exact, atol=1e-5)


def test_elastic_impact_is_the_limit_of_the_spring():
    """The contact lasts pi/sqrt(n): the flows differ by O(n^(-1/2)) between impacts."""
    for y, x, t in [(1.5, 0.3, 2.0), (-0.8, 0.0, 1.0), (3.0, -1.0, 2.5)]:
        limit = exact_flows.elastic_impact(y, x, t)
        bounces = abs(y) * t / 2 + 1
        for n in (1e4, 1e8):
            end = exact_flows.spring_contact(y, x, t, np.sqrt(n))
            assert abs(end[1] - limit[1]) <= bounces * np.pi / np.sqrt(n) * abs(y)
        assert abs(limit[0]) == abs(y)


def test_dry_friction_sticks_and_slips():
    """It sticks while |drive| <= 1, else slips with the excess, as the penalised flow tends to."""
    assert exact_flows.dry_friction(0.3, 5.0, 0.9, 0.7) == 0.0
    assert exact_flows.dry_friction(0.0, 2.0, 1.5, 0.0) == pytest.approx(1.0)
    assert exact_flows.dry_friction(-0.5, 1.0, 0.0, 0.0) == 0.0
    for _ in range(50):
        z, t, drive, rate = RNG.normal(), RNG.uniform(0.01, 2), RNG.normal(scale=2), RNG.uniform()
        n = 1e7
        penalised = exact_flows.penalised(z, t, drive, rate, 1 / n, n, 0.0)
        assert exact_flows.dry_friction(z, t, drive, rate) == pytest.approx(penalised, abs=3 / n)


def test_projection_is_the_limit_of_the_elasto_plastic_flow():
    """Differ by |drive|/n, the depth at which the penalty balances the drive."""
    for _ in range(50):
        z, t, drive = RNG.uniform(-1, 1), RNG.uniform(0.01, 2), RNG.normal(scale=3)
        n = 1e6
        penalised = exact_flows.penalised(z, t, drive, 0.0, 1.0, 0.0, n)
        assert abs(exact_flows.confined(z, t, drive) - penalised) <= abs(drive) / n * (1 + 1e-9)


def test_yielding_is_the_penalised_flow_without_force_between_the_knots():
    """Two implementations of one flow, over all pieces, from rest and from beyond a knot."""
    for _ in range(300):
        z, t, n = RNG.normal(scale=1.5), 10 ** RNG.uniform(-3, 1), 10 ** RNG.uniform(0, 6)
        drive = RNG.choice([0.0, RNG.normal(scale=3)], p=[0.1, 0.9])
        general = exact_flows.penalised(z, t, drive, 0.0, 1.0, 0.0, n)
        # in `penalised` a rate of 1e-15 stands for 0, and one unit of rounding for 1
        rounding = 1e-13 * (1 + abs(z) + abs(drive) * t)
        assert exact_flows.yielding(z, t, drive, 1.0, n) == pytest.approx(general, abs=rounding)
    assert exact_flows.yielding(0.25, 1.0, 0.0, 1.0, 100.0) == 0.25  # to the last digit


FLOWS = {
    "penalised, friction": lambda z, t, d: exact_flows.penalised(
        z, t, d, type(z)(0.7), type(z)(0.01), type(z)(100), type(z)(0)
    ),
    "penalised, plastic": lambda z, t, d: exact_flows.penalised(
        z, t, d, type(z)(0), type(z)(1), type(z)(0), type(z)(1e6)
    ),
    "yielding": lambda z, t, d: exact_flows.yielding(z, t, d, type(z)(1), type(z)(1e6)),
    "at rest": lambda z, t, d: exact_flows.at_rest(z, t, type(z)(0.01), type(z)(100)),
    "dry friction": lambda z, t, d: exact_flows.dry_friction(z, t, d, type(z)(0.7)),
    "relax": lambda z, t, d: exact_flows.relax(z, t, d, type(z)(0.7)),
    "spring": lambda z, t, d: exact_flows.spring_contact(d, z, t, type(z)(10))[1],
    "impact": lambda z, t, d: exact_flows.elastic_impact(d, z, t)[1],
}


@pytest.mark.parametrize("name", FLOWS)
def test_single_precision_is_rounding_away_from_double(name):
    """At most 32 units of rounding of the largest number met, for stiff and soft pieces."""
    rng = np.random.default_rng(3)
    for _ in range(300):
        z, t, drive = rng.normal(scale=0.6), rng.uniform(0.005, 0.5), rng.normal(scale=2)
        if name == "impact":
            z = np.clip(z, -1, 1)
        single = FLOWS[name](np.float32(z), np.float32(t), np.float32(drive))
        double = FLOWS[name](*(float(np.float32(v)) for v in (z, t, drive)))
        scale = 1 + abs(z) + abs(drive)
        assert isinstance(single, float)
        assert abs(single - double) < 32 * 2.0**-24 * scale


def test_dry_friction_at_rest_is_the_penalised_flow_without_drive():
    """Two implementations of the commonest case."""
    for _ in range(200):
        z, t, n = RNG.normal(), RNG.uniform(0.001, 2), 10 ** RNG.uniform(0, 6)
        general = exact_flows.penalised(z, t, 0.0, 0.0, 1 / n, n, 0.0)
        assert exact_flows.at_rest(z, t, 1 / n, n) == pytest.approx(general, abs=1e-13)
    assert (
        exact_flows.at_rest(0.3, 0.5, 0.0, 1.0)
        == exact_flows.dry_friction(0.3, 0.5, 0.0, 0.0)
        == 0.0
    )


def test_what_is_not_a_number_stays_so():
    """A nan in either argument gives nan, so that a diverged path is seen."""
    for name in FLOWS:
        for z, drive in ((np.nan, 0.3), (0.3, np.nan)):
            if name != "at rest" or np.isnan(z):
                for kind in (np.float32, np.float64):
                    assert np.isnan(FLOWS[name](kind(z), kind(0.1), kind(drive))), name
