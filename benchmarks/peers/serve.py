"""How a peer answers the project's requests: one JSON object a line in, value and seconds out."""

import json
import os
import sys
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")  # peers are measured on one core


def serve(methods):
    """Answer requests until there are no more.

    Parameters
    ----------
    methods : dict
        Name -> a function of the request's other parameters that prepares what is not to be
        timed and returns a function of the seed, whose value is sent back.
    """
    answers, sys.stdout = sys.stdout, sys.stderr  # what a peer prints is not an answer
    prepared = {}
    for line in sys.stdin:
        request = json.loads(line)
        seed = request.pop("seed")
        key = json.dumps(request, sort_keys=True)
        if key not in prepared:
            method = request.pop("method")
            prepared[key] = methods[method](**request)
        began = time.perf_counter()
        value = float(prepared[key](seed))
        print(json.dumps([value, time.perf_counter() - began]), file=answers, flush=True)
