"""Paths and their moments: `simulate`."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import xarray as xr

from nonsmooth import strang as splitting
from nonsmooth.errors import SceneError
from nonsmooth.kernels import kernel
from nonsmooth.models import STATE_VARIABLES
from nonsmooth.streams import blocks, generator
from nonsmooth.times import equal_steps


@kernel
def _march(rng, s, state, integral, steps):
    """Advance every path by `steps` steps; `integral` gains the trapezoidal integral of g."""
    for i in range(state.shape[1]):
        zeta, eta, y, x = state[0, i], state[1, i], state[2, i], state[3, i]
        total = 0.0
        before = splitting.observe(s, zeta, eta, y, x)
        for _ in range(steps):
            kick = splitting.increments(s, rng)
            zeta, eta, y, x = splitting.advance(s, zeta, eta, y, x, kick)
            after = splitting.observe(s, zeta, eta, y, x)
            total += before + after
            before = after
        state[0, i], state[1, i], state[2, i], state[3, i] = zeta, eta, y, x
        integral[i] += 0.5 * s.step * total


@kernel
def _march_pair(rng, fine, coarse, state, integral, steps):
    """As `_march`, for a coarse path (row 0) and a fine path (row 1) on the same noise."""
    for i in range(state.shape[2]):
        a, b, c, d = state[0, 0, i], state[0, 1, i], state[0, 2, i], state[0, 3, i]
        zeta, eta, y, x = state[1, 0, i], state[1, 1, i], state[1, 2, i], state[1, 3, i]
        g_coarse = splitting.observe(coarse, a, b, c, d)
        g_fine = splitting.observe(fine, zeta, eta, y, x)
        for _ in range(steps):
            early = splitting.increments(fine, rng)
            late = splitting.increments(fine, rng)
            for kick in (early, late):
                zeta, eta, y, x = splitting.advance(fine, zeta, eta, y, x, kick)
                after = splitting.observe(fine, zeta, eta, y, x)
                integral[1, i] += 0.5 * fine.step * (g_fine + after)
                g_fine = after
            kick = splitting.join(fine, early, late)
            a, b, c, d = splitting.advance(coarse, a, b, c, d, kick)
            after = splitting.observe(coarse, a, b, c, d)
            integral[0, i] += 0.5 * coarse.step * (g_coarse + after)
            g_coarse = after
        state[0, 0, i], state[0, 1, i], state[0, 2, i], state[0, 3, i] = a, b, c, d
        state[1, 0, i], state[1, 1, i], state[1, 2, i], state[1, 3, i] = zeta, eta, y, x


def initial_state(scene, paths):
    """Return the starting values, shape (4, paths), in the order zeta, eta, y, x."""
    start = [scene.start.get(symbol.name, 0.0) for symbol in STATE_VARIABLES]
    return np.repeat(np.array(start, dtype=float)[:, None], paths, axis=1)


def parallel(work, jobs, threads=None):
    """Map `work` over `jobs` on `threads` threads (default: all cores); results in order."""
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        return list(pool.map(work, jobs))


def simulate(
    scene,
    horizon,
    step,
    paths,
    seed,
    times=None,
    keep="moments",
    first_path=0,
    threads=None,
):
    """Simulate a scene.

    Parameters
    ----------
    scene : Scene
    horizon : float
        Final time, "1".
    step : float
        Longest time step, "1".
    paths : int
        Number of paths.
    seed : int or tuple
        The same seed gives the same bits whatever the number of threads.
    times : array_like, shape (k,), optional
        Increasing output times in (0, horizon]; 200 equidistant ones unless given.
    keep : {"moments", "paths"}
        Whether to return statistics, in O(1) memory, or the paths at the output times.
    first_path : int
        Number of the first path of this part of the ensemble, a multiple of the block size.
    threads : int, optional
        All cores unless given.

    Returns
    -------
    xarray.Dataset
        ``"moments"``: `power_sum` (power, time), the sums over the paths of the powers 0 to 4
        of Delta(t) = int_0^t g. ``"paths"``: the variables of the scene's state and `delta`,
        each (path, time), time 0 included.

    Raises
    ------
    SceneError
        If a parameter is out of range.
    """
    if keep not in ("moments", "paths"):
        raise SceneError(f"cannot keep {keep!r}; choose 'moments' or 'paths'")
    times = _output_times(horizon, times)
    require_positive("step", step)
    require_positive("paths", paths)
    grid = equal_steps(times, step)
    schemes = [splitting.strang(scene, h) for _, h in grid]
    state_rows = [i for i, symbol in enumerate(STATE_VARIABLES) if symbol.name in scene.state]
    power = np.arange(5)

    def run(job):
        block, count = job
        rng = generator(scene, seed, block)
        state, delta = initial_state(scene, count), np.zeros(count)
        history = [np.vstack([state[state_rows], delta])] if keep == "paths" else []
        for (steps, _), scheme in zip(grid, schemes, strict=True):
            _march(rng, scheme, state, delta, steps)
            if keep == "paths":
                history.append(np.vstack([state[state_rows], delta]))
            else:
                with np.errstate(over="ignore", invalid="ignore"):  # refused below
                    history.append(np.sum(delta ** power[:, None], axis=1))
        return np.array(history)

    results = parallel(run, blocks(first_path, paths), threads)
    require_finite(results)
    if keep == "moments":
        return power_sums(sum(results), times)
    stacked = np.concatenate(results, axis=2)
    names = [*scene.state, "delta"]
    return xr.Dataset(
        {name: (("path", "time"), stacked[:, i].T) for i, name in enumerate(names)},
        coords={"time": np.concatenate([[0.0], times])},
    )


def require_finite(results):
    """Refuse results of paths that left every bound.

    Raises
    ------
    SceneError
    """
    if not all(np.all(np.isfinite(result)) for result in results):
        raise SceneError(
            "the simulation diverged: the drift is not confining or too steep for the step; "
            "mend the potentials or choose a smaller step"
        )


def step_bias(scene, horizon, step, paths, seed, times=None, threads=None):
    """Estimate what halving the time step changes in E[Delta(t)^2].

    Both step lengths run on the same Brownian paths, so that the difference has little variance.

    Parameters
    ----------
    scene, horizon, step, paths, seed, times, threads
        As for `simulate`; `step` is the longer of the two steps.

    Returns
    -------
    xarray.Dataset
        `power_sum` (power, time): sums over the paths of the powers 0 to 2 of
        Delta_h(t)^2 - Delta_{h/2}(t)^2.
    """
    times = _output_times(horizon, times)
    grid = equal_steps(times, step)
    schemes = [(splitting.strang(scene, h / 2), splitting.strang(scene, h)) for _, h in grid]
    power = np.arange(3)

    def run(job):
        block, count = job
        rng = generator(scene, seed, block)
        state, delta = np.stack([initial_state(scene, count)] * 2), np.zeros((2, count))
        history = []
        for (steps, _), (fine, coarse) in zip(grid, schemes, strict=True):
            _march_pair(rng, fine, coarse, state, delta, steps)
            history.append(np.sum((delta[0] ** 2 - delta[1] ** 2) ** power[:, None], axis=1))
        return np.array(history)

    results = parallel(run, blocks(0, paths), threads)
    require_finite(results)
    return power_sums(sum(results), times)


def power_sums(sums, times):
    """Wrap power sums, shape (time, power), into the dataset that shards are merged from."""
    return xr.Dataset(
        {"power_sum": (("power", "time"), sums.T)},
        coords={"power": np.arange(sums.shape[1]), "time": times},
    )


def central_moments(dataset):
    """Mean, variance and their standard errors from power sums.

    Returns
    -------
    dict
        Arrays over time: `mean`, `mean_error`, and if powers up to 4 are there `variance`
        (unbiased) and `variance_error`.
    """
    sums = dataset["power_sum"].values
    count = sums[0]
    raw = sums[1:] / count
    mean, second = raw[0], raw[1] - raw[0] ** 2
    result = {"mean": mean, "mean_error": np.sqrt(second / count)}
    if len(raw) == 4:
        fourth = raw[3] - 4 * mean * raw[2] + 6 * mean**2 * raw[1] - 3 * mean**4
        result["variance"] = second * count / (count - 1)
        result["variance_error"] = np.sqrt((fourth - second**2) / count)
    return result


def _output_times(horizon, times):
    require_positive("horizon", horizon)
    times = np.linspace(0, horizon, 201)[1:] if times is None else np.asarray(times, dtype=float)
    if not (np.all(np.diff(times) > 0) and times[0] > 0 and times[-1] <= horizon):
        raise SceneError("the output times must increase within (0, horizon]; sort them")
    return times


def require_positive(name, value):
    """Refuse what is not a positive finite number."""
    if not 0 < value < np.inf:
        raise SceneError(f"the simulation needs {name} > 0, got {value}; choose a positive number")
