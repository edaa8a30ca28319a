r"""Errata of the theorems: the proofs of (HV1) and (HV2), and an example they do not cover."""

import math

import numpy as np
import scipy.linalg
from scipy.integrate import quad

from nonsmooth.scenes import equations
from nonsmooth.scenes.noises import KanaiTajimi
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta, x, y, zeta
from nonsmooth.theory import assumptions, drift_bounds, lyapunov
from reproduction.errata.record import Evidence, erratum


def _noisy(damping):
    return Scene("elasto_plastic", KanaiTajimi(1.0, damping), n=1, potential="x**2/2")


@erratum(
    "10a",
    r"Claim 10, eq. \ref{eq:lyapu-bound-S4}; $K_4$, eq. \ref{An4V4epsV4-bound}",
    r"constant $M (1 + K \tilde\delta)$",
    r"$K M (1 + \tilde\delta)$",
)
def claim_constant():
    """Compare both bounds at the origin with S_4(0, 0)."""
    scene = _noisy(1.0)
    origin = {s: np.zeros(1) for s in (eta, zeta)}
    value, terms = drift_bounds.noise_drift(scene, origin)
    return Evidence(
        r"$S_4(0, 0) \leq$, $k = \gamma_0 = 1$",
        drift_bounds.noise_bound(scene, printed=True).constant,
        drift_bounds.noise_bound(scene).constant,
        float(value[0] if np.ndim(value) else value),
        1e-13 * float(np.max(terms)),
        "at least",
    )


def _worst_direction(form, epsilon):
    """Return the largest value on the unit circle of the quadratic part of S_4/K."""
    return float(scipy.linalg.eigvalsh(epsilon * form.energy - form.decay)[-1])


@erratum(
    "10b",
    r"Claim 10; $K_{4,\zeta}$, $K_{4,\eta}$, eq. \ref{An4V4epsV4-bound}",
    r"coefficient $-K \tilde\delta^2$",
    r"$-K \tilde\delta (\tilde\delta - \epsilon)$, also in the bound of $K$, eq. \ref{eq:LB-delta}",
)
def claim_coefficient():
    """Compare both bounds of the quadratic part with its largest eigenvalue.

    epsilon is near delta~, which the paper's condition on epsilon allows where U is steep.
    """
    form = assumptions.dissipation(KanaiTajimi(1.0, 0.01))
    small = 0.99 * form.rate
    return Evidence(
        r"$\max_{|z|=1} S_4 / K$, quadratic part, $\gamma_0 = 0.01$",
        -(form.rate**2),
        -form.rate * (form.rate - small),
        _worst_direction(form, small),
        1e-15,
        "at least",
    )


@erratum(
    "10c",
    r"eq. \ref{eq:def-epsilon-CV}",
    r"$\epsilon < \min(\lambda_3/\delta, C_b, r)$",
    r"and $\epsilon < \tilde\delta$ for noise of type 2",
)
def claim_epsilon():
    """Take the largest epsilon that each condition allows; (HV2) needs a negative value."""
    scene = _noisy(0.001)
    c = lyapunov.constants(scene)
    printed = 0.99 * min(c.confinement.lambda_3 / c.delta, scene.damping)
    form = c.dissipation
    return Evidence(
        r"$\max_{|z|=1} S_4 / K$, quadratic part, $\gamma_0 = 0.001$",
        _worst_direction(form, printed),
        _worst_direction(form, min(printed, 0.99 * form.rate)),
        0.0,
        relation="at most",
        kind="consistency",
    )


@erratum(
    "11",
    r"Proof of (HV1), after eq. \ref{eq:dynamics-DM10-theta}",
    r"$\int_0^T p \, dt \geq c_1 e^{-c_2 \sup|\theta_t - z'|^2}$, $c_2 = C_T T$",
    r"$\int_{T/2}^T$, $c_2 = C_T (T/2)^{1-2d}$, $c_1$ times $T/2$",
)
def petite_sets():
    """Take integrated Brownian motion, whose density is known, at (y, x) = (0, 1), T = 1/2."""
    T, d = 0.5, 2
    covariance = np.array([[1, 1 / 2], [1 / 2, 1 / 3]])
    precision = np.linalg.inv(covariance)
    height = 1 / (2 * np.pi * math.sqrt(np.linalg.det(covariance)))
    # the least C_T for which the lower bound of the density, eq. (16) of the paper, holds
    C_T = max(scipy.linalg.eigvalsh(precision)[-1] / 2, 1 / height)
    c_1 = T ** (-(d**2) / 2) / C_T

    def density(t):
        return height * t ** (-(d**2) / 2) * math.exp(-precision[1, 1] / 2 * t ** (1 - 2 * d))

    integral, error = quad(density, 0.05, T, epsabs=0, epsrel=1e-10)
    return Evidence(
        r"$\log \int_0^T p \, dt \geq$, $T = 1/2$, $d = 2$",
        math.log(c_1) - C_T * T,
        math.log(c_1 * T / 2) - C_T * (T / 2) ** (1 - 2 * d),
        math.log(integral),
        error / integral,
        "at most",
    )


@erratum(
    "12",
    "Sec. 5",
    r"$U \equiv 0$ as an example of the theorems",
    r"violates (HU2); the theorems hold for $Y$ alone, $V_{n,1} = \delta y^2/2 + C_V$",
)
def free_displacement():
    """Evaluate both functions V_n at (y, x) = (-1, 1e9), where they should be at least 1."""
    c = lyapunov.constants(Scene("friction"))
    point = {y: -1, x: 1e9, equations.U(x): 0, lyapunov.delta: c.delta, lyapunov.C_V: c.C_V}
    values = [float(lyapunov.function("white", confined).subs(point)) for confined in (True, False)]
    quantity = r"$V_n(-1, 10^9) \geq 1$"
    return Evidence(quantity, *values, 1.0, relation="at least", kind="consistency")
