"""Strong error of the Strang splitting: the same Brownian path with a step and with a fine one."""

import time

import numpy as np

from nonsmooth.errors import SceneError
from nonsmooth.paths.kernels.compilation import kernel
from nonsmooth.paths.kernels.panel import STATE, new_panel
from nonsmooth.paths.schemes import registry, strang
from nonsmooth.scenes.scene import Scene
from nonsmooth.scenes.symbols import STATE_VARIABLES


@kernel
def _follow(s, data, increments, row, kept):
    """Advance the lanes by whole steps, so that the state is known after each.

    The time loop of the library joins the end of a step with the beginning of the next.
    """
    lanes = increments.shape[1]
    for k in range(len(increments)):
        strang.flow(s, data, True, False, lanes)
        data[0, :lanes] = increments[k]
        strang.kick(s, data, 0, lanes)
        strang.flow(s, data, False, True, lanes)
        kept[k] = data[row, :lanes]


class BrownianPaths:
    """Brownian paths on which a scene can be followed with any step T / 2^k.

    Parameters
    ----------
    scene : Scene
        With white noise.
    horizon : float
        T, "1".
    doublings : int
        The finest step is T / 2^doublings.
    paths : int
        At most 1000.
    seed : int

    Raises
    ------
    SceneError
        If the noise is not white.
    """

    def __init__(self, scene: Scene, horizon: float, doublings: int, paths: int, seed: int) -> None:
        if scene.noise.kind != "white":
            raise SceneError("strong errors are measured for white noise; choose noise='white'")
        self.scene, self.horizon, self.doublings = scene, horizon, doublings
        fine = self._coefficients(doublings)
        draws = np.random.default_rng(seed).standard_normal((2**doublings, paths))
        self._known = {doublings: float(fine.factor[0]) * draws}
        self.reference, _ = self.follow(doublings)

    def _coefficients(self, level):
        return registry.coefficients(self.scene, "strang", self.horizon / 2**level, "float64")

    def _increments(self, level):
        """Gaussian increments of the steps, each made of those of two finer steps."""
        if level not in self._known:
            decay = float(self._coefficients(level + 1).transition[0])
            finer = self._increments(level + 1)
            early, late = finer[::2], finer[1::2]
            self._known[level] = early + decay * early + late
        return self._known[level]

    def follow(self, level: int) -> tuple[np.ndarray, float]:
        """Return the velocity under friction, otherwise the displacement, and the seconds.

        Parameters
        ----------
        level : int
            The step is T / 2^level.

        Returns
        -------
        kept : numpy.ndarray, shape (2^level, paths)
            After each step.
        seconds : float
        """
        s = registry.on_given_increments(self._coefficients(level))
        increments = self._increments(level)
        kept = np.empty(increments.shape)
        data = new_panel(self.scene, 0, 0, "float64").data
        began = time.perf_counter()
        _follow(
            s, data, increments, STATE[STATE_VARIABLES.index(self.scene.mechanics.argument)], kept
        )
        return kept, time.perf_counter() - began

    def error(self, level: int) -> tuple[float, float]:
        """Return the root mean square over the paths of sup_t |X_h(t) - X(t)|, and the seconds.

        The supremum is over the ends of the steps; X has the finest step.
        """
        kept, seconds = self.follow(level)
        apart = (
            kept
            - self.reference[2 ** (self.doublings - level) - 1 :: 2 ** (self.doublings - level)]
        )
        return float(np.sqrt(np.mean(np.max(np.abs(apart), axis=0) ** 2))), seconds
