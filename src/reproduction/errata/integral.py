r"""Errata on the integral of g: its mean, its variance, and its threshold crossings."""

import math

import numpy as np

from nonsmooth.crossing.brownian import brownian_crossing
from nonsmooth.line import eigenfunctions
from nonsmooth.line.dry_friction import friction_variance
from nonsmooth.line.finite_differences import moments_with_error, system
from nonsmooth.scenes.scene import Scene
from reproduction.errata.record import Evidence, erratum

_GRID = 6.0, 601  # half width and nodes of the paper's scheme; the kinks at n = 5 are nodes
_DEGREE = 12  # of the spectral elements; solutions of degree 8 differ by less than 1e-9


@erratum(
    "4",
    "Sec. 5.2",
    r"asymptotic value “roughly $1.36$”",
    r"ten times too large; the limit is $\gamma_n^2$, not $v(0,T)/T$ of table 4",
)
def asymptotic_value():
    """Compare the rounded closed form with spectral elements, n = 100."""
    scene = Scene("friction")
    mended = round(friction_variance(scene.n)[0], 4)
    reference = eigenfunctions.asymptotic_variance(scene, _DEGREE)
    return Evidence(r"$\gamma_n^2$, $n = 100$", 1.36, mended, reference, 0.5e-4)


def _variance_rate(n):
    """Return v(0, T)/T of table 4, T = 100."""
    horizon = 100.0
    return eigenfunctions.moments(Scene("friction", n=n), [horizon], _DEGREE)[1][0] / horizon


@erratum(
    "5a",
    "Table 4, Fig. 2a",
    r"entries and axis named $v(0, T)$, $v(0, \tau)$",
    r"$v(0, T)/T$, $v(0, \tau)/\tau$",
)
def variance_or_rate():
    """Take the printed number as v(0, T), as it is called, and as v(0, T)/T; n = 100."""
    printed, horizon = 0.136784, 100
    reference = horizon * _variance_rate(100)
    return Evidence(
        "$v(0, 100)$, $n = 100$", printed, horizon * printed, reference, horizon * 0.5e-6
    )


def _rounded(n, printed):
    """Compare the printed sixth digit of table 4 with a rounded value of a lower degree."""
    scheme = eigenfunctions.moments(Scene("friction", n=n), [100.0], _DEGREE - 4)[1][0] / 100
    return Evidence(
        f"$v(0, 100)/100$, $n = {n}$", printed, round(scheme, 6), _variance_rate(n), 0.5e-6
    )


@erratum("5b", "Table 4, $n = 2$", "$0.174466$, truncated", "rounded to six digits")
def truncated_entry():
    """Compare the entry of n = 2."""
    return _rounded(2, 0.174466)


@erratum("5c", "Table 4, $n = 50$", "$0.136834$", "rounded to six digits")
def low_entry():
    """Compare the entry of n = 50."""
    return _rounded(50, 0.136834)


@erratum(
    "6",
    "Sec. 5.2",
    r"exponential convergence of $v(0, \tau)/\tau$",
    r"$O(1/\tau)$; exponential that of $v(0, \tau) - \gamma^2 \tau$ to its constant",
)
def convergence_in_time():
    """Predict the distance at tau = 80 from those at 20 and 40: exponential, and like 1/tau."""
    scene = Scene("friction")
    times = np.array([20.0, 40.0, 80.0])
    gamma2 = friction_variance(scene.n)[0]
    near, middle, far = gamma2 - eigenfunctions.moments(scene, times, _DEGREE)[1] / times
    # the slowest mode decays at a rate above 2.5, and exp(-2.5 * 20) is below rounding
    error = eigenfunctions.rounding(scene, _DEGREE) * gamma2
    quantity = r"$\gamma^2 - v(0, \tau)/\tau$ at $\tau = 80$ from $\tau = 20$, $40$"
    return Evidence(quantity, middle * (middle / near) ** 2, middle / 2, far, error)


@erratum(
    "7",
    r"eq. \ref{taularge-u}",
    r"$u_g^n(y, \tau) \sim \int g m_n$",
    r"$w_g^n(y, \tau) \sim \tau \int g m_n$",
)
def mean_of_the_integral():
    """Compare the increase from tau = 25 to 50 by both formulas with the paper's own scheme."""
    scene = Scene("friction", n=5, observable="y**2")
    mean = eigenfunctions.mean(scene)
    (first, second), _, error, _ = moments_with_error(scene, [25.0, 50.0], *_GRID, 0.05)
    quantity = r"$w(0, 50) - w(0, 25)$, $g = y^2$, $n = 5$"
    return Evidence(quantity, mean - mean, 25 * mean, second - first, sum(error))


@erratum(
    "8",
    r"eq. \ref{eq:defvgyt}",
    r"$E_y[(\int g(Y_s) - E[g(Y_s)] ds)^2]$",
    r"$E_y[(\int g(Y_s) - E_y[g(Y_s)] ds)^2]$",
)
def inner_expectation():
    """Subtract the stationary mean, which is 0, and then E_y.

    The reference is the equation for v, eq. (37) of the paper, solved by the paper's scheme.
    """
    scene = Scene("friction", n=5, start={"y": 1.0})
    w, v = eigenfunctions.moments(scene, [5.0], _DEGREE)
    _, reference, _, error = moments_with_error(scene, [5.0], *_GRID, 0.01)
    quantity = r"$v(1, 5)$ of eq. \ref{eq:PDEv}, $n = 5$"
    return Evidence(quantity, v[0] + w[0] ** 2, v[0], reference[0], error[0])


@erratum(
    "9",
    "App. C, right-hand sides",
    r"$\Delta t\, G_i + U_i^k$, $\Delta t (D U^k)_i^2 + V_i^k$",
    r"$\Delta t\, G_i + W_i^{k-1}$, $\Delta t (D W^k)_i^2 + V_i^{k-1}$",
)
def time_levels():
    """Solve the printed system in the sense of the least norm.

    As printed, both sides contain the unknown of the same step, so that the system is singular and
    the same at every step.
    """
    scene = Scene("friction", n=5, start={"y": 1.0})
    mended, _, error, _ = moments_with_error(scene, [0.5], *_GRID, 0.005)
    at, lower, main, upper, source = system(scene, 6.0, 241, 0.005)
    inner = np.ones(len(at))
    inner[[0, -1]] = 0.0  # the boundary rows contain no previous step
    matrix = np.diag(main - inner) + np.diag(lower[1:], -1) + np.diag(upper[:-1], 1)
    steady = np.linalg.lstsq(matrix, inner * source, rcond=1e-12)[0]
    printed = np.interp(1.0, at, steady)
    reference = eigenfunctions.moments(scene, [0.5], _DEGREE)[0][0]
    return Evidence("$w(1, 1/2)$, $g = y$, $n = 5$", printed, mended[0], reference, error[0])


@erratum(
    "13",
    r"eq. \ref{equivalent}",
    r"$W_\star(b/\gamma, T)$ for every $g$",
    r"if $\int g m_n = 0$; otherwise the limit is $1$",
)
def centred_observable():
    """Compare the limits for g = y + 1 with Chebyshev's bound of the probability at p = 1e4."""
    threshold, horizon, p = 0.6, 2.0, 1e4
    scene = Scene("friction", observable="y + 1")
    mean = eigenfunctions.mean(scene)
    gamma2 = eigenfunctions.asymptotic_variance(scene, _DEGREE)
    printed = float(brownian_crossing(threshold / math.sqrt(gamma2), horizon))
    w, v = eigenfunctions.moments(scene, [p * horizon], _DEGREE)
    distance = p * horizon * mean + w[0] - math.sqrt(p) * threshold
    return Evidence(
        r"$\lim W(\sqrt{p}\, b, p T) \geq$, $g = y + 1$, $b = 0.6$, $T = 2$",
        printed,
        1.0,
        1 - v[0] / distance**2,
        relation="at least",
    )
