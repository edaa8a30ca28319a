"""Ctrl-C ends a long computation within two seconds.

The seconds are those of a machine that has nothing else to do. Where others compute too, the
process waits for its turn: it is given a minute, but only two seconds of each processor.
"""

import signal
import subprocess
import sys
import time

import psutil
import pytest

PROGRAM = """
import warnings
warnings.simplefilter("ignore")
import nonsmooth as ns
scene = ns.Scene("obstacle", observable="x")
for keep in ("moments", "paths"):  # kernels are compiled
    ns.simulate(scene, 1, step=0.1, paths=10, keep=keep)
print("begun", flush=True)
{call}
"""
CALLS = {
    "many short blocks": "ns.simulate(scene, 1e4, step=0.01, paths=10**6)",
    "one long path": "ns.simulate(scene, 1e7, step=0.01, paths=1, times=[1e7], keep='paths')",
    "levels of grids": "ns.asymptotic_variance(scene, tol=1e-9, method='deterministic')",
}


@pytest.mark.slow
@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS.keys())
def test_ctrl_c_ends_a_computation(call):
    """The process ends by KeyboardInterrupt after less than two seconds of work per thread."""
    with subprocess.Popen(
        [sys.executable, "-c", PROGRAM.format(call=call)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout.readline() == "begun\n"
        time.sleep(2)  # it is in the midst of the computation
        watched = psutil.Process(process.pid)
        began = sum(watched.cpu_times()[:2])
        process.send_signal(signal.SIGINT)
        worked = began
        while process.poll() is None:
            try:
                worked = sum(watched.cpu_times()[:2])
            except psutil.Error:
                break
            time.sleep(0.02)
            assert worked - began < 2 * psutil.cpu_count(), "the computation goes on"
        _, errors = process.communicate(timeout=60)
    assert "KeyboardInterrupt" in errors
    assert process.returncode != 0
