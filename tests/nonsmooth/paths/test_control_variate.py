"""The control variate of the squared integral: what it leaves of the error."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

import nonsmooth as ns
from nonsmooth.paths.control_variate import poisson_slope
from nonsmooth.paths.ensembles import gram
from nonsmooth.paths.moments import moments
from nonsmooth.paths.sampling import Sampling
from references import FRICTION


def test_control_variate_leaves_a_fraction_of_the_error():
    """D^2 less its regression on M^2 - <M> leaves R (2 M + R), R bounded, and the spread of <M>.

    Their standard deviations grow like T^(1/2), against T for D^2, so that the ratio falls until
    what two Hermite polynomials of a kick do not carry is left.
    """
    tau = [5.0, 40.0]
    plain, controlled = (
        moments(gram(FRICTION, tau, Sampling(0.05, 20_000, 2), control))
        for control in (False, True)
    )
    ratio = controlled["variance_error"] / plain["variance_error"]
    assert ratio[0] < 1 / 3
    assert ratio[1] < 0.8 * ratio[0]


@pytest.mark.parametrize("spread", [0.03, 0.1, 0.3])
@pytest.mark.parametrize(
    "scene",
    [
        FRICTION,
        ns.Scene("friction", n=2),
        ns.Scene("friction", ns.White(2.0), damping=0.2),
        ns.Scene("friction", ns.White(0.5), damping=5.0),
        ns.Scene("friction", observable="y + 0.3*abs(y)"),
        ns.Scene("friction", observable="tanh(5*y)"),
    ],
    ids=["unit", "soft", "weak", "strong", "skewed", "saturated"],
)
def test_polynomials_are_near_the_slope(scene, spread):
    """In the mean over the invariant density, by 2 % of its root mean square."""
    table = poisson_slope(scene)
    y = np.linspace(-1, 1, len(table.values))
    below, above = (np.polyval(c[::-1], np.abs(y)) for c in table.polynomials(spread))
    kicked = gaussian_filter1d(table.values, spread / (table.reach * (y[1] - y[0])), mode="nearest")
    off = np.where(y < 0, below, above) - kicked
    assert off @ (table.density * off) < 0.02**2 * (kicked @ (table.density * kicked))
