"""How the numerical kernels are compiled.

Floating-point operations are not reordered (no fast-math), so that results do not depend on how the
compiler vectorises a loop. Kernels release Python's global lock (GIL), so that threads run at the
same time. Machine code is cached on disk. Numba's own cache notices a change of the file that holds
a kernel, but not of the files that the kernel calls into. The cache folder is therefore named after
the content of the whole library.
"""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba

_PACKAGE = Path(__file__).parents[2]  # the whole library
_DIGEST = hashlib.sha256(b"".join(p.read_bytes() for p in sorted(_PACKAGE.rglob("*.py"))))
_CACHE = str(_PACKAGE / "__pycache__" / f"kernels-{_DIGEST.hexdigest()[:16]}")


def kernel(function: Callable, forceinline: bool = False) -> Callable:
    """Compile a function to machine code when it is first called."""
    # Numba reads the name of the cache folder when a function is decorated. It is restored for
    # other users of numba.
    config: Any = numba.config
    elsewhere, config.CACHE_DIR = config.CACHE_DIR, _CACHE
    try:
        return numba.njit(
            function, cache=True, nogil=True, error_model="numpy", forceinline=forceinline
        )
    finally:
        config.CACHE_DIR = elsewhere


def inlined(function: Callable) -> Callable:
    """Compile a function into its callers: a loop is only vectorised if there is no call in it."""
    return kernel(function, forceinline=True)
