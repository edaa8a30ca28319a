"""Where machine code is kept, and what is said of it."""

import os
import shutil
import subprocess
import sys

import pytest
from numba.core.codegen import get_host_cpu_features

from support import ROOT

FIRST = """
import numpy as np
from nonsmooth.paths.kernels import compilation
kernel = compilation.kernel(lambda x: x + 1)
with compilation.announced(kernel):
    print(kernel(1), compilation._CACHE)
"""


OF_THE_LIBRARY = """
import numpy as np
from nonsmooth.paths.kernels.panel import flush
flush(np.zeros((20, 1)), np.zeros((20, 1)), 1)
print(sum(flush.stats.cache_hits.values()))
"""

DRAWN = """
import numba
import numpy as np
from nonsmooth.paths.kernels.random_numbers import normals
words, out = np.arange(400, dtype=np.uint32).reshape(4, 100), np.zeros((2, 100), np.float32)
normals(words, out, 100)
(code,) = normals.inspect_asm().values()
print("%zmm" in code, numba.config.CPU_FEATURES is None, out.tobytes().hex())
"""


def run(library, source=FIRST, **environment):
    """Compile a kernel in a process of its own, with a library in some folder."""
    program = library / "first.py"
    program.write_text(source)
    return subprocess.run(
        [sys.executable, str(program)],
        env=os.environ | {"PYTHONPATH": str(library)} | environment,
        capture_output=True,
        text=True,
        timeout=60,
    )


@pytest.fixture
def library(tmp_path):
    """Return a copy of the library."""
    folder = tmp_path / "library"
    shutil.copytree(
        ROOT / "src" / "nonsmooth",
        folder / "nonsmooth",
        ignore=shutil.ignore_patterns("__pycache__"),
    )
    return folder


def test_the_folder_of_the_environment_is_respected(library, tmp_path):
    """NUMBA_CACHE_DIR says where."""
    done = run(library, NUMBA_CACHE_DIR=str(tmp_path / "elsewhere"))
    assert done.stdout.startswith(f"2 {tmp_path / 'elsewhere'}")
    assert not list(library.rglob("kernels-*"))


def test_a_read_only_library_is_compiled_into_the_users_folder(library, tmp_path):
    """A file in the place of the library's folder stands for one that cannot be written to."""
    (library / "nonsmooth" / "__pycache__").write_text("")
    done = run(library, XDG_CACHE_HOME=str(tmp_path / "home"), PYTHONDONTWRITEBYTECODE="1")
    assert done.stdout.startswith(f"2 {tmp_path / 'home'}")


def test_without_any_folder_there_is_no_cache_and_a_line_says_so(library, tmp_path):
    """As in a container whose user has no home."""
    for name in ("library/nonsmooth/__pycache__", "home"):
        (tmp_path / name).write_text("")
    done = run(library, XDG_CACHE_HOME=str(tmp_path / "home"), PYTHONDONTWRITEBYTECODE="1")
    assert done.stdout.split() == ["2"]
    assert done.stderr.splitlines() == [
        "nonsmooth: compiling the simulation, every time; "
        "set NUMBA_CACHE_DIR to a folder that can be written to"
    ]


@pytest.mark.slow
def test_copies_of_the_library_share_what_they_compiled(library, tmp_path):
    """Machine code is found by its package: the same source elsewhere loads it."""
    twin = tmp_path / "twin"
    shutil.copytree(library, twin)
    kept = str(tmp_path / "kept")
    hits = [run(folder, OF_THE_LIBRARY, NUMBA_CACHE_DIR=kept).stdout for folder in (library, twin)]
    assert hits == ["0\n", "1\n"]


@pytest.mark.slow
@pytest.mark.skipif("+avx512f" not in get_host_cpu_features(), reason="has narrower vectors")
def test_vectors_are_as_wide_as_can_be_and_change_no_bit(library):
    """What others compile is left alone, and NUMBA_CPU_FEATURES is respected."""
    widest, unset, drawn = run(library, DRAWN).stdout.split()
    assert (widest, unset) == ("True", "True")
    narrow = run(library, DRAWN, NUMBA_CPU_FEATURES=get_host_cpu_features() + ",-avx512f")
    assert narrow.stdout.split() == ["False", "False", drawn]


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """Environment in which the loops have been compiled."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path_factory.mktemp("kernels"))}
    told = subprocess.run(
        [sys.executable, "-m", "nonsmooth"],
        check=True,
        capture_output=True,
        text=True,
        env=environment,
    )
    assert "compiling" in told.stderr
    return environment


@pytest.mark.slow
@pytest.mark.xdist_group("compiled")
@pytest.mark.parametrize(
    "call",
    [
        "simulate(scene, 1, step=0.1, paths=100)",
        "simulate(scene, 1, step=0.1, paths=100, precision='float64')",
        "crossing_probability(scene, 1.0, [1.0], step=0.1, paths=100)",
        "crossing_probability(scene, 1.0, [1.0], step=0.1, paths=100, precision='float64')",
        "crossing_probability(scene, 3.0, [2.0], method='importance_sampling')",
    ],
)
def test_what_is_compiled_beforehand_is_what_calls_need(compiled, call):
    """Of any scene."""
    scene = "import nonsmooth as ns; scene = ns.Scene('obstacle', 'langevin', observable='x')"
    told = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", f"{scene}; ns.{call}"],
        check=True,
        capture_output=True,
        text=True,
        env=compiled,
    )
    assert "compiling" not in told.stderr
