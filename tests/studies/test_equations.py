"""Equations of scenes and of structures, as LaTeX that reports can typeset."""

import math

import pytest
import tylax

from nonsmooth.dimensions import Structure
from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.noises import NOISES
from nonsmooth.scenes.scene import Scene
from studies.equations import of_scene, of_structure


@pytest.mark.parametrize("n", [10.0, math.inf])
@pytest.mark.parametrize("noise", NOISES)
@pytest.mark.parametrize("model", MODELS)
def test_every_scene_has_equations(model, noise, n):
    """One for each variable, and the observable; no function is left open but the penalty."""
    scene = Scene(model, noise, n=n, potential="x**2/2")
    found = of_scene(scene)
    assert sum(law.startswith(r"\dot") for law in found) == len(scene.variables)
    assert found[-1].startswith("g = ")
    text = " ".join(found)
    assert not any(f"{name}{{" in text for name in ("U", "H", "F"))
    assert text.count(r"\dot W") == 1
    assert all(tylax.latex_to_typst(law) for law in found)


def test_numbers_are_short():
    """1 up to rounding is 1."""
    parameters = {"mass": 1200, "damping": 3000, "limit": 700, "spectral_density": 0.008}
    ground = {"ground_frequency": 2.4 * 2 * math.pi, "ground_damping": 0.6}
    structure = Structure("friction", **parameters, **ground)
    assert of_scene(structure.scene())[0] == r"\dot \zeta = - \eta - 1.2 \zeta + \sigma \dot W"
    assert r"\omega_g^2 w" in of_structure(structure, math.inf)[-1]
