"""Sparse factors: programs end well that still hold some, and forked processes make their own."""

import subprocess
import sys

import pytest

PROGRAMS = {
    "factors that are still held": """
import numpy as np
import scipy.sparse as sp
from nonsmooth.grids.direct_solver import SparseFactors
factors = SparseFactors(2 * sp.eye_array(50, format="csr"))
print(factors.solve(np.ones(50))[0])
""",
    "a public function": """
import nonsmooth as ns
scene = ns.Scene("obstacle", observable="x")
print(ns.asymptotic_variance(scene, tol=0.1, method="deterministic").value > 0)
""",
    "a forked process": """
import multiprocessing
import numpy as np
import scipy.sparse as sp
from nonsmooth.grids.direct_solver import SparseFactors

def solved(size):
    return SparseFactors(sp.eye_array(size, format="csr")).solve(np.ones(size))[0]

print(solved(50))
with multiprocessing.get_context("fork").Pool(1) as pool:
    print(pool.map_async(solved, [50]).get(60))
""",
}


@pytest.mark.parametrize("program", PROGRAMS.values(), ids=PROGRAMS.keys())
def test_a_program_with_sparse_factors_ends_well(program):
    """Its exit code is 0 and nothing is on its standard error."""
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=120
    )
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    assert run.stdout
