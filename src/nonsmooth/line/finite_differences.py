"""The paper's finite-difference scheme (its appendix C), with the time indices corrected.

It is backward Euler in time and has centred differences in space on [-L, L], with one-sided
Neumann rows at the ends. The right-hand sides take W^{k-1} and V^{k-1}, where the paper prints the
index k; the source of V is (D W^k)^2. The scheme is of first order in time and, on a grid with
nodes on the kinks at +-1/n, of second order in space.
"""

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg.lapack import dgttrf, dgttrs

from nonsmooth.errors import SceneError
from nonsmooth.line import quadrature, tuning
from nonsmooth.scenes import symbols
from nonsmooth.scenes.formulas import vectorised
from nonsmooth.scenes.scene import Scene


def moments(
    scene: Scene, times: ArrayLike, half_width: float, nodes: int, time_step: float
) -> tuple[np.ndarray, np.ndarray]:
    """Solve eqs. (35) and (37) of the paper and return w and v at the starting point.

    Parameters
    ----------
    scene : Scene
        With state y, a finite n, and a starting point among the nodes.
    times : array_like, shape (t,)
        Output times, multiples of `time_step`.
    half_width : float
        L, "1".
    nodes : int
        N, odd, so that 0 is a node.
    time_step : float
        Delta t, "1".

    Returns
    -------
    w, v : numpy.ndarray, shape (t,)

    Raises
    ------
    SceneError
        If the scene has another state, or the grid does not fit.
    """
    y, lower, main, upper, source = system(scene, half_width, nodes, time_step)
    start = scene.start.get("y", 0.0)
    node = int(np.argmin(np.abs(y - start)))
    width = y[1] - y[0]
    if abs(y[node] - start) > 1e-9 * width:
        raise SceneError(
            f"the paper's scheme starts from a node, and y = {start:g} is none; change the grid"
        )
    outputs = np.rint(np.asarray(times) / time_step).astype(int)
    if not np.allclose(outputs * time_step, times, rtol=1e-9):
        raise SceneError("the output times are not multiples of the time step; change either")
    *factors, info = dgttrf(lower[1:], main, upper[:-1])
    if info:
        raise SceneError("the paper's scheme is singular on this grid; refine it")

    def solve(right):
        right[[0, -1]] = 0.0  # Neumann rows
        return dgttrs(*factors, right)[0]

    w, v, slope = np.zeros((3, nodes))
    history, gain = np.zeros((outputs[-1] + 1, 2)), np.zeros(2)
    for k in range(1, len(history)):
        before = w, v
        w = solve(source + w)
        slope[1:-1] = (w[2:] - w[:-2]) / (2 * width)
        v = solve(time_step * scene.noise.sigma**2 * slope**2 + v)
        history[k] = w[node], v[node]
        if k % tuning.FINITE_DIFFERENCES.look == 0 and _steady(
            time_step, w, w - before[0], v - before[1]
        ):
            gain = history[k] - history[k - 1]
            history[k:] = history[k] + np.arange(len(history) - k)[:, None] * gain
            break
    return history[outputs, 0], history[outputs, 1]


def _steady(time_step, w, change, gain):
    """Whether what w and v gain in a step will stay as it is.

    By the maximum principle later gains lie between the smallest and the largest of a step, once
    the slope of w, on which that of v depends, does not change.
    """
    steady = tuning.FINITE_DIFFERENCES.steady
    settled = np.ptp(change) <= steady * time_step * np.ptp(w)
    return settled and np.ptp(gain) <= steady * np.abs(gain).max()


def system(
    scene: Scene, half_width: float, nodes: int, time_step: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Assemble the matrix M_Dt and the source Dt G_i.

    Parameters
    ----------
    scene, half_width, nodes, time_step
        As for `moments`.

    Returns
    -------
    y : numpy.ndarray, shape (nodes,)
        The grid.
    lower, main, upper : numpy.ndarray, shape (nodes,)
        Row i of M_Dt has lower[i], main[i], upper[i]; lower[0] and upper[-1] are outside.
    source : numpy.ndarray, shape (nodes,)

    Raises
    ------
    SceneError
        If the scene has another state, no node is at 0, or the cell Peclet number is above 1.
    """
    if scene.state != ("y",):
        raise SceneError("the paper's scheme is one-dimensional; it takes the state (y)")
    if nodes % 2 == 0:
        raise SceneError(f"the paper's scheme needs an odd number of nodes, got {nodes}; add one")
    y = np.linspace(-half_width, half_width, nodes)
    width = y[1] - y[0]
    speed = -vectorised(scene.numerical_drift()[symbols.y], (symbols.y,))(y)
    peclet = np.max(np.abs(speed)) * width / scene.noise.sigma**2
    if not peclet <= 1:
        raise SceneError(
            f"the paper's scheme oscillates with {nodes} nodes: the cell Peclet number "
            f"|b| Delta y / sigma^2 reaches {peclet:.3g}, above 1; use more nodes"
        )
    diffusion = scene.noise.sigma**2 / width**2
    lower = -time_step / 2 * (diffusion + speed / width)
    upper = -time_step / 2 * (diffusion - speed / width)
    main = np.full(nodes, 1 + time_step * diffusion)
    main[[0, -1]] = 1 / width, -1 / width
    lower[-1], upper[0] = 1 / width, -1 / width
    return (
        y,
        lower,
        main,
        upper,
        time_step * vectorised(scene.numerical_observable(), (symbols.y,))(y),
    )


def moments_with_error(
    scene: Scene, times: ArrayLike, half_width: float, nodes: int, time_step: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return w, v and an error estimate of each.

    The problem is solved again with twice the time step, then with twice the mesh width, and then
    with twice the mesh width on half the domain. The scheme is of first order in time: the first
    difference is the leading term of the error. In space it is at least of first order, wherever
    the kinks lie: the second difference bounds the error. The error of the domain falls faster
    than exponentially with L once the domain holds nearly all of the stationary law: the third
    difference then bounds it, and where the domain does not, the scheme is refused. The sum of the
    differences is doubled to cover terms of higher order.

    Parameters
    ----------
    scene, times, half_width, nodes, time_step
        As for `moments`; `times` multiples of twice `time_step`, (nodes - 1)/8 an integer, the
        start within half of the domain.

    Returns
    -------
    w, v, w_error, v_error : numpy.ndarray, shape (t,)

    Raises
    ------
    SceneError
        As for `moments`, for each of the grids; or if the domain leaves out too much.
    """
    _require_wide(scene, half_width)
    fine = np.array(moments(scene, times, half_width, nodes, time_step))
    slow = np.array(moments(scene, times, half_width, nodes, 2 * time_step))
    wide = np.array(moments(scene, times, half_width, (nodes + 1) // 2, time_step))
    near = np.array(moments(scene, times, half_width / 2, (nodes + 3) // 4, time_step))
    error = 2 * (np.abs(slow - fine) + np.abs(wide - fine) + np.abs(near - wide))
    error += np.finfo(float).eps
    return (*fine, *error)


def _require_wide(scene, half_width):
    """Refuse a domain that leaves out too much of the stationary law or of the variance of g."""
    solution = quadrature.solved(scene).integrals
    elements = solution.elements
    outside = np.abs(elements.points) > half_width
    spread = elements.mass * (elements.g - solution.mean) ** 2
    # a constant g has no spread
    shares = [part[outside].sum() / part.sum() for part in (elements.mass, spread) if part.any()]
    if max(shares) > tuning.FINITE_DIFFERENCES.outside:
        raise SceneError(
            f"half_width = {half_width:g} leaves {max(shares):.0%} of the stationary law or of the "
            "variance of g outside, so that the error is not known; increase half_width"
        )
