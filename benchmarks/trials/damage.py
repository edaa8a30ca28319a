"""Damage artifacts in every way, and see that none is read as if it were whole.

`python -m benchmarks.trials.damage [RESULTS]` takes the artifacts of a finished run (results/smoke
unless given) and damages a copy of each. A process of its own reads it, for at most 30 seconds.
Then writing is disturbed: killed at random times, and stopped by a limit on the size of files.

Printed is, for each kind of damage, how often the reader refused it in one line with its cure, got
the same values nevertheless, accepted others, did something else, crashed or hung. The program
fails if anything but the first two happened.
"""

import collections
import multiprocessing
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
from pathlib import Path

import netCDF4
import numpy as np
import xarray as xr

from reproduction.errors import ArtifactError
from reproduction.jobs import artifact

SEED = 1
LONGEST = 30  # seconds
KILLS = 100
REFUSED, SAME, ACCEPTED, UNCLEAR = "refused", "same values", "ACCEPTED", "UNCLEAR"
CRASHED, HUNG = "CRASHED", "HUNG"
OUTCOMES = (REFUSED, SAME, ACCEPTED, UNCLEAR, CRASHED, HUNG)


def flip(start, stop):
    """Return a function that flips one bit between two places, given as parts of the file."""

    def damage(path, rng, others):
        content = bytearray(path.read_bytes())
        place = rng.randrange(int(start * len(content)), int(stop * len(content)))
        content[place] ^= 1 << rng.randrange(8)
        path.write_bytes(content)

    return damage


def zero_block(path, rng, others):
    """Overwrite 512 bytes by zeros, as a lost sector does."""
    content = bytearray(path.read_bytes())
    place = rng.randrange(len(content) - 512)
    content[place : place + 512] = bytes(512)
    path.write_bytes(content)


def truncate(path, rng, others):
    """Cut the file at a random place."""
    os.truncate(path, rng.randrange(1, path.stat().st_size))


def append(path, rng, others):
    """Append some bytes."""
    path.write_bytes(path.read_bytes() + rng.randbytes(rng.randrange(1, 200)))


def empty(path, rng, others):
    """Keep nothing."""
    path.write_bytes(b"")


def remove(path, rng, others):
    """Delete the file."""
    path.unlink()


def folder(path, rng, others):
    """Put a folder in its place."""
    path.unlink()
    path.mkdir()


def forbid(path, rng, others):
    """Take the permission to read, which the superuser has nevertheless."""
    path.chmod(0)


def nan(path, rng, others):
    """Let another program write what is not a number, or one more where numbers are counts."""
    with netCDF4.Dataset(path, "r+") as file:
        numeric = [v for v in file.variables.values() if v.dtype is not str]
        variable = rng.choice(numeric)
        variable[:] = variable[:] + (np.nan if variable.dtype.kind == "f" else 1)


def attribute(path, rng, others):
    """Let another program change the provenance."""
    with netCDF4.Dataset(path, "r+") as file:
        file.history = file.history.replace("seed=", "seed=1")


def rewrite(path, data):
    """Write a dataset in the place of an artifact with another program."""
    path.unlink()
    data.drop_encoding().to_netcdf(path)


def drop_variable(path, rng, others):
    """Let another program delete a variable."""
    data = xr.load_dataset(path, decode_times=False)
    rewrite(path, data.drop_vars(rng.choice(sorted(data.variables))))


def shorten(path, rng, others):
    """Let another program delete the last values along a dimension, or a scalar."""
    data = xr.load_dataset(path, decode_times=False)
    if not data.sizes:
        return drop_variable(path, rng, others)
    return rewrite(path, data.isel({rng.choice(sorted(data.sizes)): slice(-1)}))


def swap(path, rng, others):
    """Put another artifact in its place."""
    path.write_bytes(rng.choice([other for other in others if other != path]).read_bytes())


def foreign(path, rng, others):
    """Put another netCDF file in its place."""
    rewrite(path, xr.Dataset({"q": ("time", [1.0, 2.0])}))


DAMAGES = {
    "bit flipped, head": flip(0, 0.01),
    "bit flipped, attributes": flip(0.01, 0.4),
    "bit flipped, anywhere": flip(0, 1),
    "bit flipped, end": flip(0.98, 1),
    "block of zeros": zero_block,
    "truncated": truncate,
    "bytes appended": append,
    "empty": empty,
    "missing": remove,
    "a folder": folder,
    "not readable": forbid,
    "NaN or another count": nan,
    "another seed in the history": attribute,
    "variable deleted": drop_variable,
    "dimension shortened": shorten,
    "another artifact": swap,
    "foreign netCDF": foreign,
}


def apart(function, *arguments):
    """Call a function in a process of its own; return its outcome."""
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=lambda: sender.send(function(*arguments)))
    process.start()
    sender.close()
    try:
        return receiver.recv() if receiver.poll(LONGEST) else HUNG
    except EOFError:
        return CRASHED
    finally:
        process.kill()
        process.join()


def outcome(path, original):
    """Read a file as a rule does, and compare with what was written."""
    try:
        found = artifact.read(path)
    except ArtifactError as error:
        line = str(error)
        clear = str(path) in line and "run snakemake" in line and "\n" not in line
        return REFUSED if clear else UNCLEAR
    return SAME if found.identical(original) else ACCEPTED


def damaged(results):
    """Damage every artifact in every way; count the outcomes for each."""
    rng = random.Random(SEED)
    others = sorted(results.rglob("*.nc"))
    counts = {kind: collections.Counter() for kind in DAMAGES}
    for path in others:
        good, original = path.read_bytes(), artifact.read(path)
        for kind, damage in DAMAGES.items():
            damage(path, rng, others)
            counts[kind][apart(outcome, path, original)] += 1
            if path.is_dir():
                path.rmdir()
            path.unlink(missing_ok=True)
            path.write_bytes(good)
    return counts


def write_again(path, dataset, times):
    """Write a dataset again and again."""
    for _ in range(times):
        artifact.write(dataset, path, "again")


def killed(path):
    """Kill a process while it writes; the file is that of before or the new one."""
    rng = random.Random(SEED)
    counts = collections.Counter()
    old = artifact.read(path)
    artifact.write(old, path, "again")
    whole = artifact.read(path)
    for _ in range(KILLS):
        process = multiprocessing.get_context("fork").Process(
            target=write_again, args=(path, old, 10**6)
        )
        process.start()
        time.sleep(rng.uniform(0.02, 0.1))
        os.kill(process.pid, signal.SIGKILL)
        process.join()
        counts[outcome(path, whole)] += 1
    artifact.write(old, path, "again")
    counts[outcome(path, whole)] += 1
    for partial in path.parent.glob(".*"):  # of killed processes; nobody reads them
        partial.unlink()
    return counts


def limited(path, dataset, size):
    """Write with a limit on the size of files."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    try:
        artifact.write(dataset, path, "again")
    except ArtifactError as error:
        line = str(error)
        return REFUSED if "\n" not in line and "cannot write" in line else UNCLEAR
    return SAME


def full(path):
    """Let writing fail after some bytes; the file of before stays, and nothing else."""
    counts = collections.Counter()
    original, good = artifact.read(path), path.read_bytes()
    for size in np.linspace(0, len(good) - 1, 30, dtype=int):
        found = apart(limited, path, original, int(size))
        left = [p for p in path.parent.iterdir() if p.name.startswith(".")]
        whole = path.read_bytes() == good and not left
        counts[found if whole else ACCEPTED] += 1
    return counts


def main():
    """Damage, disturb, count, print."""
    source = Path(sys.argv[1] if len(sys.argv) > 1 else "results/smoke")
    if not list(source.rglob("*.nc")):
        sys.exit(f"error: {source} has no artifacts; run make smoke")
    with tempfile.TemporaryDirectory() as place:
        results = Path(place) / "results"
        shutil.copytree(source, results)
        counts = damaged(results)
        first = min(results.rglob("*.nc"))
        counts["killed while writing"] = killed(first)
        counts["stopped while writing"] = full(first)
    print(f"{'':30}" + "".join(f"{name:>13}" for name in OUTCOMES))
    for kind, count in counts.items():
        print(f"{kind:30}" + "".join(f"{count[name]:13}" for name in OUTCOMES))
    total = sum(counts.values(), collections.Counter())
    print(f"{'all':30}" + "".join(f"{total[name]:13}" for name in OUTCOMES))
    wrong = total.total() - total[REFUSED] - total[SAME]
    if wrong:
        sys.exit(f"error: {wrong} of {total.total()} were neither refused nor harmless")


if __name__ == "__main__":
    main()
