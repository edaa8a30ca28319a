r"""Errata of the stationary laws: the invariant density and the spectra of the noises."""

import math

import numpy as np
import scipy.linalg
import sympy
from scipy.integrate import quad

from nonsmooth.scenes import equations
from nonsmooth.scenes.noises import KanaiTajimi, OrnsteinUhlenbeck
from nonsmooth.scenes.symbols import x, y
from nonsmooth.theory import lyapunov
from reproduction.errata.record import Evidence, erratum


@erratum(
    "1",
    "App. A, Remark 11, obstacle",
    r"$\exp(-C_b H_n)$, normaliser with $\exp(-\gamma H_n)$",
    r"$\exp(-2 C_b H_n)$ in both",
)
def gibbs_density():
    """Compare the second moment of both densities with the balance of energy.

    The stationary mean of A_n H_n is zero, which says 1/2 = C_b E y^2.
    """
    C_b = 0.7
    balance = sympy.Poly(_energy_balance(), y)
    injected, dissipated = balance.coeff_monomial(1), -balance.coeff_monomial(y**2)
    values = []
    for factor in (1, 2):
        moments = [
            quad(lambda s, k=k, f=factor: s**k * math.exp(-f * C_b * s**2 / 2), -40, 40)
            for k in (2, 0)
        ]
        values.append((moments[0][0] / moments[1][0], sum(error for _, error in moments)))
    reference = float((injected / dissipated).subs(lyapunov.C_b, C_b))
    return Evidence("$E Y^2$, $C_b = 0.7$", values[0][0], values[1][0], reference, values[1][1])


def _energy_balance():
    """Return A_n (y^2/2 + U(x)) with white noise; the penalty is part of U."""
    free = {equations.f_x(x): 0, equations.f_y(y): 0}
    energy = y**2 / 2 + equations.U(x)
    return sympy.expand(lyapunov.generator(energy, "white").subs(free))


@erratum(
    "2",
    "Sec. 1.1, Ornstein–Uhlenbeck",
    r"$P(\omega) = \frac{\sigma^2}{2 \theta \pi} \frac{1}{\omega^2 + \theta^2}$",
    r"$P(\omega) = \frac{\sigma^2}{2 \pi} \frac{1}{\omega^2 + \theta^2}$",
)
def langevin_spectrum():
    """Compare the total power with the variance, which solves a Lyapunov equation."""
    theta = 2.0
    A, B = _linear(OrnsteinUhlenbeck(theta))
    total, error = quad(lambda w: 1 / (2 * np.pi) / (w**2 + theta**2), -np.inf, np.inf)
    reference = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)[-1, -1]
    quantity = r"$\int P \, d\omega = \operatorname{Var} \eta$, $\theta = 2$"
    return Evidence(quantity, total / theta, total, float(reference), error)


def _linear(noise):
    """Return A and B of dz = A z dt + B dW for a linear noise, z in the order of its state."""
    symbols = list(noise.drift)
    A = [[float(sympy.diff(f, s)) for s in symbols] for f in noise.drift.values()]
    B = [[noise.sigma * (s == noise.driven)] for s in symbols]
    return np.array(A), np.array(B, dtype=float)


_STIFFNESS, _DAMPING = 2.0, 0.6  # k and gamma_0 of the Kanai-Tajimi noise in entry 3


def _ground(omega, weights):
    """Return |transfer function|^2 of a combination of (zeta, eta) at the frequency omega."""
    A, B = _linear(KanaiTajimi(_STIFFNESS, _DAMPING))
    response = np.linalg.solve(1j * omega * np.eye(2) - A, B)
    return float(np.abs(np.array(weights) @ response)[0] ** 2)


@erratum(
    "3a",
    "Sec. 1.1, Kanai–Tajimi",
    r"denominator $(k - \omega^2)^2 + \gamma_0^2 \omega$",
    r"$(k - \omega^2)^2 + \gamma_0^2 \omega^2$",
)
def ground_denominator():
    """Compare the power at a negative frequency with the transfer function of the acceleration."""
    w = -math.sqrt(_STIFFNESS)
    numerator = _STIFFNESS**2 + _DAMPING**2 * w**2
    weights = (_DAMPING, _STIFFNESS)
    reference = _ground(w, weights) / _ground(0.0, weights)
    return Evidence(
        r"$P(\omega)/P(0)$, $\omega = -\sqrt{k}$, $k = 2$, $\gamma_0 = 0.6$",
        numerator / ((_STIFFNESS - w**2) ** 2 + _DAMPING**2 * w),
        numerator / ((_STIFFNESS - w**2) ** 2 + _DAMPING**2 * w**2),
        reference,
        1e-13 * abs(reference),
    )


@erratum(
    "3b",
    "Sec. 1.1, Kanai–Tajimi",
    r"numerator $k^2 + \gamma_0^2 \omega^2$ for $\eta$",
    r"$1$ for $\eta$; as printed for $k \eta + \gamma_0 \zeta$",
)
def ground_numerator():
    """Compare the power of eta with its transfer function, after the denominator is mended."""
    w = math.sqrt(_STIFFNESS)
    denominator = (_STIFFNESS - w**2) ** 2 + _DAMPING**2 * w**2
    reference = _ground(w, (0.0, 1.0)) / _ground(0.0, (0.0, 1.0))
    return Evidence(
        r"$P(\omega)/P(0)$ of $\eta$, $\omega = \sqrt{k}$",
        (_STIFFNESS**2 + _DAMPING**2 * w**2) / denominator,
        _STIFFNESS**2 / denominator,
        reference,
        1e-13 * reference,
    )


@erratum(
    "3c",
    "Sec. 1.1, Kanai–Tajimi",
    r"prefactor $\sigma$",
    r"$\sigma^2 / (2 \pi)$, as for Ornstein–Uhlenbeck",
)
def ground_prefactor():
    """Compare the total power with the variance, after all else is mended."""
    sigma = 2.0
    noise = KanaiTajimi(_STIFFNESS, _DAMPING, sigma)

    def power(w):
        return 1 / ((_STIFFNESS - w**2) ** 2 + _DAMPING**2 * w**2)

    total, error = quad(power, -np.inf, np.inf, limit=200)
    A, B = _linear(noise)
    reference = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)[1, 1]
    return Evidence(
        r"$\int P \, d\omega = \operatorname{Var} \eta$, $\sigma = 2$",
        sigma * total,
        sigma**2 / (2 * np.pi) * total,
        float(reference),
        error * sigma**2,
    )
