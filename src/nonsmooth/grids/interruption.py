"""Long calls of compiled libraries that Ctrl-C need not wait for."""

import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

Result = TypeVar("Result")


def interruptible(call: Callable[[], Result]) -> Result:
    """Call a function in another thread and wait for it, so that Ctrl-C need not.

    Python looks for Ctrl-C between two of its own instructions, and not within a call of a
    compiled library. After Ctrl-C the call goes on until it is done or the program ends, and its
    result is dropped.

    Parameters
    ----------
    call : callable
        It must release Python's global lock, as the sparse factorisation of scipy does.

    Returns
    -------
    object
        What the call returns.
    """
    result: Future = Future()

    def run():
        try:
            result.set_result(call())
        except BaseException as error:
            result.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
    return result.result()
