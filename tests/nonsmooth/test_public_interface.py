"""What `nonsmooth` itself offers is annotated, documented, and complete."""

import inspect

import pytest

import nonsmooth as ns
from references import FRICTION

FUNCTIONS = [name for name in ns.__all__ if inspect.isfunction(getattr(ns, name))]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_public_functions_are_annotated_and_documented(name):
    """Every parameter has a type and an entry in the docstring; what is returned has a type."""
    function = getattr(ns, name)
    signature, text = inspect.signature(function), inspect.getdoc(function)
    assert signature.return_annotation is not inspect.Signature.empty
    documented = {
        part.strip()
        for line in text.split("Parameters\n---")[1].splitlines()
        for part in line.split(" : ")[0].split(",")
    }
    for parameter in signature.parameters.values():
        assert parameter.annotation is not inspect.Parameter.empty, parameter.name
        assert parameter.name in documented, parameter.name
    assert "Returns\n---" in text or function.__annotations__["return"] in (
        ns.Langevin,
        ns.Hamiltonian,
    )


OF_SCENES = [
    name
    for name in FUNCTIONS
    if next(iter(inspect.signature(getattr(ns, name)).parameters)) == "scene"
]


@pytest.mark.parametrize("name", OF_SCENES)
@pytest.mark.parametrize(
    ("given", "written"),
    [
        ("friction", "write nonsmooth.Scene('friction')"),
        ("Elastoplastic", "write nonsmooth.Scene('elasto_plastic')"),
        ({"model": "friction"}, "write nonsmooth.Scene(**scene)"),
        (None, "write nonsmooth.Scene('friction'), for example"),
    ],
)
def test_what_is_no_scene_is_told_how_to_make_one(name, given, written):
    """Every function that takes a scene says so before it looks at anything else."""
    function = getattr(ns, name)
    others = list(inspect.signature(function).parameters.values())[1:]
    needed = {one.name: 1.0 for one in others if one.default is inspect.Parameter.empty}
    with pytest.raises(ns.NonsmoothError) as told:
        function(given, **needed)
    assert str(told.value).endswith(written)


@pytest.mark.parametrize(
    ("ask", "written"),
    [
        (lambda: ns.state_crossing_probability(FRICTION, "velocity", 1, 1), "mean 'y'?"),
        (lambda: ns.crossing_sensitivity(FRICTION, 0.6, 1, "b"), "mean 'threshold'?"),
        (lambda: ns.asymptotic_variance_sensitivity(FRICTION, "C_b"), "mean 'damping'?"),
        (lambda: ns.Scene("elasto_plastic", observable="plastic_strain"), "'plastic_strain_rate'?"),
        (lambda: ns.hazard_rate(FRICTION, [0.5, 0.6], 1), "give one number b > 0"),
        (lambda: ns.crossing_probability(FRICTION, 0.6, 1, envelope=2), "write it in quotes"),
    ],
)
def test_frequent_mistakes_are_told_what_to_write(ask, written):
    """Names from elsewhere, and one thing where another is wanted."""
    with pytest.raises(ns.NonsmoothError) as told:
        ask()
    assert written in str(told.value)


def test_the_docstring_names_everything_public():
    """The docstring and `__init__.pyi`, which type checkers see, name everything public."""
    for name in ns.__all__:
        assert f"`{name}`" in ns.__doc__, name
        assert inspect.getdoc(getattr(ns, name)), name
    assert ns.__version__.count(".") == 2
