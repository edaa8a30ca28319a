"""Long computations in compiled libraries, from which Ctrl-C is heard at once."""

import contextvars
import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

Result = TypeVar("Result")


def interruptible(call: Callable[[], Result]) -> Result:
    """Call a function in another thread and wait for it, so that Ctrl-C need not.

    Python looks for Ctrl-C between two of its own instructions, and not within a call of a compiled
    library. The call must release Python's global lock where it takes long, as the sparse
    factorisation of scipy and the linear algebra of numpy do; most of that of scipy does not. After
    Ctrl-C the call goes on until it is done or the program ends, and its result is dropped.

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

    threading.Thread(target=run, daemon=True).start()
    return result.result()
