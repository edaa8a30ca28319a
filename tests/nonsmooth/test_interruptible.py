"""Ctrl-C is heard while another thread works."""

import os
import signal
import threading

import numpy as np
import pytest

from nonsmooth.progress import interruptible


def test_the_result_is_that_of_the_call():
    """Values and exceptions pass through, and so does numpy's treatment of overflow."""
    assert interruptible(lambda: 3) == 3
    with pytest.raises(ZeroDivisionError):
        interruptible(lambda: 1 // 0)
    with np.errstate(over="raise"), pytest.raises(FloatingPointError):
        interruptible(lambda: np.array([1e300]) ** 2)


def test_ctrl_c_is_heard_while_a_library_works():
    """KeyboardInterrupt is raised long before the call is done."""
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    begun, done = threading.Event(), threading.Event()

    def work():
        begun.set()
        done.wait(60)

    def press():
        begun.wait()
        os.kill(os.getpid(), signal.SIGINT)

    presser = threading.Thread(target=press)
    presser.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            interruptible(work)
        assert not done.is_set()
    finally:
        signal.signal(signal.SIGINT, previous)
        done.set()
        presser.join()
