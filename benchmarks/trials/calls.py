"""Call every public function with bad and odd arguments, and see how it ends.

`python -m benchmarks.trials.calls [calls] [seed] [file]` makes calls (1000 unless given): each
argument of each function in turn replaced by an odd value, random pairs of such arguments, and
scenes with extreme but legal parameters. Two processes make them, where simulations are limited to
an estimated 5 seconds. A call ends well if it returns something sensible, or is refused by a
`NonsmoothError` in one line of at most 300 characters. After 30 seconds of a processor it is sent
Ctrl-C. If what it asks for is legal and without simulations, it may take that long: it has then
ended well if a terminal would have shown how far it was, and it ends within two seconds. All
others are killed. Everything else is printed, once for each place that it comes from: other
exceptions, warnings, calls without end, and nonsense such as a variance that is negative or not a
number. The exit code is then 1. With a file, results are appended to it, and calls that it has are
not repeated.
"""

import collections
import contextlib
import dataclasses
import functools
import io
import json
import multiprocessing
import os
import queue
import resource
import signal
import sys
import threading
import time
import traceback
import warnings
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import psutil
import sympy
import xarray as xr

import nonsmooth as ns
from benchmarks.trials import odd_values
from nonsmooth import dimensions
from nonsmooth.errors import AccuracyWarning, AssumptionWarning
from nonsmooth.paths import tuning

SECONDS = 30.0
SIMULATION = 5.0  # seconds that one may take by its estimate, which may be five times too low
TO_END = 2.0  # seconds of each processor after Ctrl-C
POLL = 0.1
PATIENCE = 20  # times as long may a call take that waits for the processor
WORKERS = 2
LONGEST_MESSAGE = 300
MEMORY = 8 * 2**30  # bytes of address space of a worker, so that none takes the whole machine
# functions whose estimates may be negative
SIGNED = "ns.mean(", "ns.extrapolation_length(", "ns.asymptotic_variance_sensitivity("
# functions whose limits and errors are infinite where nothing is known
OPEN = "ns.crossing_threshold(", "ns.failure_time(", "ns.hazard_rate(", "ns.reliability_index("
WELL = ("fine", "refused", "long")

NAMES = {
    "ns": ns,
    "dimensions": dimensions,
    "np": np,
    "xr": xr,
    "sympy": sympy,
    "mpmath": mpmath,
    "Decimal": Decimal,
    "Fraction": Fraction,
    "nan": np.nan,
    "inf": np.inf,
}


def written(function: str, arguments: dict[str, str]) -> str:
    """Write a call as Python, so that it can be repeated by hand."""
    function = function.partition(" ")[0]
    module = "" if function.startswith("dimensions.") else "ns."
    given = ", ".join(f"{name}={value}" for name, value in arguments.items())
    return f"{module}{function}({given})"


def single_calls() -> list[str]:
    """Every argument of every function replaced by every odd value."""
    return [
        written(function, arguments | {name: value})
        for function, arguments in odd_values.VALID.items()
        for name in arguments
        for value in odd_values.of(name)
    ]


def scene_calls() -> list[str]:
    """Every question asked of every extreme scene."""
    return [
        written(function, {"scene": scene} | arguments)
        for scene in odd_values.SCENES
        for function, arguments in odd_values.QUESTIONS
    ]


@functools.cache
def long_calls() -> frozenset[str]:
    """Return the questions asked of scenes that may take long, because nothing is wrong."""
    return frozenset(call for call in scene_calls() if "monte_carlo" not in call)


def pair_calls(count: int, rng: np.random.Generator) -> list[str]:
    """Random pairs of arguments replaced by odd values."""
    calls = []
    several = [name for name, arguments in odd_values.VALID.items() if len(arguments) > 1]
    for _ in range(count):
        function = several[rng.integers(len(several))]
        arguments = dict(odd_values.VALID[function])
        for name in rng.choice(list(arguments), 2, replace=False):
            values = odd_values.of(name)
            arguments[name] = values[rng.integers(len(values))]
        calls.append(written(function, arguments))
    return calls


def chosen_calls(count: int, seed: int) -> list[str]:
    """Draw calls: a fifth about extreme scenes, a tenth of pairs, the others of one odd value."""
    rng = np.random.default_rng(seed)
    scenes, pairs = list(rng.permutation(scene_calls())), pair_calls(count // 10, rng)
    drawn = scenes[: count // 5] + pairs
    singles = list(rng.permutation(single_calls()))[: count - len(drawn)]
    return [str(call) for call in dict.fromkeys(singles + drawn)]


def judged(call: str) -> dict:
    """Make a call and say how it ended: `outcome`, what was `told`, `place` and `seconds`."""
    began = time.process_time()
    terminal = _Terminal()
    with contextlib.redirect_stderr(terminal), warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        try:
            outcome, told, place = _of_result(call, eval(call, dict(NAMES)))
        except ns.NonsmoothError as error:
            told, place = str(error), _place(error)
            short = len(told.splitlines()) == 1 and len(told) <= LONGEST_MESSAGE
            outcome = "refused" if short else "long message"
        except KeyboardInterrupt as error:
            legal = call in long_calls() and terminal.getvalue()
            outcome, told, place = "long" if legal else "too slow", "no answer", _place(error)
        except Exception as error:
            outcome, told, place = "raised", f"{type(error).__name__}: {error}", _place(error)
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")
    # a result that misses the usual accuracy is returned with its error and a warning
    expected = AssumptionWarning, AccuracyWarning
    unwanted = [w for w in warned if not issubclass(w.category, expected)]
    if unwanted and outcome in WELL:
        first = unwanted[0]
        outcome, told = "warned", f"{first.category.__name__}: {first.message}"
        place = f"{Path(first.filename).name}:{first.lineno}"
    seconds = time.process_time() - began
    return {"call": call, "outcome": outcome, "told": told, "place": place, "seconds": seconds}


class _Terminal(io.StringIO):
    """Keeps what long runs show of their progress."""

    def isatty(self):
        return True


def _place(error):
    """Last line of the package that an exception went through."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if f"{Path(ns.__file__).parent}" in frame.filename]
    return f"{Path(own[-1].filename).name}:{own[-1].lineno}" if own else "the call itself"


def _of_result(call, result):
    wrong = nonsense(result, call.startswith(SIGNED), call.startswith(OPEN))
    return ("nonsense", wrong, call.partition("(")[0]) if wrong else ("fine", "", "")


def nonsense(result: object, signed: bool = False, infinite: bool = False) -> str:
    """Say what is wrong with a result; nothing if it makes sense.

    An estimate may be negative only if it is `signed`, and numbers may be infinite only if that is
    said.
    """
    if isinstance(result, ns.Estimate):
        checks = {
            "value": (result.value, -np.inf if signed else 0.0, np.inf),
            "error": (result.error, 0.0, np.inf),
        }
    elif isinstance(result, xr.Dataset):
        checks = {str(name): _range(result, str(name)) for name in result.variables}
    elif isinstance(result, np.ndarray):  # a probability or a density of Brownian motion
        checks = {"the array": (result, 0.0, np.inf)}
    else:
        return ""
    for name, (values, least, most) in checks.items():
        values = np.asarray(values, dtype=float)
        known = ~np.isnan(values) if infinite else np.isfinite(values)
        if not np.all(known):
            return f"{name} = {values[~known].ravel()[0]}"
        if np.any(values < least) or np.any(values > most):
            return f"{name} = {values!r}"[:200]
    return ""


def _range(dataset, name):
    """Values of a variable and the limits that they must keep to, up to their own errors."""
    values = dataset[name].values
    error = np.max(dataset[f"{name}_error"].values) if f"{name}_error" in dataset else 0.0
    if name.endswith("_error"):
        return values, 0.0, np.inf
    if name in ("probability", "survival"):
        return values, -error, 1 + error
    if name in ("lower", "upper") and "probability" in dataset.data_vars:
        return values, 0.0, 1.0
    if name in ("threshold", "time", "hazard_rate"):
        return values, 0.0, np.inf
    if name in ("v", "variance") or (name.startswith("density_")):
        return values, -error, np.inf
    return values, -np.inf, np.inf


class _Worker:
    """A process that stays warm and is replaced when a call has no end."""

    def __init__(self):
        self.start()

    def start(self):
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs,), daemon=True)
        self.process.start()
        theirs.close()
        self.connection.recv()  # it is ready

    def judged(self, call):
        """Hand a call over; if no answer comes in time, press Ctrl-C, then kill the process."""
        self.connection.send(call)
        found = {"call": call, "outcome": "too slow", "told": "no answer", "place": call}
        found["seconds"] = SECONDS
        try:
            if self._answers(SECONDS):
                return self.connection.recv()
            os.kill(self.process.pid, signal.SIGINT)
            if self._answers(TO_END * psutil.cpu_count()):
                found = self.connection.recv()
        except (EOFError, psutil.Error):
            found["outcome"] = "died"
        self.process.kill()
        self.process.join()
        self.start()
        return found

    def _answers(self, seconds):
        """Whether an answer comes in time of the processor, whatever else the machine does."""
        spent = self._seconds()
        for _ in range(round(PATIENCE * seconds / POLL)):
            if self.connection.poll(POLL):
                return True
            if self._seconds() - spent > seconds:
                return False
        return False

    def _seconds(self):
        times = psutil.Process(self.process.pid).cpu_times()
        return times.user + times.system


def _serve(connection):
    """Judge the calls that arrive, in a process of its own."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    signal.signal(signal.SIGINT, signal.default_int_handler)
    tuning.COST = dataclasses.replace(tuning.COST, longest_run=SIMULATION / 3600)
    scene = ns.Scene("friction")
    ns.simulate(scene, horizon=1.0, step=0.1, paths=8, threads=1)  # compiles, or loads what is
    connection.send("ready")
    while True:
        connection.send(judged(connection.recv()))


def trial(calls: list[str], file: Path | None = None) -> list[dict]:
    """Make the calls in two processes; return how each ended, in the order given."""
    known = {}
    if file and file.exists():
        kept = map(json.loads, file.read_text(encoding="utf-8").splitlines())
        known = {record["call"]: record for record in kept}
    waiting: queue.SimpleQueue = queue.SimpleQueue()
    for call in calls:
        if call not in known:
            waiting.put(call)

    def work():
        worker = _Worker()
        while True:
            try:
                call = waiting.get_nowait()
            except queue.Empty:
                return worker.process.kill()
            known[call] = worker.judged(call)
            if file:
                with file.open("a", encoding="utf-8") as lines:
                    lines.write(json.dumps(known[call]) + "\n")

    threads = [threading.Thread(target=work) for _ in range(WORKERS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return [known[call] for call in calls]


def report(records: list[dict]) -> str:
    """Write the counts of outcomes, and one example of each bad case."""
    counts = collections.Counter(record["outcome"] for record in records)
    lines = [f"{len(records)} calls: " + ", ".join(f"{n} {name}" for name, n in counts.items())]
    slow = [r["seconds"] for r in records if r["outcome"] == "refused" and r["seconds"] > 10]
    lines.append(f"refused after more than 10 s: {len(slow)}")
    cases = collections.defaultdict(list)
    for record in records:
        if record["outcome"] not in WELL:
            cases[record["outcome"], record["place"]].append(record)
    lines.append(f"distinct bad cases: {len(cases)}")
    for (outcome, place), found in sorted(cases.items()):
        told = " ".join(found[0]["told"].split())[:200]
        lines += [f"{outcome}, {len(found)} times, at {place}: {told}", f"    {found[0]['call']}"]
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Run the trial; the exit code says whether there were bad cases."""
    count = int(arguments[0]) if arguments else 1000
    seed = int(arguments[1]) if len(arguments) > 1 else 0
    file = Path(arguments[2]) if len(arguments) > 2 else None
    records = trial(chosen_calls(count, seed), file)
    print(report(records))
    return int(any(record["outcome"] not in WELL for record in records))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
