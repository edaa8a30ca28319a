"""What `nonsmooth` itself offers is annotated, documented, and complete."""

import inspect

import pytest

import nonsmooth as ns

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


def test_the_docstring_names_everything_public():
    """The docstring and `__init__.pyi`, which type checkers see, name everything public."""
    for name in ns.__all__:
        assert f"`{name}`" in ns.__doc__, name
        assert inspect.getdoc(getattr(ns, name)), name
    assert ns.__version__.count(".") == 2
