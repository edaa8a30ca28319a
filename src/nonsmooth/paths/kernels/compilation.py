"""How the numerical kernels are compiled: no fast-math, no GIL, cached by content.

Numba's own cache notices a change of the file that holds a kernel, not of the files it calls
into. The cache folder is therefore named after the content of the whole package.
"""

import hashlib
from pathlib import Path

import numba

_PACKAGE = Path(__file__).parents[2]  # the whole library
_DIGEST = hashlib.sha256(b"".join(p.read_bytes() for p in sorted(_PACKAGE.rglob("*.py"))))
_CACHE = str(_PACKAGE / "__pycache__" / f"kernels-{_DIGEST.hexdigest()[:16]}")


def kernel(function, forceinline=False):
    """Compile a function to machine code when it is first called."""
    # the folder is read at decoration; other users of numba keep theirs
    elsewhere, numba.config.CACHE_DIR = numba.config.CACHE_DIR, _CACHE
    try:
        return numba.njit(
            function, cache=True, nogil=True, error_model="numpy", forceinline=forceinline
        )
    finally:
        numba.config.CACHE_DIR = elsewhere


def inlined(function):
    """Compile a function into its callers: a loop over lanes vectorises only without calls."""
    return kernel(function, forceinline=True)
