"""v(0, T)/T of dry friction (C_b = 1) by differences on a fitted grid, in two ways of marching.

The grid has nodes at 0 and +-1/n and is graded to them. With the fluxes of the self-adjoint form
A u = (m u')'/(2 m), evaluated between the nodes, it is of second order for every n. Needs scipy.
"""

import numpy as np
import scipy
from serve import serve

REACH = 6.0  # the density there is exp(-48) of its maximum
STRETCH = 0.4  # suits n = 2 to 1e4


def fitted_grid(n, cells):
    """Nodes, on each side `cells` of them; their density is 1 + STRETCH / (|y| + 1/n)."""

    def count(y):
        return y + STRETCH * np.log1p(n * y)

    inner = max(2, round(cells * count(1 / n) / count(REACH)))
    wanted = np.concatenate(
        [
            np.linspace(0, count(1 / n), inner + 1),
            np.linspace(count(1 / n), count(REACH), cells - inner + 1)[1:],
        ]
    )
    trial = np.concatenate([[0.0], np.geomspace(1e-3 / n, REACH, 10_000)])
    half = np.interp(wanted, count(trial), trial)
    for _ in range(2):  # Newton's method
        half -= (count(half) - wanted) / (1 + STRETCH / (half + 1 / n))
    half[[0, inner]] = 0.0, 1 / n
    return np.concatenate([-half[:0:-1], half])


def generator(n, cells):
    """Diagonals of A, and what maps the slopes on the cells to the mean of their squares."""
    y = fitted_grid(n, cells)
    width = np.diff(y)

    def density(y):
        size = np.abs(y)
        friction = np.where(size < 1 / n, n * y**2 / 2, size - 1 / (2 * n))
        return np.exp(-(y**2) - 2 * friction)

    between = density((y[1:] + y[:-1]) / 2)
    mass = np.zeros(len(y))
    # of the two halves of every cell, by the midpoint rule
    left, right = (density(y[:-1] + share * width) * width / 2 for share in (0.25, 0.75))
    mass[:-1] += left
    mass[1:] += right
    flux = between / width / 2
    lower, upper = flux / mass[1:], flux / mass[:-1]
    main = np.zeros(len(y))
    main[:-1] -= upper
    main[1:] -= lower
    share = between * width / 2
    return y, lower, main, upper, share / mass[:-1], share / mass[1:]


def square_slope(w, y, to_left, to_right):
    """(w')^2 at the nodes."""
    square = (np.diff(w) / np.diff(y)) ** 2
    result = np.zeros(len(w))
    result[:-1] += to_left * square
    result[1:] += to_right * square
    return result


def crank_nicolson(n, horizon, cells, steps):
    """Tridiagonal solves with a constant step."""
    h = horizon / steps

    def run(seed):
        y, lower, main, upper, *shares = generator(n, cells)
        *factors, info = scipy.linalg.lapack.dgttrf(
            -h / 2 * lower, 1 - h / 2 * main, -h / 2 * upper
        )
        assert info == 0

        def forward(u):
            result = (1 + h / 2 * main) * u
            result[1:] += h / 2 * lower * u[:-1]
            result[:-1] += h / 2 * upper * u[1:]
            return result

        w, v, source = np.zeros((3, len(y)))
        for _ in range(steps):
            w = scipy.linalg.lapack.dgttrs(*factors, forward(w) + h * y)[0]
            last, source = source, square_slope(w, y, *shares)
            right = forward(v) + h / 2 * (last + source)
            v = scipy.linalg.lapack.dgttrs(*factors, right)[0]
        return v[len(y) // 2] / horizon

    return run


def method_of_lines(n, horizon, cells, rtol):
    """Solve with scipy's BDF, whose steps grow as the transient decays."""

    def run(seed):
        y, lower, main, upper, *shares = generator(n, cells)
        size = len(y)
        a = scipy.sparse.diags([lower, main, upper], [-1, 0, 1], format="csc")
        spread = scipy.sparse.diags(
            [shares[1], shares[0]], [-1, 0], shape=(size, size - 1), format="csc"
        )
        slope = scipy.sparse.diags(
            [-1 / np.diff(y), 1 / np.diff(y)], [0, 1], shape=(size - 1, size), format="csc"
        )

        def rate(t, z):
            w, v = z[:size], z[size:]
            return np.concatenate([a @ w + y, a @ v + spread @ (slope @ w) ** 2])

        def jacobian(t, z):
            bent = spread @ scipy.sparse.diags(2 * (slope @ z[:size])) @ slope
            return scipy.sparse.bmat([[a, None], [bent, a]], format="csc")

        found = scipy.integrate.solve_ivp(
            rate,
            (0, horizon),
            np.zeros(2 * size),
            method="BDF",
            t_eval=[horizon],
            rtol=rtol,
            atol=1e-3 * rtol,
            jac=jacobian,
        )
        return found.y[size + size // 2, -1] / horizon

    return run


if __name__ == "__main__":
    serve({"crank_nicolson": crank_nicolson, "method_of_lines": method_of_lines})
