"""Every solver on grids keeps the contract `PoissonSolver`, that of the manual's page as well."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg

import nonsmooth as ns
from nonsmooth.errors import ToleranceError
from nonsmooth.grids.alternating_solver import AlternatingSolver
from nonsmooth.grids.direct_solver import DirectSolver, SparseFactors
from nonsmooth.grids.generator import assemble, evaluate
from nonsmooth.grids.mesh.axes import axes as axes_of
from nonsmooth.grids.mesh.axes import variables
from nonsmooth.grids.mesh.box import half_widths
from nonsmooth.grids.solver import EVEN, ODD
from nonsmooth.scenes.symbols import y

PAGE = Path(__file__).parents[3] / "docs" / "how_to" / "add_a_grid_solver.md"
PLASTIC = ns.Scene("elasto_plastic", n=5, potential="x**2/2")
COLORED = ns.Scene("elasto_plastic", "langevin", n=5, potential="x**2/2")
ACCURACY = 1e-9


def of_the_page(scene, axes):
    """Make the solver that the manual shows."""
    names = {}
    exec(PAGE.read_text().split("```python\n")[1].split("```")[0], names)
    return names["IterativeSolver"](scene, axes)


MAKERS = {
    "direct": (PLASTIC, lambda scene, axes: DirectSolver(scene, axes, False)),
    "direct, mirrored": (PLASTIC, lambda scene, axes: DirectSolver(scene, axes, True)),
    "alternating": (COLORED, lambda scene, axes: AlternatingSolver(scene, axes, False, 8.0)),
    "alternating, mirrored": (COLORED, lambda scene, axes: AlternatingSolver(scene, axes, True, 8)),
    "of the page": (PLASTIC, of_the_page),
}


@pytest.fixture(scope="module", params=MAKERS)
def made(request):
    """Make a solver on a coarse grid, its axes and the generator on the whole grid."""
    scene, make = MAKERS[request.param]
    axes = axes_of(scene, half_widths(scene, 8.0), dict.fromkeys(variables(scene), 0))
    return make(scene, axes), axes, assemble(scene, axes)


def test_folding_is_undone(made):
    """Unfold is the inverse of fold, on functions of either parity."""
    solver, axes, _ = made
    for f, parity in ((y**3, ODD), (y**2, EVEN)):
        whole = evaluate(f, axes)
        assert np.allclose(solver.unfold(solver.fold(whole), parity), whole, rtol=1e-12)


def test_solutions_solve_the_equation(made):
    """-A u = f - E f on the whole grid, where the invariant measure has mass."""
    solver, axes, A = made
    masses = np.abs(solver.stationary(ACCURACY))
    for f, parity in ((y, ODD), (y**2, EVEN)):
        whole = evaluate(f, axes)
        u, mean = solver.solve(solver.fold(whole), parity, ACCURACY)
        residual = -A @ solver.unfold(u, parity) - (whole - mean)
        assert np.sqrt(masses @ residual**2) < 1e-6 * np.sqrt(masses @ whole**2)


def test_solvers_go_on_from_a_solution(made):
    """From one that is near, an iteration is not longer and ends at the same one."""
    solver, axes, _ = made
    masses = np.abs(solver.stationary(ACCURACY))
    for f, parity in ((y, ODD), (y**2, EVEN)):
        values = solver.fold(evaluate(f, axes))
        near, _ = solver.solve(values, parity, 1e-4)
        wanted, mean = solver.solve(values, parity, ACCURACY)
        steps = getattr(solver, "iterations", 0)
        found, same = solver.solve(values, parity, ACCURACY, near)
        assert getattr(solver, "iterations", 0) <= steps
        solver.solve(values, parity, ACCURACY, wanted)
        # what has been solved is solved, up to rounding
        assert getattr(solver, "iterations", 0) <= 1
        change = solver.unfold(found - wanted, parity)
        assert np.sqrt(masses @ (change - masses @ change) ** 2) < 1e-6
        assert same == pytest.approx(mean, abs=1e-6)


def test_means_are_those_of_the_invariant_measure(made):
    """M' A = 0, m of sum 1, and E f = m' f; the mean of an odd function is 0."""
    solver, axes, A = made
    masses = solver.stationary(ACCURACY)
    assert masses.sum() == pytest.approx(1, abs=1e-12)
    test = evaluate(y**2, axes)
    assert abs(masses @ (A @ test)) < 1e-6 * np.max(np.abs(A @ test))
    _, mean = solver.solve(solver.fold(test), EVEN, ACCURACY)
    assert mean == pytest.approx(masses @ test, rel=1e-6)
    _, mean = solver.solve(solver.fold(evaluate(y, axes)), ODD, ACCURACY)
    assert mean == pytest.approx(0, abs=1e-6)


def test_a_lack_of_memory_is_told_in_one_line(monkeypatch):
    """The factorisation names its size and the cure."""

    def full(*arguments, **options):
        raise MemoryError

    monkeypatch.setattr(scipy.sparse.linalg, "splu", full)
    with pytest.raises(ToleranceError, match="does not hold the factors of 3 equations"):
        SparseFactors(scipy.sparse.eye_array(3))


def test_factors_are_freed():
    """Factors made one after the other take the memory of a few, wherever they are dropped."""
    import psutil

    size = 100
    line = scipy.sparse.diags_array([-1.0, 2.1, -1.0], offsets=[-1, 0, 1], shape=(size, size))
    plane = scipy.sparse.kronsum(line, line)
    taken = []
    for _ in range(20):
        factors = SparseFactors(plane)
        factors.solve(np.ones(size**2))
        taken.append(psutil.Process().memory_info().rss)
    one = 12 * scipy.sparse.linalg.splu(plane.tocsc()).nnz  # a number and its row
    assert taken[-1] - taken[4] < 5 * one


def test_programs_that_keep_factors_end_well():
    """What is printed reaches a pipe, and the exit code is 0, also with factors still alive."""
    program = (
        "import numpy as np, scipy.sparse as sp\n"
        "from nonsmooth.grids.direct_solver import SparseFactors\n"
        "factors = SparseFactors(sp.eye_array(3) * 2.0)\n"
        "print(factors.solve(np.ones(3)))"
    )
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (ended.stdout, ended.stderr, ended.returncode) == ("[0.5 0.5 0.5]\n", "", 0)
