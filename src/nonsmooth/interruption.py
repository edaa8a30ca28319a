"""Long computations in compiled libraries, from which Ctrl-C is heard at once."""

import contextvars
import ctypes
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

Result = TypeVar("Result")


class _Dropped(Exception):
    """Ends a thread whose result nobody waits for any more."""


def interruptible(call: Callable[[], Result]) -> Result:
    """Call a function in another thread and wait for it, so that Ctrl-C need not.

    Python looks for Ctrl-C between two of its own instructions, and not within a call of a compiled
    library. The call must release Python's global lock where it takes long, as the sparse
    factorisation of scipy and the linear algebra of numpy do; most of that of scipy does not. After
    Ctrl-C the thread ends at its next instruction of Python.

    Parameters
    ----------
    call : callable
        Takes nothing.

    Returns
    -------
    object
        What the call returns; what it raises is raised here.
    """
    result: Future = Future()
    context = contextvars.copy_context()  # has numpy's treatment of overflow

    def run():
        try:
            result.set_result(context.run(call))
        except BaseException as error:
            result.set_exception(error)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        return result.result()
    except BaseException:
        if thread.is_alive():
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(thread.ident or 0), ctypes.py_object(_Dropped)
            )
        raise
