"""Scripts that a server forks end as those that are started by a command."""

import importlib.util
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from snakemake.benchmark import BenchmarkRecord

from support import ROOT
from workflow import fork_server
from workflow.forked_jobs import ForkServer


@pytest.fixture(scope="module")
def server():
    """Serve the tests of this file."""
    with ForkServer() as server:
        yield server


@pytest.fixture
def run(server, tmp_path):
    """Write a script and let the server run it, once it is ready."""

    def run(text, environment=None, record=None, name="script.py", server=server):
        script = tmp_path / name
        script.write_text(text)
        patience = time.monotonic() + 60
        while not server.run(str(script), environment or {}, record):
            assert time.monotonic() < patience
            time.sleep(0.05)

    return run


@pytest.fixture
def copies(tmp_path, monkeypatch):
    """Copy the modules of this repository for servers that start now."""
    folder = tmp_path / "copies"
    for package in fork_server.OWN:
        shutil.copytree(ROOT / "src" / package, folder / package)
    monkeypatch.setenv("PYTHONPATH", str(folder))
    return folder


def test_a_script_is_the_main_program(run, tmp_path):
    """With its own arguments, environment and folder of modules."""
    (tmp_path / "beside.py").write_text("VALUE = 'beside'")
    run(
        "import os, sys\n"
        "from pathlib import Path\n"
        "from beside import VALUE\n"
        "assert __name__ == '__main__'\n"
        "assert sys.argv == [__file__]\n"
        "Path(__file__).with_name('found').write_text(os.environ['GIVEN'] + VALUE)\n",
        {"GIVEN": "given "},
    )
    assert (tmp_path / "found").read_text() == "given beside"


def test_libraries_are_there(run):
    """With the modules of this repository that most jobs need."""
    wanted = {"xarray", "numba", "sympy", "matplotlib.pyplot", *fork_server.MODULES}
    run(f"import sys; assert {wanted} <= set(sys.modules)")


def test_libraries_and_modules_exist():
    """What the server cannot import it leaves to the jobs, without a word."""
    for name in (*fork_server.LIBRARIES, *fork_server.MODULES):
        assert importlib.util.find_spec(name) is not None, name


def test_an_edited_script_is_imported_anew(run, tmp_path):
    """The second job has the second value."""
    for value in (1, 22):
        (tmp_path / "edited.py").write_text(f"VALUE = {value}")
        run(f"import edited; assert edited.VALUE == {value}")


def test_after_an_edit_modules_of_this_repository_are_imported_anew(run, copies):
    """All of them, for others have imported what was edited; a module that is new counts, too."""
    checks, panels = "nonsmooth.checks", "reproduction.rendering.panels"
    with ForkServer() as other:
        run(f"import sys; assert {{'{checks}', '{panels}'}} <= set(sys.modules)", server=other)
        with open(copies / "nonsmooth/checks.py", "a") as file:
            file.write("EDITED = True\n")
        (copies / "nonsmooth/.#checks.py").symlink_to("nowhere")  # as some editors lock a file
        run("from nonsmooth.checks import EDITED", server=other)
        run(f"import sys; assert '{panels}' not in sys.modules", server=other)


def test_a_server_starts_though_a_module_is_broken(run, copies):
    """The job that imports it says so."""
    (copies / "nonsmooth/checks.py").write_text("def half(")
    with ForkServer() as other:
        run("import numpy", server=other)
        with pytest.raises(subprocess.CalledProcessError):
            run("import nonsmooth.checks", server=other)


@pytest.mark.parametrize(
    ("text", "status"),
    [
        ("raise SystemExit(3)", 3),
        ("raise ValueError('told on the standard error')", 1),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", -signal.SIGKILL),
    ],
)
def test_a_script_that_fails_says_how(run, text, status):
    """By its exit code, or the signal that killed it."""
    with pytest.raises(subprocess.CalledProcessError) as failed:
        run(text)
    assert failed.value.returncode == status


def test_scripts_run_at_the_same_time(run):
    """Each waits for what the other one writes."""
    text = (
        "import time\n"
        "from pathlib import Path\n"
        "Path(__file__).with_suffix('.here').touch()\n"
        "while len(list(Path(__file__).parent.glob('*.here'))) < 2: time.sleep(0.01)\n"
    )
    with ThreadPoolExecutor() as pool:
        list(pool.map(lambda name: run(text, name=name), ("one.py", "other.py")))


def test_ctrl_c_ends_a_job(run):
    """Though the server does not hear it."""
    with pytest.raises(subprocess.CalledProcessError) as failed:
        run("import os, signal; os.kill(os.getpid(), signal.SIGINT); import time; time.sleep(60)")
    assert failed.value.returncode in (1, -signal.SIGINT)


def test_what_a_script_needs_is_recorded(run):
    """As of a command: seconds and memory."""
    record = BenchmarkRecord()
    run("import time; stop = time.monotonic() + 1\nwhile time.monotonic() < stop: pass", {}, record)
    assert record.running_time >= 1
    assert record.max_rss > 10  # MB


def test_a_server_that_is_gone_runs_nothing(run, tmp_path):
    """Its jobs are then started by the command."""
    with ForkServer() as other:
        run("", server=other)
        other.process.kill()
        other.process.wait()
        assert not other.run(str(tmp_path / "script.py"), {})


def test_kernels_are_compiled_as_in_other_processes(run, tmp_path):
    """Numba keeps machine code by what it may use of the processor; else all would be compiled."""
    text = (
        "from pathlib import Path\n"
        "import nonsmooth.paths.time_loop\n"
        "from numba.core.registry import cpu_target\n"
        "may_use = cpu_target.target_context.codegen().magic_tuple()\n"
        "Path(__file__).with_suffix('.features').write_text(repr(may_use))\n"
    )
    run(text, name="served.py")
    (tmp_path / "alone.py").write_text(text)
    subprocess.run([sys.executable, tmp_path / "alone.py"], check=True)
    served, alone = (tmp_path / f"{name}.features" for name in ("served", "alone"))
    assert served.read_text() == alone.read_text()
