"""gamma^2 by methods that are exact and slow, and random scenes to try them on.

`benchmarks/honesty.py` uses them, too.
"""

from itertools import pairwise

import numpy as np
import scipy.linalg
import sympy
from mpmath import mp
from scipy.integrate import cumulative_simpson, quad, simpson

import nonsmooth as ns
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.noises import White
from nonsmooth.scenes.symbols import STATE_VARIABLES, eta, x, y


class Reference:
    """gamma^2 of piecewise g = sum of y^k exp(kappa y), the inner integral in closed form.

    Parameters
    ----------
    scene : Scene
        Dry friction.
    g : callable
        Takes a point inside a piece, returns {(k, kappa): coefficient} there.
    kinks : iterable of float
        Where g may change.
    """

    def __init__(self, scene, g, kinks=()):
        sigma2, self.damping = mp.mpf(scene.noise.sigma) ** 2, mp.mpf(scene.damping)
        self.n, self.rate = scene.n, 2 / sigma2
        self.knot = mp.mpf(0) if np.isinf(scene.n) else 1 / mp.mpf(scene.n)
        self.end = mp.sqrt(500 / (self.rate * self.damping))
        while self.depth(self.end) > 250:  # beyond there is nothing, even of exp(kappa y)
            self.end *= 0.95
        edges = {0, self.knot, -self.knot, self.end, -self.end, *map(mp.mpf, kinks)}
        self.edges = sorted(e for e in edges if abs(e) <= self.end)
        self.pieces = list(pairwise(self.edges))
        self.total = mp.fsum(self.integral({(0, 0.0): 1}, a, b) for a, b in self.pieces)
        terms = [g((a + b) / 2) for a, b in self.pieces]
        whole = [self.integral(t, a, b) for t, (a, b) in zip(terms, self.pieces, strict=True)]
        self.mean = mp.fsum(whole) / self.total
        self.terms = [t | {(0, 0.0): t.get((0, 0.0), 0) - self.mean} for t in terms]
        whole = [self.integral(t, a, b) for t, (a, b) in zip(self.terms, self.pieces, strict=True)]
        self.beyond = [mp.fsum(whole[i + 1 :]) for i in range(len(whole))]

    def coefficients(self, y):
        """Depth alpha y^2 + beta y + gamma around y."""
        if abs(y) < self.knot:
            return self.rate * (self.damping + mp.mpf(self.n)) / 2, mp.mpf(0), mp.mpf(0)
        return self.rate * self.damping / 2, self.rate * mp.sign(y), -self.rate * self.knot / 2

    def depth(self, y):
        """-log m, but for a constant."""
        alpha, beta, gamma = self.coefficients(y)
        return alpha * y**2 + beta * y + gamma

    def integral(self, terms, a, b):
        """Integral of sum of c y^k exp(kappa y - depth) by the recurrence of its moments."""
        value = mp.mpf(0)
        alpha, beta, gamma = self.coefficients((a + b) / 2)
        for kappa in {kappa for _, kappa in terms}:
            slope = beta - mp.mpf(kappa)
            root, middle = mp.sqrt(alpha), slope / (2 * alpha)
            ends = [mp.exp(-alpha * y**2 - slope * y - gamma) for y in (a, b)]
            scale = mp.exp(alpha * middle**2 - gamma) * mp.sqrt(mp.pi) / (2 * root)
            below, above = root * (a + middle), root * (b + middle)
            if above < 0:  # from the smaller ends of erfc
                below, above = -above, -below
            moments = [scale * (mp.erfc(below) - mp.erfc(above))]
            for k in range(1, max(k for k, _ in terms) + 1):
                jump = b ** (k - 1) * ends[1] - a ** (k - 1) * ends[0]
                before = (k - 1) * moments[k - 2] if k > 1 else 0
                moments.append((before - slope * moments[k - 1] - jump) / (2 * alpha))
            value += mp.fsum(c * moments[k] for (k, own), c in terms.items() if own == kappa)
        return value

    def integrand(self, i, y):
        """u'^2 m sigma^2 in piece i."""
        flux = self.integral(self.terms[i], y, self.pieces[i][1]) + self.beyond[i]
        return 2 * self.rate * flux**2 * mp.exp(self.depth(y)) / self.total

    def variance(self):
        """gamma^2 down to the depth 60, the outer integral by mpmath to 20 digits."""

        def integrand(i, y):
            with mp.workdps(60):
                return self.integrand(i, y)

        intervals = [self.divided(a, b, 60, 12) for a, b in self.pieces]
        with mp.workdps(20):
            return mp.fsum(
                mp.quad(lambda y, i=i: integrand(i, y), points)
                for i, points in enumerate(intervals)
                if len(points) > 1
            )

    def divided(self, a, b, deepest, step):
        """Points of [a, b] between which the depth changes by `step` at most, up to `deepest`."""
        points = [a]
        while points[-1] < b:
            width = b - points[-1]
            while abs(self.depth(points[-1] + width) - self.depth(points[-1])) > step:
                width /= 2
            points.append(points[-1] + width)
        return [p for p in points if self.depth(p) <= deepest]


def random_velocity(rng):
    """Dry friction anywhere in the range of parameters; g with a kink, a jump, an exponential."""
    n = np.inf if rng.random() < 0.15 else 10 ** rng.uniform(0, 6)
    damping, sigma = 10 ** rng.uniform(-3, 3), 10 ** rng.uniform(-1, 1)
    length = min(sigma / np.sqrt(2 * damping), max(sigma**2 / 2, sigma / np.sqrt(2 * n)))
    kink, jump = (rng.normal(size=2) * length).tolist()
    a, b, c, d, e, f = rng.normal(size=6) * (rng.random(6) < 0.6)
    a, c, d, e = (a or 1.0) / length, c / length, d / length**2, e / length**3
    # the density falls like exp(-|y| / length) at least
    kappa = rng.choice([-1, 1]) * rng.uniform(0.02, 0.1) / length
    a, b, c, d, e, f, kappa = map(float, (a, b, c, d, e, f, kappa))
    text = (
        f"{a!r}*abs(y - {kink!r}) + {b!r}*sign(y - {jump!r}) + {c!r}*y + {d!r}*y**2"
        f" + {e!r}*y**3 + {f!r}*exp({kappa!r}*y)"
    )

    def g(y):
        side, other = mp.sign(y - kink), mp.sign(y - jump)
        terms = {
            (0, 0.0): -side * mp.mpf(a) * mp.mpf(kink) + other * mp.mpf(b),
            (1, 0.0): side * mp.mpf(a) + mp.mpf(c),
            (2, 0.0): mp.mpf(d),
            (3, 0.0): mp.mpf(e),
            (0, kappa): mp.mpf(f),
        }
        return {power: c for power, c in terms.items() if c}

    scene = ns.Scene("friction", White(sigma), n=n, damping=damping, observable=text)
    return scene, g, (kink, jump)


def linear_reference(scene, square):
    """gamma^2 of g = x or g = x^2 of a linear scene, from its covariance.

    The penalty of the scenes below is too weak to matter: its force is n (|x| - 1).
    """
    symbols = [s for s in STATE_VARIABLES if s.name in scene.state]
    linear = {s: scene.noise.drift.get(s) for s in symbols if s in scene.noise.drift}
    linear |= {
        y: scene.noise.forcing - sympy.diff(scene.potential_expression, x) - scene.damping * y,
        x: y,
    }
    drift = np.array(sympy.Matrix([linear[s] for s in symbols]).jacobian(symbols), dtype=float)
    kick = np.diag([scene.noise.sigma * (s == scene.noise.driven) for s in symbols])
    covariance = scipy.linalg.solve_continuous_lyapunov(drift, -kick @ kick)
    place = symbols.index(x)
    if not square:
        return -2 * np.linalg.solve(drift, covariance)[place, place]
    slowest = -np.linalg.eigvals(drift).real.max()

    def squared(t):
        return (scipy.linalg.expm(t * drift) @ covariance)[place, place] ** 2

    return 4 * quad(squared, 0, 20 / slowest, epsrel=1e-10, limit=400)[0]


def random_linear(generator_, noise):
    """Draw a linear scene: an obstacle too soft to be felt."""
    draw = generator_.uniform
    noises = {
        "white": ns.White(sigma=draw(0.5, 2)),
        "langevin": ns.OrnsteinUhlenbeck(draw(0.5, 2), draw(0.5, 2)),
        "hamiltonian": ns.KanaiTajimi(draw(0.5, 2), draw(0.5, 2), draw(0.5, 2)),
    }
    return {
        "model": "obstacle",
        "noise": noises[noise],
        "n": 1e-9,
        "damping": draw(0.3, 3),
        "potential": f"{draw(0.5, 2):.3f}*x**2/2",
    }


def langevin_gamma2(noise):
    """gamma^2 of g = eta under a noise of type 1, sigma^2 int u'^2 m by Simpson's rule.

    Returns
    -------
    value, error : float
        The error is the difference to a grid twice as coarse; the rule is of fourth order.
    """
    v = vectorised(noise.potential_expression, (eta,))
    rate = 2 / noise.sigma**2
    end = 1.0
    while rate * (min(v(end), v(-end)) - np.min(v(np.linspace(-end, end, 2001)))) < 60:
        end *= 1.1

    def integral(points):
        place = np.linspace(-end, end, points)
        depth = rate * v(place)
        mass = np.exp(depth.min() - depth)
        mass /= simpson(mass, x=place)
        source = (place - simpson(place * mass, x=place)) * mass
        left = cumulative_simpson(source, x=place, initial=0)
        flux = np.where(place < 0, left, left - left[-1])
        return noise.sigma**2 * simpson((rate * flux) ** 2 / mass, x=place)

    value = integral(80_001)
    return value, abs(value - integral(40_001))
