"""Bars appear where somebody watches; Ctrl-C is heard while another thread works."""

import io
import os
import signal
import sys
import threading
import time

import numpy as np
import pytest

from nonsmooth import progress


class Screen(io.StringIO):
    """A terminal that keeps what it is sent."""

    def isatty(self):
        """Return that it is one."""
        return True


def drawn(monkeypatch, stream, context):
    """Return what a bar writes to a standard error while it advances three times."""
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(progress, "DELAY", 0.0)
    with context() as advance:
        for _ in range(3):
            advance(1)
    return stream.getvalue()


def test_logs_have_no_bars(monkeypatch):
    """Nothing is written to a file."""
    assert drawn(monkeypatch, io.StringIO(), lambda: progress.bar("simulating", 3)) == ""


@pytest.mark.parametrize(
    ("context", "expected"),
    [
        (lambda: progress.bar("simulating", 3), "simulating:   0%"),
        (lambda: progress.counter("levels", 9), "levels: 0 of at most 9"),
        (lambda: progress.counter("grids"), "grids: 0"),
    ],
)
def test_terminals_have(monkeypatch, context, expected):
    """A terminal shows what is computed, and how much of it."""
    assert expected in drawn(monkeypatch, Screen(), context)


def test_short_computations_have_no_bars(monkeypatch):
    """What is over within the delay shows nothing, even on a terminal."""
    stream = Screen()
    monkeypatch.setattr(sys, "stderr", stream)
    with progress.bar("simulating", 3) as advance:
        advance(3)
    assert "simulating" not in stream.getvalue()


def test_the_result_is_that_of_the_call():
    """Values and exceptions pass through, and so does numpy's treatment of overflow."""
    assert progress.interruptible(lambda: 3) == 3
    with pytest.raises(ZeroDivisionError):
        progress.interruptible(lambda: 1 // 0)
    with np.errstate(over="raise"), pytest.raises(FloatingPointError):
        progress.interruptible(lambda: np.array([1e300]) ** 2)


def test_ctrl_c_is_heard_while_a_library_works():
    """KeyboardInterrupt is raised long before the call is done."""
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    begun, done, waited = threading.Event(), threading.Event(), threading.Event()

    def work():
        begun.set()
        if not done.wait(60):
            waited.set()

    def press():
        begun.wait()
        os.kill(os.getpid(), signal.SIGINT)

    presser = threading.Thread(target=press)
    presser.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            progress.interruptible(work)
        assert not waited.is_set()
    finally:
        signal.signal(signal.SIGINT, previous)
        done.set()
        presser.join()


def test_a_clock_runs_while_nothing_advances(monkeypatch):
    """The time that has passed is shown, also before the first of the things is done."""
    stream = Screen()
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setattr(progress, "DELAY", 0.0)
    monkeypatch.setattr(progress, "BEAT", 0.01)
    with progress.counter("grids"):
        for _ in range(500):
            time.sleep(0.01)
            if stream.getvalue().count("grids: 0") > 2:
                return
    pytest.fail(f"nothing but {stream.getvalue()!r} was shown")
