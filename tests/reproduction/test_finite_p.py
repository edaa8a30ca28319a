"""How the errors of formulas at finite p are judged and fitted."""

import numpy as np
import pytest

from reproduction.errors import CheckError
from reproduction.finite_p import ASYMPTOTIC, FORMULAS, check_stated_errors, powers_of_p

P = np.array([10.0, 100.0, 1000.0])
KNOWN = np.ones((len(FORMULAS), len(P)), dtype=bool)


def test_powers_of_p_are_found():
    """Distances p^(-k/2) have the power -k/2, everywhere the same."""
    orders = np.arange(1, len(FORMULAS) + 1)
    slopes, deviations = powers_of_p(P, P ** (-orders[:, None] / 2), KNOWN, 10.0)
    assert np.allclose(slopes, -orders / 2)
    assert np.allclose(deviations, 0, atol=1e-12)


def test_a_power_needs_two_distances():
    """The error says that too few are resolved, or none at a p that is large enough."""
    known = KNOWN.copy()
    known[2, 1:] = False
    with pytest.raises(CheckError, match="'order 2' is resolved at fewer than two"):
        powers_of_p(P, np.ones(KNOWN.shape), known, 10.0)
    with pytest.raises(CheckError, match="p >= 500"):
        powers_of_p(P, np.ones(KNOWN.shape), KNOWN, 500.0)


def test_an_error_above_the_stated_one_is_refused():
    """So it is for the corrected formulas; the plain one states no error."""
    off = np.zeros((*KNOWN.shape, 1))
    off[list(FORMULAS).index(ASYMPTOTIC)] = 1.0
    check_stated_errors(P, off, np.full(off.shape, 0.1))
    off[1, 2] = 0.2
    with pytest.raises(CheckError, match="'order 1' is larger than it states at p = 1000"):
        check_stated_errors(P, off, np.full(off.shape, 0.1))
