"""v(0, T)/T of dry friction (C_b = 1) by scikit-fem and by py-pde, as their manuals show."""

import functools

import numpy as np
import scipy
from serve import serve

REACH = 6.0


def scikit_fem(n, horizon, elements, steps):
    """Quadratic elements in L^2(m), graded to the knots, and Crank-Nicolson."""
    import skfem
    from skfem.helpers import dot, grad

    def density(y):
        size = np.abs(y)
        friction = np.where(size < 1 / n, n * y**2 / 2, size - 1 / (2 * n))
        return np.exp(-(y**2) - 2 * friction)

    def run(seed):
        inside = np.linspace(0, 1 / n, elements // 4 + 1)
        outside = 1 / n + np.geomspace(1 / (n * elements), REACH, elements - elements // 4)
        half = np.concatenate([inside, outside])
        mesh = skfem.MeshLine(np.concatenate([-half[:0:-1], half]))
        basis = skfem.Basis(mesh, skfem.ElementLineP2(), intorder=6)
        mass = skfem.BilinearForm(lambda u, v, w: density(w.x[0]) * u * v).assemble(basis)
        stiffness = skfem.BilinearForm(
            lambda u, v, w: density(w.x[0]) * dot(grad(u), grad(v)) / 2
        ).assemble(basis)
        load = skfem.LinearForm(lambda v, w: density(w.x[0]) * w.x[0] * v).assemble(basis)
        square = skfem.LinearForm(
            lambda v, w: density(w.x[0]) * dot(grad(w["w"]), grad(w["w"])) * v
        )
        h = horizon / steps
        solve = scipy.sparse.linalg.factorized((mass + h / 2 * stiffness).tocsc())
        forward = (mass - h / 2 * stiffness).tocsr()
        w, v, source = np.zeros((3, basis.N))
        for _ in range(steps):
            w = solve(forward @ w + h * load)
            last, source = source, square.assemble(basis, w=basis.interpolate(w))
            v = solve(forward @ v + h / 2 * (last + source))
        return v[np.argmin(np.abs(basis.doflocs[0]))] / horizon

    return run


def py_pde(n, horizon, cells):
    """Differences on a uniform grid and explicit steps as long as is stable."""
    import pde

    grid = pde.CartesianGrid([[-REACH, REACH]], cells)
    y = grid.axes_coords[0]
    drift = pde.ScalarField(grid, y + np.clip(n * y, -1, 1))
    equations = pde.PDE(
        {
            "w": "0.5 * laplace(w) - drift * d_dx(w) + x",
            "v": "0.5 * laplace(v) - drift * d_dx(v) + d_dx(w)**2",
        },
        bc={"derivative": 0},
        consts={"drift": drift},
    )
    step = 0.9 * (2 * REACH / cells) ** 2

    @functools.lru_cache(maxsize=1)
    def compiled():
        solver = pde.EulerSolver(equations)
        start = pde.FieldCollection([pde.ScalarField(grid), pde.ScalarField(grid)])
        return start, solver.make_stepper(start, dt=step)

    def run(seed):
        start, advance = compiled()
        state = start.copy()
        advance(state, 0, horizon)
        return state[1].interpolate([0.0]) / horizon

    return run


if __name__ == "__main__":
    serve({"scikit-fem": scikit_fem, "py-pde": py_pde})
