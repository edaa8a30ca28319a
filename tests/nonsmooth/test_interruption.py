"""Ctrl-C is heard while another thread works, which then ends."""

import os
import signal
import threading
import time

import numpy as np
import pytest

from nonsmooth.interruption import interruptible


def test_the_result_is_that_of_the_call():
    """Values and exceptions pass through, and so does numpy's treatment of overflow."""
    assert interruptible(lambda: 3) == 3
    with pytest.raises(ZeroDivisionError):
        interruptible(lambda: 1 // 0)
    with np.errstate(over="raise"), pytest.raises(FloatingPointError):
        interruptible(lambda: np.array([1e300]) ** 2)


def test_the_thread_ends_after_ctrl_c():
    """KeyboardInterrupt is raised at once, and the work does not go on behind the scenes."""
    before = threading.active_count()
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    begun = threading.Event()

    def endless():
        begun.set()
        while True:
            np.linalg.eigvals(np.eye(20))

    def press():
        begun.wait()
        os.kill(os.getpid(), signal.SIGINT)

    presser = threading.Thread(target=press)
    presser.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            interruptible(endless)
    finally:
        signal.signal(signal.SIGINT, previous)
        presser.join()
    until = time.monotonic() + 10
    while threading.active_count() > before and time.monotonic() < until:
        time.sleep(0.01)
    assert threading.active_count() == before
