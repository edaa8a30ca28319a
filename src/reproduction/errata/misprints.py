r"""Errata that are wrong symbols."""

import numpy as np
import sympy

from nonsmooth.scenes import equations
from nonsmooth.scenes.noises import KanaiTajimi, hamiltonian_drift, named
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import eta, zeta
from nonsmooth.theory import lyapunov
from reproduction.errata.record import Evidence, erratum


@erratum(
    "14a",
    r"$A_{n,3}$, before eq. \ref{expansion-V3}",
    r"$-v'(\eta)\, \psi_\eta$",
    r"$-v'(\eta)\, \partial_\eta$",
)
def misprinted_derivative():
    """Apply both to the constant 1, which a generator maps to 0, with psi_eta = 1."""
    drift = named("langevin").drift[eta]
    mended = lyapunov.generator(sympy.Integer(1), "langevin")
    printed = mended + drift * 1
    quantity = r"$A_{n,3} 1$ at $\eta = 2$, $\psi_\eta = 1$"
    return Evidence(quantity, float(printed.subs(eta, 2)), float(mended), 0.0, kind="consistency")


@erratum(
    "14b",
    r"Proof of (HV1), eq. \ref{eq:dynamics-DM10}",
    r"for each $2 \leq i \leq n$",
    r"$2 \leq i \leq d$",
)
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


@erratum(
    "14c",
    r"Eq. \ref{Lyapunov-functions}, $A_{n,4}$, Claim 10",
    r"$H(\zeta, \eta)$, $B_i(\zeta, \eta)$",
    r"$H(\eta, \zeta)$, $B_i(\eta, \zeta)$",
)
def misprinted_order():
    """Differentiate H along the flow without noise and dissipation, which conserves H."""
    H = KanaiTajimi(2.0, 0.6).energy
    B = hamiltonian_drift(H, sympy.Integer(0))
    swapped = H.subs({eta: zeta, zeta: eta}, simultaneous=True)
    values = [
        float(sum(f * sympy.diff(energy, s) for s, f in B.items()).subs({eta: 1, zeta: 1}))
        for energy in (swapped, H)
    ]
    quantity = r"$dH/dt$ at $(1, 1)$, $F = 0$, $k = 2$"
    return Evidence(quantity, *values, 0.0, kind="symbolic")


@erratum(
    "14d",
    r"Proof of (HV1), eq. \ref{eq:dynamics-DM10}, condition 2",
    r"or $\partial_{z_2} F_2 \leq \ell < 0$",
    r"or $\partial_{z_1} F_2 \leq \ell < 0$",
)
def misprinted_variable():
    """Compute Kalman's rank of dz_1 = dW, dz_2 = F_2 dt for F_2 = -z_2 and F_2 = -z_1.

    Without full rank there is no density.
    """
    ranks = []
    for row in ([0.0, -1.0], [-1.0, 0.0]):
        A, B = np.array([[0.0, 0.0], row]), np.array([1.0, 0.0])
        ranks.append(float(np.linalg.matrix_rank(np.column_stack([B, A @ B]))))
    quantity = r"rank of $(\sigma, \nabla F\, \sigma)$, $F_2 = -z_2$, $-z_1$"
    return Evidence(quantity, *ranks, 2.0, kind="symbolic")
