"""Sylvester's equation against LAPACK and against its definition."""

import numpy as np
import pytest
import scipy.linalg

from nonsmooth.linear_algebra.sylvester import sylvester


@pytest.mark.parametrize(("m", "n"), [(1, 1), (5, 200), (200, 5), (150, 131), (300, 300)])
def test_residual_and_reference(m, n):
    """The residual is rounding, pairs of complex eigenvalues included; LAPACK has the same X.

    Both are backward stable: X is off by the separation's inverse, here about 1/2, times rounding.
    """
    rng = np.random.default_rng(3)
    A = rng.standard_normal((m, m)) / np.sqrt(m) + 2 * np.eye(m)
    B = rng.standard_normal((n, n)) / np.sqrt(n) + 2 * np.eye(n)
    C = rng.standard_normal((m, n))
    found = sylvester(A, B, C)
    rounding = 1e3 * np.finfo(float).eps * np.sqrt(m * n)
    assert np.linalg.norm(A @ found + found @ B - C) <= rounding * np.linalg.norm(C)
    reference = scipy.linalg.solve_sylvester(A, B, C)
    assert np.linalg.norm(found - reference) <= rounding * np.linalg.norm(reference)
