"""Elements of one variable: their interpolation and their weights."""

import numpy as np
import pytest

from nonsmooth.grids import elements


@pytest.mark.parametrize("make", [elements.continuous, elements.discontinuous])
def test_interpolation_is_exact_on_polynomials(make):
    """A cubic on elements of degree 3, at points within, on edges and outside."""
    axis = make(np.array([-1.0, 0.3, 2.0]), 3)
    points = np.array([-1.0, -0.4, 0.3, 1.9, 2.0])
    cubic = axis.nodes**3 - axis.nodes
    assert axis.interpolation(points) @ cubic == pytest.approx(points**3 - points, abs=1e-13)
    assert axis.interpolation([2.5]) @ cubic == 0
    assert axis.weights @ cubic == pytest.approx((2.0**4 - 1) / 4 - (2.0**2 - 1) / 2)


class TestDegreesOfTheirOwn:
    """Discontinuous elements of degrees 2, 5 and 3, on which quadratic functions are exact."""

    axis = elements.discontinuous(np.array([-1.0, -0.4, 1.1, 2.0]), np.array([2, 5, 3]))

    def test_quadrature_is_that_of_gauss(self):
        """Three nodes integrate degree 5 exactly, more nodes higher ones."""
        assert len(self.axis.nodes) == 3 + 6 + 4
        assert self.axis.weights @ self.axis.nodes**5 == pytest.approx((2.0**6 - 1) / 6, rel=1e-13)

    def test_interpolation_takes_the_degree_of_each_element(self):
        """Degree 5 is exact in the element of that degree, and not in that of degree 2."""
        inner, outer = np.array([-0.4, 0.2, 1.1 - 1e-12]), np.array([-0.9, -0.45])
        for points, exact in ((inner, True), (outer, False)):
            found = self.axis.interpolation(points) @ self.axis.nodes**5
            assert (found == pytest.approx(points**5, rel=1e-10)) == exact

    @pytest.mark.parametrize("lift", ["lift_left", "lift_right"])
    def test_upwinded_slope_is_exact_without_jumps(self, lift):
        """A smooth function has no jump at a face, so that either side gives its slope."""
        slope = self.axis.slope + getattr(self.axis, lift) @ self.axis.jump
        exact = pytest.approx(2 * self.axis.nodes, rel=1e-12, abs=1e-12)
        assert slope @ self.axis.nodes**2 == exact

    def test_a_jump_is_conserved(self):
        """Across a face, what upwinding adds to the integral of the slope is the jump."""
        step = (self.axis.nodes > 1.1).astype(float)
        for lift in (self.axis.lift_left, self.axis.lift_right):
            slope = self.axis.slope @ step + lift @ (self.axis.jump @ step)
            assert self.axis.weights @ slope == pytest.approx(1.0, rel=1e-12)
