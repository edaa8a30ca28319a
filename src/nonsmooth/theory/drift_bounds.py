"""The bounds that the proof of Lemma 2 of the paper gives for V_n and its drift, to be tested.

Claims 7 to 10 bound the terms S_1 to S_4 of A_n V_n + epsilon V_n. The boxed bounds, eqs. (25),
(28) and (31) of the paper, follow from them. The lower bound of V_n is the first step of the proof
of (HV1).
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import sympy

from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta, x, y, zeta
from nonsmooth.theory import lyapunov

Points = Mapping[sympy.Symbol, np.ndarray]
Pair = tuple[np.ndarray, np.ndarray]  # a sum of terms, and the sum of their absolute values


@dataclass(frozen=True)
class Bound:
    """A boxed bound: constant - sum_i quadratic_i z_i^2 + sum_i linear_i |z_i|.

    Attributes
    ----------
    constant : float
        K_d.
    quadratic, linear : dict
        Symbol -> coefficient.
    """

    constant: float
    quadratic: dict
    linear: dict

    @property
    def supremum(self) -> float:
        """The constant C of (HV2) that follows from it."""
        return self.constant + sum(
            slope**2 / (4 * self.quadratic[s]) for s, slope in self.linear.items()
        )

    def evaluate(self, z: Points) -> Pair:
        """Return the bound and the sum of the absolute values of its terms at points."""
        terms: list = [self.constant]
        terms += [-coefficient * z[s] ** 2 for s, coefficient in self.quadratic.items()]
        terms += [coefficient * np.abs(z[s]) for s, coefficient in self.linear.items()]
        return lyapunov.summed(terms)


def bound(scene: Scene) -> Bound:
    """Return the right-hand side of eq. (25), (28) or (31) of the paper, with Claim 10 mended.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Bound
    """
    c = lyapunov.constants(scene)
    trap = c.confinement
    constant, quadratic, linear = c.C_V, {y: scene.damping * c.delta / 4}, {y: c.delta}
    if trap:
        constant += trap.beta_3 + (c.delta * trap.beta_4 * scene.n) ** 2 / trap.lambda_3
        quadratic[x], linear[x] = 3 * trap.lambda_3 / 8, 1.0
    if scene.noise.kind == "white":
        return Bound(constant + c.delta / 2, quadratic, linear)
    own = noise_bound(scene)
    quadratic = {s: coefficient / 2 for s, coefficient in quadratic.items()}
    # the forcing eta (delta y + x) costs half of what the noise's own bound has in eta
    quadratic |= {s: c / 2 if s == eta else c for s, c in own.quadratic.items()}
    return Bound(constant + own.constant, quadratic, linear)


def noise_bound(scene: Scene, printed: bool = False) -> Bound:
    """Return the right-hand side of eq. (27) of the paper, or of (30), mended unless `printed`.

    (T120) gives L Gamma_2 + epsilon Gamma_2 <= K M (1 + delta~) - (delta~ - epsilon) Gamma_2,
    and (T117) Gamma_2 >= K delta~ (eta^2 + zeta^2).

    Parameters
    ----------
    scene : Scene
        With colored noise.
    printed : bool

    Returns
    -------
    Bound
    """
    c = lyapunov.constants(scene)
    weight, rate = c.noise_weight, c.restoring
    if scene.noise.kind == "langevin":
        return Bound(weight / 2, {eta: weight * rate / 2}, {})
    assert c.dissipation is not None  # the noise is of type 2
    M = c.dissipation.M
    constant, slope = weight * M * (1 + rate), weight * rate * (rate - c.epsilon)
    if printed:
        constant, slope = M * (1 + weight * rate), weight * rate**2
    return Bound(constant, {eta: slope, zeta: slope}, {})


def mechanical_claims(scene: Scene, z: Points) -> list[tuple[Pair, Pair]]:
    """S_1(x) and S_2(y, x) at the points z, and the bounds (20) and (24) of them.

    The bound (24) grows with x and y, so that its coefficients are negative here.

    Parameters
    ----------
    scene : Scene
        With a confined displacement.
    z : dict
        Symbol -> array.

    Returns
    -------
    list of (value, bound)
        Each a pair (sum of terms, sum of their absolute values).
    """
    c, b = lyapunov.constants(scene), scene.damping
    trap, own = c.confinement, lyapunov.functions(scene)[0]
    assert trap is not None  # the displacement is confined
    U, slope, f_x, f_y, _ = (of(z[s]) if s in z else 0.0 for of, s in own)
    flat = 3 * trap.lambda_3 / 4
    first = lyapunov.summed([c.delta * c.epsilon * U, -slope * z[x], -c.delta * slope * f_x])
    second = lyapunov.summed(
        [-z[y] * z[x] * (b - c.epsilon), -z[y] * f_x, -f_y * c.delta * z[y], -f_y * z[x]]
    )
    Gamma = trap.beta_3 + (c.delta * trap.beta_4 * scene.n) ** 2 / trap.lambda_3
    bounds = (
        Bound(Gamma, {x: flat}, {}),
        Bound(0.0, {y: -((b + scene.n) ** 2) / (2 * flat), x: -flat / 2}, {y: c.delta, x: 1.0}),
    )
    return [
        (value, bound.evaluate(z)) for value, bound in zip((first, second), bounds, strict=True)
    ]


def noise_drift(scene: Scene, z: Points) -> Pair:
    """S_3(eta) or S_4(zeta, eta) at the points z, and the sum of their terms' absolute values."""
    c = lyapunov.constants(scene)
    weight, small = c.noise_weight, c.epsilon
    if scene.noise.kind == "langevin":
        slope = vectorised(sympy.diff(scene.noise.potential_expression, eta), (eta,))(z[eta])
        return lyapunov.summed(
            [weight / 2, -weight * slope * z[eta], small * weight * z[eta] ** 2 / 2]
        )
    form = c.dissipation
    assert form is not None  # the noise is of type 2
    energy = small * form.energy - form.decay
    return lyapunov.summed(
        [
            weight * (0.5 + small * form.M),
            weight * energy[0, 0] * z[eta] ** 2,
            weight * 2 * energy[0, 1] * z[eta] * z[zeta],
            weight * energy[1, 1] * z[zeta] ** 2,
        ]
    )


def lower_bound(scene: Scene) -> Bound:
    """Return the first step of the proof of (HV1) as a bound of -V_n.

    It is V_{n,2} >= y^2/2 (delta - 1/(delta lambda_1)) + delta lambda_1 x^2/2 + 1. (T117) bounds
    what the noise adds.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Bound
        Of -V_n; all its quadratic coefficients are positive.
    """
    c = lyapunov.constants(scene)
    trap = c.confinement
    if trap:
        quadratic = {
            y: (c.delta - 1 / (c.delta * trap.lambda_1)) / 2,
            x: c.delta * trap.lambda_1 / 2,
        }
    else:
        quadratic = {y: c.delta / 2}
    if scene.noise.kind == "langevin":
        quadratic[eta] = c.noise_weight / 2
    elif scene.noise.kind == "hamiltonian":
        quadratic |= dict.fromkeys((eta, zeta), c.noise_weight * c.restoring)
    return Bound(-1.0, quadratic, {})
