"""Tuned numbers of the simulation, with their origin."""

from dataclasses import dataclass


@dataclass(frozen=True)
class MonteCarlo:
    """How a tolerance becomes a number of paths and a time step."""

    # chosen: a percent, what pilots of thousands of paths and a short run after them reach
    tolerance: float = 1e-2
    # chosen: standard errors that must fit into the tolerance; one result in 400 misses it
    sigmas: float = 3.0
    # derived: part of the tolerance for them; the least work where the bias falls as step^(3/2)
    spread_share: float = 0.75
    # chosen: part of the tolerance at which the bias is aimed when a step is refined from a pilot
    bias_aim: float = 0.12
    # chosen: paths of a pilot, which knows a variance to two per cent
    pilot_paths: int = 4096
    # chosen: one in so many paths is run again with half the step, an eighth of the work and more
    halved: int = 8
    # chosen: pilots, each with the sizes that the last one asks for; two are enough as a rule
    attempts: int = 5
    # chosen: steps of all paths together, hours
    most_steps: float = 1e13
    # chosen: step of the first pilot, times the smaller of 1 and 1/C_b; its bias is a few per cent
    coarse_step: float = 0.1
    # chosen: steps at least in the time of the first pilot
    least_steps: int = 32
    # chosen: largest relative bias of Var D at which halving the step measures it
    measurable: float = 0.2
    # chosen: part of the step of the first pilot over the longest stable one
    stable_share: float = 0.25
    # derived: a variance over the mean square below which it has lost all but six digits
    resolved: float = 1e-10


MONTE_CARLO = MonteCarlo()


@dataclass(frozen=True)
class TimeGrid:
    """Steps of a simulation between its output times."""

    # chosen: steps at least up to the first output time, so that early times are resolved as well
    first_steps: int = 16


TIME_GRID = TimeGrid()


@dataclass(frozen=True)
class ControlVariate:
    """Table of the slope of the Poisson solution."""

    # chosen: equidistant points; a kick at the shortest steps used is several spacings
    points: int = 4097
    # chosen: the table ends where the density is exp(-20) = 2e-9 of the largest
    depth: float = 20.0


CONTROL_VARIATE = ControlVariate()


@dataclass(frozen=True)
class StableStep:
    """Where the scheme `strang` looks for the stiffest place of U and of a nonlinear noise."""

    # chosen: largest displacement without walls, a few units
    free: float = 5.0
    # chosen: how far beyond a wall at n = inf, which a finite n lets paths pass
    beyond: float = 0.5
    # chosen: points on that interval
    points: int = 401
    # chosen: values of the noise's variables looked at, and points on each axis
    noise: float = 3.0
    noise_points: int = 25
    # derived: longest stable step of U's kicks times the root of its largest second derivative
    kick: float = 2.0
    # derived: twice 2.8, the interval of stability of the classical Runge-Kutta half-flow
    runge_kutta: float = 5.6


STABLE_STEP = StableStep()
