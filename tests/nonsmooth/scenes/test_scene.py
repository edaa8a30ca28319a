"""Scenes reduce themselves to their minimal state and refuse what makes no sense."""

import warnings

import pytest

import nonsmooth as ns
from nonsmooth.errors import AssumptionWarning, NonsmoothError, SceneError
from nonsmooth.scenes.scene import by_formulas


@pytest.mark.parametrize(
    ("scene", "state"),
    [
        ({"model": "friction"}, ("y",)),
        ({"model": "friction", "observable": "x"}, ("y", "x")),
        ({"model": "friction", "potential": "x**2/2"}, ("y", "x")),
        ({"model": "friction", "noise": "langevin"}, ("eta", "y")),
        ({"model": "friction", "noise": "hamiltonian"}, ("zeta", "eta", "y")),
        ({"model": "elasto_plastic"}, ("y",)),
        ({"model": "elasto_plastic", "potential": "x**2/2"}, ("y", "x")),
        ({"model": "elasto_plastic", "observable": "x"}, ("y", "x")),
        ({"model": "obstacle"}, ("y", "x")),
        ({"model": "obstacle", "noise": "langevin"}, ("eta", "y", "x")),
        ({"model": "obstacle", "noise": "hamiltonian"}, ("zeta", "eta", "y", "x")),
        ({"model": "obstacle", "noise": "hamiltonian", "observable": "eta"}, ("zeta", "eta")),
    ],
)
def test_minimal_state(scene, state):
    """The state is closed under the drift and contains the observable's variables, no more."""
    assert ns.Scene(**scene).state == state


@pytest.mark.parametrize(
    ("scene", "offender"),
    [
        ({"model": "fricton"}, "did you mean 'friction'"),
        ({"model": "friction", "noise": "whit"}, "did you mean 'white'"),
        ({"model": "friction", "n": 0}, "n is 0; give a positive"),
        ({"model": "friction", "n": float("nan")}, "n is nan"),
        ({"model": "friction", "damping": -1}, "damping is -1"),
        ({"model": "friction", "damping": float("inf")}, "damping is inf"),
        ({"model": "friction", "observable": "eta"}, "eta"),
        ({"model": "friction", "potential": "y"}, "'y'"),
        ({"model": "friction", "start": {"z": 1}}, "'z'"),
        ({"model": "obstacle", "n": float("inf"), "start": {"x": 2.0}}, "confined to [-1, 1]"),
    ],
)
def test_impossible_scenes_are_refused(scene, offender):
    """The error is one line that names the offender."""
    with pytest.raises(NonsmoothError) as error:
        ns.Scene(**scene)
    assert offender in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("noise", "offender"),
    [
        (lambda: ns.Langevin("-eta**2/2"), "not confining"),
        (lambda: ns.Langevin("abs(eta)"), "not confining"),
        (lambda: ns.Langevin("eta**4/4", sigma=0), "sigma is 0"),
        (lambda: ns.OrnsteinUhlenbeck(theta=-1), "theta is -1"),
        (lambda: ns.Hamiltonian("eta**2/2 - zeta**2/2", "1"), "does not confine"),
        (lambda: ns.Hamiltonian("eta**2", "1"), "does not confine"),
        (lambda: ns.Hamiltonian("(eta + zeta)**2", "1"), "does not confine"),
        (lambda: ns.Hamiltonian("(eta + 2*zeta)**2", "1"), "does not confine"),
        (lambda: ns.Hamiltonian("(eta + 2*zeta)**4", "1"), "does not confine"),
        (lambda: ns.Hamiltonian("(eta + 2*zeta)**2*(1 + eta**2)", "1"), "does not confine"),
        (lambda: ns.Hamiltonian("eta**2/2 + zeta**2/2", "-1"), "not positive"),
        (lambda: ns.KanaiTajimi(stiffness=0), "stiffness of the noise is 0"),
    ],
)
def test_impossible_noises_are_refused(noise, offender):
    """The error is one line that names the offender."""
    with pytest.raises(NonsmoothError, match=offender) as error:
        noise()
    assert "\n" not in str(error.value)


def test_what_the_theorems_do_not_cover_is_warned_about():
    """U that does not grow quadratically, where the displacement is part of the state."""
    for potential in ("0", "abs(x)", "cos(x)", "-x**2"):
        with pytest.warns(AssumptionWarning, match=r"violates \(HU2\)"):
            ns.Scene("friction", potential=potential, observable="x")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ns.Scene("friction")  # only the velocity matters
        ns.Scene("obstacle")  # the walls confine
        ns.Scene("friction", potential="x**2/2 + 0.3*cos(3*x)", observable="x")
        ns.Scene("elasto_plastic", potential="(x**2 - 4)**2/100")


@pytest.mark.parametrize("noise", [None, 0.0, "none"])
def test_a_scene_without_noise_is_refused(noise):
    """The error is one line that says what to choose from."""
    with pytest.raises(SceneError, match="white"):
        ns.Scene("friction", noise=noise)


def test_colored_noise_by_formulas():
    """It is of type 2 if it has a Hamiltonian, and a name stays a name."""
    rest = {"model": "friction", "potential": "0", "observable": "y"}
    for noise, expected in (
        ("white", ns.White()),
        ({"potential": "eta**4/4", "sigma": 2.0}, ns.Langevin("eta**4/4", 2.0)),
        ({"H": "eta**4 + zeta**2", "F": "2"}, ns.Hamiltonian("eta**4 + zeta**2", "2")),
    ):
        assert by_formulas(rest | {"noise": noise}).noise == expected


def test_penalty_force_is_an_observable():
    """It goes by its name in the model; the state is the smallest that determines it."""
    scene = ns.Scene("friction", observable="friction_force")
    assert scene.state == ("y",)
    assert scene.is_odd()
    assert not ns.Scene("friction", observable="y + 1").is_odd()
    with pytest.raises(SceneError, match="write 'friction_force'"):
        ns.Scene("friction", observable="contact_force")


def test_what_is_warned_of_is_said_once():
    """Scenes derived from one that was warned of are silent, and the same in all else."""
    with pytest.warns(AssumptionWarning, match="Lyapunov"):
        scene = ns.Scene("friction", n=5.0, observable="y**3", start={"y": 0.5})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        stiffer, moved = scene.with_n(50), scene.with_start({"y": 1})
    assert (stiffer.n, stiffer.identity) == (50.0, scene.identity)
    assert (moved.n, moved.start) == (5.0, {"y": 1.0})
    with pytest.raises(SceneError, match="n is -1"):
        scene.with_n(-1)


@pytest.mark.parametrize(
    ("observable", "warned"),
    [("y", False), ("sign(y)", False), ("y**4", True), ("exp(y)", True)],
)
def test_warns_where_g_is_above_the_lyapunov_function(observable, warned):
    """The theorems ask for g^2 <= V: x^2 exceeds this for a quadratic U, not for a quartic one."""
    for g, U, expected in (
        (observable, "x**2/2", warned),
        ("x**2", "x**2/2", True),
        ("x**2", "x**4", False),
    ):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ns.Scene("friction", potential=U, observable=g)
        assert bool(caught) == expected


@pytest.mark.parametrize(
    ("mistake", "cure"),
    [
        (lambda: ns.Langevin(3, 2.5), r"OrnsteinUhlenbeck\(theta=3, sigma=2.5\)"),
        (lambda: ns.Langevin(lambda eta: eta), "in quotes"),
        (lambda: ns.Scene("friction", potential="x^2/2"), r"write 'x\*\*2/2'"),
        (lambda: ns.Scene("friction", potential="x²/2"), r"write 'x\*\*2/2'"),
        (lambda: ns.Scene("friction", potential=2), r"in quotes, such as 'x\*\*2/2'"),
        (lambda: ns.Scene("friction", observable="velocity"), "write y$"),
        (lambda: ns.Scene("friction", observable="Displacement"), "write x$"),
        (lambda: ns.Scene("friction", observable="np.sin(y)"), "write sin$"),
        (lambda: ns.Scene("friction", observable="math.pi*y"), "write pi$"),
        (lambda: ns.Scene("friction", observable="ln(abs(y) + 1)"), "write log$"),
        (lambda: ns.Scene("friction", observable="contact_force"), "write 'friction_force'"),
        (lambda: ns.Scene("friction", observable=0), "in quotes, such as 'y'"),
        (lambda: ns.Scene("friction", n="inf"), r"write float\('inf'\)"),
        (lambda: ns.Scene("friction", "kanai-tajimi"), "did you mean 'kanai_tajimi'"),
        (lambda: ns.Scene("friction", ns.White), r"nonsmooth.White\(sigma=0.5\)"),
    ],
)
def test_a_mistake_is_told_what_to_write(mistake, cure):
    """One line, which ends with what was meant."""
    with pytest.raises(NonsmoothError, match=cure) as told:
        mistake()
    assert "\n" not in str(told.value)


def test_noises_have_their_names_in_engineering():
    """They stand for the same objects, so that scenes and their streams are the same."""
    for name, kind in (("ornstein_uhlenbeck", "langevin"), ("kanai_tajimi", "hamiltonian")):
        assert ns.Scene("friction", name) == ns.Scene("friction", kind)
