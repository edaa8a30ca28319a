"""Work in a process of its own, which is ended after some seconds of processor time."""

import multiprocessing
import resource
from collections.abc import Callable, Iterator
from typing import Any


def sent(work: Callable[[Callable[[Any], None]], None], seconds: int) -> Iterator[Any]:
    """Yield what work sends, as long as it has not been ended.

    Parameters
    ----------
    work : callable
        Takes a function that sends one object.
    seconds : int
        Of processor time, "s".
    """
    receiver, sender = multiprocessing.Pipe(duplex=False)

    def limited():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        work(sender.send)

    process = multiprocessing.get_context("fork").Process(target=limited)
    process.start()
    sender.close()
    try:
        while True:
            yield receiver.recv()
    except EOFError:
        pass
    finally:
        process.join()
