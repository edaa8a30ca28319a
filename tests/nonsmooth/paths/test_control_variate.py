"""The control variate of the squared integral: what it leaves of the error."""

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
