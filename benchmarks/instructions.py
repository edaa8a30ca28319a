"""Instructions of one time step, counted in the machine code, beside the cycles that it takes.

`python -m benchmarks.instructions` compiles the three loops over paths of dry friction with white
noise for this processor, each alone, and finds their vectorised inner loops. It prints of what
kinds of instructions they consist, for one vector of paths and one step, and measures the cycles.
"""

import re
import time
from collections import Counter

import numba
import pandas as pd

import nonsmooth as ns
from nonsmooth.paths.kernels.panel import new_panel
from nonsmooth.paths.kernels.random_numbers import BLOCK, normals
from nonsmooth.paths.schemes.strang import STRANG, coefficients
from nonsmooth.paths.time_loop import march, of_known_shape

SCENE = ns.Scene("friction", n=100)
# Global constants: the compiler leaves out the loops of other scenes.
GIVEN, FLOW, KICK = coefficients(SCENE, 0.02), STRANG.flow, STRANG.kick
STEPS, ROUNDS = 2000, 15
CHAIN, LATENCY = 10_000_000, 4  # operations that wait for each other, and cycles of each
# what the first fitting pattern tells an instruction to be
KINDS = {
    "load, store": r"vmov\w+ .*\(",
    "square root": r"vsqrt",
    "multiply, multiply-add": r"v(fn?m|mul)",
    "add, compare, convert, select": r"v(add|sub|max|min|cmp|cvt|blend)\w*p[sd]|vcvt|.*\{%k",
    "integers and bits": r"v(p|and|or|xor)",
    "copy of a register, broadcast": r"v(mov|broadcast)",
    "counting": r"",
}


@numba.njit(error_model="numpy")
def draw(panel, lanes):
    """Draw two normal numbers for each path."""
    words, data, _ = of_known_shape(panel)
    normals(words, data, lanes)


@numba.njit(error_model="numpy")
def flow(panel, lanes):
    """Exact flow of the friction."""
    _, data, _ = of_known_shape(panel)
    FLOW(GIVEN, data, False, False, lanes)


@numba.njit(error_model="numpy")
def kick(panel, lanes):
    """Exact step of the noise, and the sums."""
    _, data, _ = of_known_shape(panel)
    KICK(GIVEN, data, 0, lanes)


def repeated(part):
    """Return a compiled loop that calls a part so many times."""

    @numba.njit
    def run(panel, lanes, times):
        for _ in range(times):
            part(panel, lanes)

    return run


@numba.njit
def chain(count):
    """Multiply and add in turn, each on the result before."""
    x = count
    for _ in range(count):
        x = x * x + 1
    return x


def inner_loop(function):
    """Return the instructions of a function's longest loop over vectors, and their bits."""
    code = "".join(function.inspect_asm().values()).replace("\t", " ")
    loops = re.findall(r"^(\.L\w+):\n((?:(?!\.L).*\n)*?\s+j\w+\s+\1)$", code, re.MULTILINE)
    bodies = [re.findall(r"^\s+([a-z].*)$", body, re.MULTILINE) for _, body in loops]
    for bits, register in ((512, "%zmm"), (256, "%ymm")):
        found = [body for body in bodies if any(register in line for line in body)]
        if found:
            return max(found, key=len), bits
    raise RuntimeError("the loop has not been vectorised")


def seconds(run):
    """Return the least time of several runs."""
    times = []
    for _ in range(ROUNDS):
        began = time.perf_counter()
        run()
        times.append(time.perf_counter() - began)
    return min(times)


def main():
    """Print the table."""
    panel = new_panel(SCENE, 1, 0)
    chain(1)
    clock = CHAIN * LATENCY / seconds(lambda: chain(CHAIN))
    table = {}
    for name, function, steps in (("normals", draw, 2), ("flow", flow, 1), ("kick", kick, 1)):
        function(panel, BLOCK)
        run = repeated(function)
        run(panel, BLOCK, 1)
        body, bits = inner_loop(function)
        kinds = Counter(next(k for k, p in KINDS.items() if re.match(p, line)) for line in body)
        table[name] = {kind: kinds[kind] / steps for kind in KINDS}
        table[name]["instructions"] = len(body) / steps
        taken = seconds(lambda run=run: run(panel, BLOCK, STEPS)) / STEPS / steps * clock
        table[name]["cycles"] = taken * bits / 32 / BLOCK
    table = pd.DataFrame(table)
    table["step"] = table.sum(axis=1)
    march(GIVEN, panel, BLOCK, STEPS, -float("inf"), float("inf"))
    whole = seconds(lambda: march(GIVEN, panel, BLOCK, STEPS, -float("inf"), float("inf")))
    print(f"{bits} bits, {bits // 32} paths a vector; {clock / 1e9:.2f} GHz")
    print(table.round(1).to_string())
    print(f"the time loop itself: {whole / STEPS * clock * bits / 32 / BLOCK:.1f} cycles a step")


if __name__ == "__main__":
    main()
