"""How the numerical kernels are compiled.

Floating-point operations are not reordered (no fast-math), so that results do not depend on how the
compiler vectorises a loop. Kernels release Python's global lock (GIL), so that threads run at the
same time. Machine code is cached on disk. Numba's own cache notices a change of the file that holds
a kernel, but not of the files that the kernel calls into. The cache folder is therefore named after
the content of the rooms that kernels are made of, and its parts after packages, so that copies of
the library share one cache.

Loops have the widest vectors that the processor has. LLVM prefers half of them on some processors
with AVX-512, for the sake of programs that use them rarely; kernels hardly do anything else.
"""

import hashlib
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal

import numba
import platformdirs
from numba.core import event
from numba.core.caching import UserProvidedCacheLocator
from numba.core.codegen import get_host_cpu_features

from nonsmooth.progress import begin

_PACKAGE = Path(__file__).parents[2]  # the whole library
_SOURCES = sorted(p for room in ("paths", "scenes") for p in (_PACKAGE / room).rglob("*.py"))
_DIGEST = hashlib.sha256(b"".join(path.read_bytes() for path in _SOURCES)).hexdigest()


def _cache_folder() -> str:
    """Return a folder that can be written to, or nothing.

    It is that of the environment variable NUMBA_CACHE_DIR; or else the library's own; or else, if
    that is read-only, the user's.
    """
    wanted: Any = numba.config
    own, of_user = _PACKAGE / "__pycache__", platformdirs.user_cache_path("nonsmooth")
    for parent in [Path(wanted.CACHE_DIR)] if wanted.CACHE_DIR else [own, of_user]:
        folder = parent / f"kernels-{_DIGEST[:16]}"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            tempfile.TemporaryFile(dir=folder).close()
        except OSError:
            continue
        return str(folder)
    return ""


_CACHE = _cache_folder()


def features() -> str | None:
    """Return what code may use of the processor, or nothing where the default is right.

    That of the environment variable NUMBA_CPU_FEATURES comes first. Numba keeps to what it knows
    when the first function of a process is decorated; machine code that is cached for other
    features is compiled again. So who decorates before the kernels are imported tells numba this.
    """
    wanted: Any = numba.config
    if wanted.CPU_FEATURES is not None:
        return str(wanted.CPU_FEATURES)
    of_host = get_host_cpu_features()
    return f"{of_host},-prefer-256-bit" if "+avx512f" in of_host.split(",") else None


_FEATURES = features()


class ByPackage(UserProvidedCacheLocator):
    """Finds machine code by the package of its source, wherever the library lies."""

    @classmethod
    def get_suitable_cache_subpath(cls, py_file):
        """Return the folder inside the cache folder."""
        folder = Path(py_file).parent
        if not folder.is_relative_to(_PACKAGE):  # a kernel of somebody else
            return super().get_suitable_cache_subpath(py_file)
        return ".".join(folder.relative_to(_PACKAGE).parts)


def kernel(
    function: Callable, forceinline: bool = False, inline: Literal["never", "always"] = "never"
) -> Callable:
    """Compile a function to machine code when it is first called."""
    # Numba reads its settings when a function is decorated, the features when the first one is.
    # They are restored for other users of numba.
    config: Any = numba.config
    of_others = config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES, config.CPU_FEATURES
    config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = _CACHE, f"{__name__}.{ByPackage.__name__}"
    config.CPU_FEATURES = _FEATURES
    try:
        return numba.njit(
            function,
            cache=bool(_CACHE),
            nogil=True,
            error_model="numpy",
            forceinline=forceinline,
            inline=inline,
        )
    finally:
        config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES, config.CPU_FEATURES = of_others


def inlined(function: Callable) -> Callable:
    """Compile a function into its callers: a loop is only vectorised if there is no call in it."""
    return kernel(function, forceinline=True)


def merged(function: Callable) -> Callable:
    """Compile a function only as a part of its callers, which halves the time of compiling them.

    For those that call others that are `inlined`: arithmetic that is merged may not vectorise.
    """
    return kernel(function, inline="always")


@contextmanager
def announced(loop: Any) -> Iterator[None]:
    """Say so, in one line on the standard error, if a kernel is compiled and not just loaded.

    Parameters
    ----------
    loop : numba dispatcher
        The kernel that is meant, not those that are compiled into it.
    """
    begin()
    with event.install_listener("numba:compile", _Announcement(loop)):
        yield


class _Announcement(event.Listener):
    def __init__(self, loop):
        self.loop = loop

    def on_start(self, event):
        if event.data["dispatcher"] is self.loop:
            kept = (
                f"once; it is kept in {_CACHE}"
                if _CACHE
                else "every time; set NUMBA_CACHE_DIR to a folder that can be written to"
            )
            print(f"nonsmooth: compiling the simulation, {kept}", file=sys.stderr)

    def on_end(self, event):
        pass
