"""The record of the layer's constants."""

from nonsmooth.boundary_layer.constants import LayerConstants

FIRST = LayerConstants(diffusion=1.0, kappa=(0.25, -2.0), u=0.5)


def test_order_follows_from_what_is_known():
    """The orders 1, 2 and 3 need one more group of constants each."""
    second = LayerConstants(1.0, (1.0, 2.0), 0.5, dispersion=0.1, dipole=(0.1, 0.2), h=0.3)
    third = LayerConstants(
        1.0, (1.0, 1.0), 0.5, dispersion=0.1, dipole=(0.1, 0.1), h=0.3, kappa3=(0.0, 0.0), r=0.1
    )
    assert [constants.order for constants in (FIRST, second, third)] == [1, 2, 3]


def test_distance():
    """The distance is taken constant by constant; what is not known stays unknown."""
    found = FIRST.distance(LayerConstants(diffusion=1.5, kappa=(0.0, 1.0), u=0.5))
    assert found == LayerConstants(diffusion=0.5, kappa=(0.25, 3.0), u=0.0)
    assert found.dispersion is None
    assert found.largest() == 3.0
