r"""What is wrong in the paper, each printed formula beside a mended one and a reference.

An erratum is a function without arguments that evaluates the printed formula, the mended one and
something independent of both, all from definitions of this package. The texts are LaTeX, quoted
from the paper.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import sympy
from scipy.integrate import quad

from nonsmooth.crossing.brownian import brownian_crossing
from nonsmooth.line import eigenfunctions
from nonsmooth.line.dry_friction import friction_variance
from nonsmooth.line.finite_differences import moments_with_error, system
from nonsmooth.scenes import equations
from nonsmooth.scenes.noises import NOISES, KanaiTajimi, OrnsteinUhlenbeck, hamiltonian_drift
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta, x, y, zeta
from nonsmooth.theory import assumptions, drift_bounds, lyapunov

_GRID = 6.0, 601  # half width and nodes of the paper's scheme, the kinks at n = 5 among them
_DEGREE = 12  # of the spectral elements; the differences to degree 8 are below 1e-9


@dataclass(frozen=True)
class Evidence:
    """One quantity by the printed formula, the mended one, and independently.

    Attributes
    ----------
    quantity : str
        What is evaluated, LaTeX.
    printed, mended, reference : float
    error : float
        Error of the comparison: of the reference, of the quadratures, or of the last digit.
    relation : {"equal", "bound", "below"}
        What a right value is: equal to the reference, at least as large, or at most as large.
    kind : {"numerical", "symbolic", "consistency"}
        Two computations; algebra without rounding; a law that any right formula obeys.
    """

    quantity: str
    printed: float
    mended: float
    reference: float
    error: float = 0.0
    relation: str = "equal"
    kind: str = "numerical"

    def holds(self, value):
        """Whether a value stands in the relation to the reference."""
        excess = value - self.reference
        return {
            "equal": abs(excess) <= self.error,
            "bound": excess >= -self.error,
            "below": excess <= self.error,
        }[self.relation]


@dataclass(frozen=True)
class Erratum:
    """An entry of the list.

    Attributes
    ----------
    label : str
        Number of the entry, with a letter where it has several parts.
    place, wrong, right : str
        Where in the paper, what is printed there and what should be, LaTeX.
    evaluate : callable
        Returns the Evidence.
    """

    label: str
    place: str
    wrong: str
    right: str
    evaluate: Callable


ERRATA = []


def _erratum(label, place, wrong, right):
    def register(evaluate):
        ERRATA.append(Erratum(label, place, wrong, right, evaluate))
        return evaluate

    return register


@_erratum(
    "1",
    "App. A, Remark, obstacle",
    r"$\exp(-C_b H_n)$, normaliser with $\exp(-\gamma H_n)$",
    r"$\exp(-2 C_b H_n)$ in both",
)
def gibbs_density():
    """Compare moments of both densities with the energy balance 0 = E A_n H_n = 1/2 - C_b E y^2."""
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
    """Return A_n (y^2/2 + U(x)) without penalties besides U, with white noise."""
    free = {equations.f_x(x): 0, equations.f_y(y): 0}
    energy = y**2 / 2 + equations.U(x)
    return sympy.expand(lyapunov.generator(energy, "white").subs(free))


@_erratum(
    "2",
    "Sec. 1.1, Ornstein–Uhlenbeck",
    r"$P(\omega) = \frac{\sigma^2}{2 \theta \pi} \frac{1}{\omega^2 + \theta^2}$",
    r"$P(\omega) = \frac{\sigma^2}{2 \pi} \frac{1}{\omega^2 + \theta^2}$",
)
def langevin_spectrum():
    """Compare the total power with the variance, the solution of a Lyapunov equation."""
    theta = 2.0
    A, B = _linear(OrnsteinUhlenbeck(theta))
    total, error = quad(lambda w: 1 / (2 * np.pi) / (w**2 + theta**2), -np.inf, np.inf)
    reference = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)[-1, -1]
    quantity = r"$\int P \, d\omega = \operatorname{Var} \eta$, $\theta = 2$"
    return Evidence(quantity, total / theta, total, float(reference), error)


def _linear(noise):
    """Matrices of d z = A z dt + B dW for a linear noise, z in the order of its state."""
    symbols = list(noise.drift)
    A = [[float(sympy.diff(f, s)) for s in symbols] for f in noise.drift.values()]
    B = [[noise.sigma * (s == noise.driven)] for s in symbols]
    return np.array(A), np.array(B, dtype=float)


_STIFFNESS, _DAMPING = 2.0, 0.6


def _ground(omega, weights):
    """|transfer function|^2 of a combination of (zeta, eta) at the frequency omega."""
    A, B = _linear(KanaiTajimi(_STIFFNESS, _DAMPING))
    response = np.linalg.solve(1j * omega * np.eye(2) - A, B)
    return float(np.abs(np.array(weights) @ response)[0] ** 2)


@_erratum(
    "3a",
    "Sec. 1.1, Kanai–Tajimi",
    r"denominator $(k - \omega^2)^2 + \gamma_0^2 \omega$",
    r"$(k - \omega^2)^2 + \gamma_0^2 \omega^2$",
)
def ground_denominator():
    """Compare the power at a negative frequency with the acceleration's transfer function."""
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


@_erratum(
    "3b",
    "Sec. 1.1, Kanai–Tajimi",
    r"numerator $k^2 + \gamma_0^2 \omega^2$ for $\eta$",
    r"$1$ for $\eta$; as printed for $k \eta + \gamma_0 \zeta$",
)
def ground_numerator():
    """Compare the power of eta, the denominator mended, with its transfer function."""
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


@_erratum(
    "3c",
    "Sec. 1.1, Kanai–Tajimi",
    r"prefactor $\sigma$",
    r"$\sigma^2 / (2 \pi)$, as for Ornstein–Uhlenbeck",
)
def ground_prefactor():
    """Compare the total power, all else mended, with the variance by a Lyapunov equation."""
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


@_erratum(
    "4",
    "Sec. 5.2",
    r"asymptotic value “roughly $1.36$”",
    r"ten times too large; the limit is $\gamma_n^2$, not $v(0,T)/T$ of table 4",
)
def asymptotic_value():
    """Compare the closed form, rounded, with spectral elements, n = 100."""
    scene = Scene("friction")
    mended = round(friction_variance(scene.n)[0], 4)
    reference = eigenfunctions.asymptotic_variance(scene, _DEGREE)
    return Evidence(r"$\gamma_n^2$, $n = 100$", 1.36, mended, reference, 0.5e-4)


def _growth(n):
    """v(0, T)/T of table 4, T = 100."""
    horizon = 100.0
    return eigenfunctions.moments(Scene("friction", n=n), [horizon], _DEGREE)[1][0] / horizon


@_erratum(
    "5a",
    "Table 4, Fig. 2a",
    r"entries and axis named $v(0, T)$, $v(0, \tau)$",
    r"$v(0, T)/T$, $v(0, \tau)/\tau$",
)
def growth_rate_by_name():
    """Take the printed number by its name and as a rate; reference v(0, T), n = 100."""
    printed, horizon = 0.136784, 100
    reference = horizon * _growth(100)
    return Evidence(
        "$v(0, 100)$, $n = 100$", printed, horizon * printed, reference, horizon * 0.5e-6
    )


def _rounded(n, printed):
    scheme = eigenfunctions.moments(Scene("friction", n=n), [100.0], _DEGREE - 4)[1][0] / 100
    return Evidence(f"$v(0, 100)/100$, $n = {n}$", printed, round(scheme, 6), _growth(n), 0.5e-6)


@_erratum("5b", "Table 4, $n = 2$", "$0.174466$, truncated", "rounded to six digits")
def truncated_entry():
    """Compare the sixth digit, n = 2."""
    return _rounded(2, 0.174466)


@_erratum("5c", "Table 4, $n = 50$", "$0.136834$", "rounded to six digits")
def low_entry():
    """Compare the sixth digit, n = 50."""
    return _rounded(50, 0.136834)


@_erratum(
    "6",
    "Sec. 5.2",
    r"exponential convergence of $v(0, \tau)/\tau$",
    r"$O(1/\tau)$; exponential that of $v(0, \tau) - \gamma^2 \tau$ to its constant",
)
def convergence_in_time():
    """Predict the distance at tau = 80 from those at 20 and 40 by both laws."""
    scene = Scene("friction")
    times = np.array([20.0, 40.0, 80.0])
    gamma2 = friction_variance(scene.n)[0]
    near, middle, far = gamma2 - eigenfunctions.moments(scene, times, _DEGREE)[1] / times
    # the slowest mode's rate is above 2.5: exp(-2.5 * 20) is nothing
    error = eigenfunctions.rounding(scene, _DEGREE) * gamma2
    quantity = r"$\gamma^2 - v(0, \tau)/\tau$ at $\tau = 80$ from $\tau = 20$, $40$"
    return Evidence(quantity, middle * (middle / near) ** 2, middle / 2, far, error)


@_erratum(
    "7",
    r"eq. (taularge-u)",
    r"$u_g^n(y, \tau) \sim \int g m_n$",
    r"$w_g^n(y, \tau) \sim \tau \int g m_n$",
)
def mean_growth():
    """Compare the growth from tau = 25 to 50 by both laws with the paper's own scheme."""
    scene = Scene("friction", n=5, observable="y**2")
    mean = eigenfunctions.mean(scene)
    (first, second), _, error, _ = moments_with_error(scene, [25.0, 50.0], *_GRID, 0.05)
    quantity = r"$w(0, 50) - w(0, 25)$, $g = y^2$, $n = 5$"
    return Evidence(quantity, mean - mean, 25 * mean, second - first, sum(error))


@_erratum(
    "8",
    "eq. (defvgyt)",
    r"$E_y[(\int g(Y_s) - E[g(Y_s)] ds)^2]$",
    r"$E_y[(\int g(Y_s) - E_y[g(Y_s)] ds)^2]$",
)
def inner_expectation():
    """Put the stationary mean 0 inside, and E_y; reference eq. (PDEv) by the paper's scheme."""
    scene = Scene("friction", n=5, start={"y": 1.0})
    w, v = eigenfunctions.moments(scene, [5.0], _DEGREE)
    _, reference, _, error = moments_with_error(scene, [5.0], *_GRID, 0.01)
    quantity = "$v(1, 5)$ of eq. (PDEv), $n = 5$"
    return Evidence(quantity, v[0] + w[0] ** 2, v[0], reference[0], error[0])


@_erratum(
    "9",
    "App. C, right-hand sides",
    r"$\Delta t\, G_i + U_i^k$, $\Delta t (D U^k)_i^2 + V_i^k$",
    r"$\Delta t\, G_i + W_i^{k-1}$, $\Delta t (D W^k)_i^2 + V_i^{k-1}$",
)
def time_levels():
    """Solve the printed system, which is singular and the same at every step, in least norm."""
    scene = Scene("friction", n=5, start={"y": 1.0})
    mended, _, error, _ = moments_with_error(scene, [0.5], *_GRID, 0.005)
    at, lower, main, upper, source = system(scene, 6.0, 241, 0.005)
    inner = np.ones(len(at))
    inner[[0, -1]] = 0.0  # the Neumann rows have no previous step
    matrix = np.diag(main - inner) + np.diag(lower[1:], -1) + np.diag(upper[:-1], 1)
    steady = np.linalg.lstsq(matrix, inner * source, rcond=1e-12)[0]
    printed = np.interp(1.0, at, steady)
    reference = eigenfunctions.moments(scene, [0.5], _DEGREE)[0][0]
    return Evidence("$w(1, 1/2)$, $g = y$, $n = 5$", printed, mended[0], reference, error[0])


def _noisy(damping, n=1):
    return Scene("elasto_plastic", KanaiTajimi(1.0, damping), n=n, potential="x**2/2")


@_erratum(
    "10a",
    "Claim $S_4$, $K_4$",
    r"constant $M (1 + K \tilde\delta)$",
    r"$K M (1 + \tilde\delta)$",
)
def claim_constant():
    """Compare the bounds at the origin with S_4(0, 0)."""
    scene = _noisy(1.0)
    origin = {s: np.zeros(1) for s in (eta, zeta)}
    value, terms = drift_bounds.noise_drift(scene, origin)
    return Evidence(
        r"$S_4(0, 0) \leq$, $k = \gamma_0 = 1$",
        drift_bounds.noise_bound(scene, printed=True).constant,
        drift_bounds.noise_bound(scene).constant,
        float(value[0] if np.ndim(value) else value),
        1e-13 * float(np.max(terms)),
        "bound",
    )


def _worst_direction(form, epsilon):
    """Largest quadratic growth of S_4/K over the unit circle, an eigenvalue."""
    return float(scipy.linalg.eigvalsh(epsilon * form.energy - form.decay)[-1])


@_erratum(
    "10b",
    "Claim $S_4$, $K_{4,\\zeta}$, $K_{4,\\eta}$",
    r"coefficient $-K \tilde\delta^2$",
    r"$-K \tilde\delta (\tilde\delta - \epsilon)$, also in the bound of $K$",
)
def claim_coefficient():
    """Compare the bounds of the quadratic part with its largest eigenvalue.

    With epsilon near delta~, which (def-epsilon-CV) allows where U is steep.
    """
    form = assumptions.dissipation(KanaiTajimi(1.0, 0.01))
    small = 0.99 * form.rate
    return Evidence(
        r"$\max_{|z|=1} S_4 / K$, quadratic part, $\gamma_0 = 0.01$",
        -(form.rate**2),
        -form.rate * (form.rate - small),
        _worst_direction(form, small),
        1e-15,
        "bound",
    )


@_erratum(
    "10c",
    "eq. (def-epsilon-CV)",
    r"$\epsilon < \min(\lambda_3/\delta, C_b, r)$",
    r"and $\epsilon < \tilde\delta$ for noise of type 2",
)
def claim_epsilon():
    """Take the largest epsilon that either condition allows; (HV2) needs a negative value."""
    scene = _noisy(0.001)
    c = lyapunov.constants(scene)
    printed = 0.99 * min(c.confinement.lambda_3 / c.delta, scene.damping)
    form = c.dissipation
    return Evidence(
        r"$\max_{|z|=1} S_4 / K$, quadratic part, $\gamma_0 = 0.001$",
        _worst_direction(form, printed),
        _worst_direction(form, min(printed, 0.99 * form.rate)),
        0.0,
        relation="below",
        kind="consistency",
    )


@_erratum(
    "11",
    "Proof of (HV1)",
    r"$\int_0^T p \, dt \geq c_1 e^{-c_2 \sup|\theta_t - z'|^2}$, $c_2 = C_T T$",
    r"$\int_{T/2}^T$, $c_2 = C_T (T/2)^{1-2d}$, $c_1$ times $T/2$",
)
def petite_sets():
    """Take integrated Brownian motion from 0, its density known, at (y, x) = (0, 1), T = 1/2."""
    T, d = 0.5, 2
    covariance = np.array([[1, 1 / 2], [1 / 2, 1 / 3]])
    precision = np.linalg.inv(covariance)
    height = 1 / (2 * np.pi * math.sqrt(np.linalg.det(covariance)))
    # the least C_T for which eq. (boundDelarueMenozzi) holds from below
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
        "below",
    )


@_erratum(
    "12",
    "Sec. 5",
    r"$U \equiv 0$ as an example of the theorems",
    r"violates (HU2); the theorems hold for $Y$ alone, $V_{n,1} = \delta y^2/2 + C_V$",
)
def free_displacement():
    """Evaluate both V_n at (y, x) = (-1, 1e9), where they should be at least 1."""
    c = lyapunov.constants(Scene("friction"))
    point = {y: -1, x: 1e9, equations.U(x): 0, lyapunov.delta: c.delta, lyapunov.C_V: c.C_V}
    values = [float(lyapunov.function("white", confined).subs(point)) for confined in (True, False)]
    quantity = r"$V_n(-1, 10^9) \geq 1$"
    return Evidence(quantity, *values, 1.0, relation="bound", kind="consistency")


@_erratum(
    "13",
    "eq. (equivalent)",
    r"$W_\star(b/\gamma, T)$ for every $g$",
    r"if $\int g m_n = 0$; otherwise the limit is $1$",
)
def centred_observable():
    """Compare limits for g = y + 1 with Chebyshev's bound of P(|Delta| >= sqrt(p) b), p = 1e4."""
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
        relation="bound",
    )


@_erratum(
    "14a",
    r"$A_{n,3}$",
    r"$-v'(\eta)\, \psi_\eta$",
    r"$-v'(\eta)\, \partial_\eta$",
)
def misprinted_derivative():
    """Apply both to a constant, which a generator annihilates; psi_eta = 1 does not."""
    drift = NOISES["langevin"].drift[eta]
    mended = lyapunov.generator(sympy.Integer(1), "langevin")
    printed = mended + drift * 1
    quantity = r"$A_{n,3} 1$ at $\eta = 2$, $\psi_\eta = 1$"
    return Evidence(quantity, float(printed.subs(eta, 2)), float(mended), 0.0, kind="consistency")


@_erratum("14b", "Proof of (HV1), chain", r"for each $2 \leq i \leq n$", r"$2 \leq i \leq d$")
def misprinted_range():
    """Count the equations without noise, for white noise and n = 100."""
    scene = Scene("friction")
    sigma = equations.diffusion(scene.noise)
    reference = float(sum(entry == 0 for entry in sigma))
    return Evidence(
        "number of such $i$, $n = 100$, $d = 2$",
        scene.n - 1,
        float(len(scene.variables) - 1),
        reference,
        kind="consistency",
    )


@_erratum(
    "14c",
    "Claims, $A_{n,4}$, eq. (Lyapunov-functions)",
    r"$H(\zeta, \eta)$, $B_i(\zeta, \eta)$",
    r"$H(\eta, \zeta)$, $B_i(\eta, \zeta)$",
)
def misprinted_order():
    """Differentiate H along the flow without noise and dissipation, which conserves it."""
    H = KanaiTajimi(_STIFFNESS, _DAMPING).energy
    B = hamiltonian_drift(H, sympy.Integer(0))
    swapped = H.subs({eta: zeta, zeta: eta}, simultaneous=True)
    values = [
        float(sum(f * sympy.diff(energy, s) for s, f in B.items()).subs({eta: 1, zeta: 1}))
        for energy in (swapped, H)
    ]
    quantity = r"$dH/dt$ at $(1, 1)$, $F = 0$, $k = 2$"
    return Evidence(quantity, *values, 0.0, kind="symbolic")


@_erratum(
    "14d",
    "Proof of (HV1), chain, 2.",
    r"or $\partial_{z_2} F_2 \leq \ell < 0$",
    r"or $\partial_{z_1} F_2 \leq \ell < 0$",
)
def misprinted_variable():
    """Compute Kalman's rank of dz_1 = dW, dz_2 = F_2 dt, F_2 = -z_2 and -z_1.

    Without full rank there is no density.
    """
    ranks = []
    for row in ([0.0, -1.0], [-1.0, 0.0]):
        A, B = np.array([[0.0, 0.0], row]), np.array([1.0, 0.0])
        ranks.append(float(np.linalg.matrix_rank(np.column_stack([B, A @ B]))))
    quantity = r"rank of $(\sigma, \nabla F\, \sigma)$, $F_2 = -z_2$, $-z_1$"
    return Evidence(quantity, *ranks, 2.0, kind="symbolic")
