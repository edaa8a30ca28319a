"""How the numerical kernels are compiled: no fast-math, no GIL, cached by content.

Numba's own cache notices a change of the file that holds a kernel, not of the files it calls
into. The cache folder is therefore named after the content of the whole package.
"""

import hashlib
from functools import partial
from pathlib import Path

import numba

_PACKAGE = Path(__file__).parent
_DIGEST = hashlib.sha256(b"".join(p.read_bytes() for p in sorted(_PACKAGE.glob("*.py"))))
numba.config.CACHE_DIR = str(_PACKAGE / "__pycache__" / f"kernels-{_DIGEST.hexdigest()[:16]}")

kernel = partial(numba.njit, cache=True, nogil=True, error_model="numpy")
inlined = partial(kernel, inline="always")
