"""Extreme questions are answered or refused soon, none runs on and on; and Ctrl-C ends them.

Ten seconds of a processor are allowed. A timer that counts them stops what takes longer, wherever
it is, as Ctrl-C would. Kernels are compiled before. Ctrl-C ends a computation within two seconds on
a machine that has nothing else to do. Where others compute too, the process waits for its turn: it
is given a minute, but only two seconds of each processor.
"""

import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import numpy as np
import psutil
import pytest

import nonsmooth as ns

SECONDS = 10.0


@contextmanager
def limited():
    """Fail after so many seconds of a processor."""

    def stop(number, frame):
        pytest.fail(f"no answer after {SECONDS:g} s")

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def friction(**others):
    """Dry friction, which has one variable with white noise."""
    return ns.Scene("friction", **others)


def obstacle(**others):
    """Obstacles, with two variables or more."""
    return ns.Scene("obstacle", **{"observable": "x"} | others)


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """Compile the kernels of the scenes below."""
    for scene in (friction(), obstacle()):
        ns.simulate(scene, 1.0, step=0.1, paths=10)
        ns.simulate(scene, 1.0, step=0.1, paths=10, keep="paths")
        ns.crossing_probability(scene, 1.0, [1.0], p=1, step=0.1, paths=10)


REFUSED = {
    "less damping": lambda: ns.asymptotic_variance(friction(damping=1e-12)),
    "a pole": lambda: ns.asymptotic_variance(friction(observable="1/y")),
    "a pole in the plane": lambda: ns.simulate(obstacle(observable="x/(y - 0.5)"), 1.0),
    "poles without number": lambda: ns.variance(friction(observable="sin(y)/cos(y)"), [1.0]),
    "a power": lambda: ns.mean_time_to_failure(friction(observable="y**51"), 0.5),
    "oscillations": lambda: ns.asymptotic_variance(friction(observable="sin(1e9*y)")),
    "oscillations of four variables": lambda: ns.asymptotic_variance(
        obstacle(noise="hamiltonian", observable="x + sin(1e9*eta)")
    ),
    "weak noise from afar": lambda: ns.crossing_probability(
        friction(noise=ns.White(1e-2), observable="y*abs(y)", start={"y": 5}),
        0.2,
        [0.01],
        method="deterministic",
    ),
    "short steps": lambda: ns.simulate(friction(), 10, step=1e-12),
    "short steps of one path": lambda: ns.simulate(
        friction(), 10, step=1e-12, paths=1, keep="paths"
    ),
    "moments of one path": lambda: ns.simulate(friction(), 1e6, step=0.01, paths=1),
    "short steps to a threshold": lambda: ns.crossing_probability(
        friction(), 1.0, [1.0], p=10, step=1e-12
    ),
    "a far horizon": lambda: ns.simulate(obstacle(), 1e15),
    "a horizon beyond counting": lambda: ns.simulate(obstacle(), 1e300, step=0.1, paths=10),
    "a far threshold's horizon": lambda: ns.crossing_probability(
        friction(), 1.0, [1e12], p=10, step=0.1, paths=1000
    ),
    "paths without number": lambda: ns.simulate(friction(), 1, step=0.01, paths=10**15),
    "paths that no memory holds": lambda: ns.simulate(
        friction(), 1, step=0.01, paths=10**9, keep="paths"
    ),
    "a late variance by paths": lambda: ns.variance(friction(), [1e12], method="monte_carlo"),
    "a tolerance beyond paths": lambda: ns.simulate(friction(), 1, tol=1e-9),
    "kicks of a steep potential": lambda: ns.simulate(
        friction(potential="sin(1e9*x) + x**2", observable="x"), 1e4, paths=1000
    ),
}


@pytest.mark.parametrize("call", REFUSED.values(), ids=REFUSED.keys())
def test_what_nobody_can_wait_for_is_refused(call):
    """In one line, by an error that is meant for the user."""
    with limited(), pytest.raises(ns.NonsmoothError) as refused:
        call()
    assert "\n" not in str(refused.value)


ANSWERED = {
    "paths that hardly differ": lambda: (
        ns.crossing_probability(friction(noise=ns.White(1e-6), start={"y": 5}), 0.2, [0.041])[
            "probability"
        ].values
    ),
    "when they arrive": lambda: (
        ns.failure_time(friction(noise=ns.White(1e-6), start={"y": 5}), 0.2)["time"].values
    ),
    "long after an arrival": lambda: (
        ns.crossing_probability(
            friction(observable="sign(y)", start={"y": 5}), 0.2, [0.1, 1.0], method="deterministic"
        )["probability"].values
    ),
    "hardly any damping": lambda: ns.asymptotic_variance(friction(damping=1e-9)).value,
    "a late variance": lambda: ns.variance(friction(), [1e12])["v"].values,
    "a pole that can be integrated": lambda: (
        ns.asymptotic_variance(friction(observable="log(abs(y))")).value
    ),
    "a stiff penalty": lambda: (
        ns.simulate(obstacle(n=1e12), 1.0, paths=1000, step=0.01)["variance"].values
    ),
}


@pytest.mark.parametrize("call", ANSWERED.values(), ids=ANSWERED.keys())
def test_what_can_be_answered_is(call):
    """By finite numbers."""
    with limited():
        assert np.all(np.isfinite(call()))


# a shell starts what runs in its background with SIGINT ignored
PROGRAM = """
import signal, warnings
signal.signal(signal.SIGINT, signal.default_int_handler)
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
    "dense eigenproblems": "ns.extrapolation_length(scene, tol=1e-9)",
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
        try:
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
        finally:
            process.kill()
    assert "KeyboardInterrupt" in errors
    assert process.returncode != 0
