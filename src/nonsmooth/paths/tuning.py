"""Numbers that were chosen for the simulation, a record for each method.

Each number has a line that says what it is and where it comes from.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class MonteCarlo:
    """How a tolerance becomes a number of paths and a time step."""

    # chosen: default tolerance of Monte Carlo, one per cent, which a pilot and a short run reach
    tolerance: float = 1e-2
    # chosen: standard errors that must fit into the tolerance; one result in 370 is farther off
    sigmas: float = 3.0
    # derived: part of the tolerance that is left to the standard errors; the work is least with
    # this part if the bias falls like step^(3/2)
    spread_share: float = 0.75
    # chosen: part of the tolerance that the bias shall have, when the step is chosen from a pilot;
    # less than it may have, because the pilot knows the bias roughly
    bias_aim: float = 0.12
    # chosen: paths of a pilot, a small sample from which the number of paths and the step are
    # chosen; it knows a variance to two per cent
    pilot_paths: int = 4096
    # chosen: for so many paths one is simulated with the step and with half of it, to measure the
    # bias; this costs as much as three
    halved: int = 8
    # chosen: standard error of the bias over that of the moment, where fewer paths do; it adds an
    # eighth to both together
    bias_share: float = 0.5
    # chosen: largest number of samples, each with the paths and the step that the one before asks
    # for; two are enough as a rule
    attempts: int = 5
    # chosen: largest number of steps of all paths together, which take hours
    most_steps: float = 1e13
    # chosen: step of the first pilot in units of the smaller of 1 and 1/C_b; its bias is a few per
    # cent
    coarse_step: float = 0.1
    # chosen: least number of steps of a path of the first pilot
    least_steps: int = 32
    # chosen: largest relative bias of Var D at which halving the step measures it
    measurable: float = 0.2
    # chosen: the step of the first pilot is at most this part of the longest stable one
    stable_share: float = 0.25
    # derived: a variance that is smaller than this part of the mean square has lost all but six
    # digits by rounding
    resolved: float = 1e-10


MONTE_CARLO = MonteCarlo()


@dataclass(frozen=True)
class TimeGrid:
    """Steps of a simulation between its output times."""

    # chosen: least number of steps up to each output time, counted from 0, so that early times are
    # resolved as well as late ones
    first_steps: int = 16


TIME_GRID = TimeGrid()


@dataclass(frozen=True)
class ControlVariate:
    """Table of the slope of the Poisson solution, from which the control variate is made."""

    # chosen: number of equidistant points; the noise of a step is several spacings wide at the
    # shortest steps in use
    points: int = 4097
    # chosen: the table ends where the density is exp(-20) = 2e-9 of the largest
    depth: float = 20.0


CONTROL_VARIATE = ControlVariate()


@dataclass(frozen=True)
class StableStep:
    """Where the scheme `strang` looks for the largest U'' and the fastest rate of a noise."""

    # chosen: largest displacement looked at where there are no walls, a few units
    free: float = 5.0
    # chosen: how far to look beyond a wall, into which paths dive if n is finite
    beyond: float = 0.5
    # chosen: number of displacements looked at
    points: int = 401
    # chosen: largest value looked at of each of the noise's variables, a few standard deviations,
    # and the number of values
    noise: float = 3.0
    noise_points: int = 25
    # derived: longest stable step of U's kicks times the root of its largest second derivative
    kick: float = 2.0
    # derived: twice 2.8, the interval of stability of the classical Runge-Kutta half-flow
    runge_kutta: float = 5.6


STABLE_STEP = StableStep()


@dataclass(frozen=True)
class Cost:
    """How long a simulation takes, to an order of magnitude, and how long is too long."""

    # chosen: hours; a run that takes longer should be several runs whose results are kept
    longest_run: float = 100.0
    # fitted: seconds of one step of a block with hardly any paths, and of one step of one path more
    # by precision, all in the fastest scenes
    block_step: float = 5e-8
    path_step: Mapping[str, float] = field(
        default_factory=lambda: {"float32": 1e-9, "float64": 2.5e-9}
    )
    # chosen: largest number of steps of a path, beyond which their count is not exact
    most_steps: float = 1e15


COST = Cost()


@dataclass(frozen=True)
class Interruption:
    """How soon a simulation notices that it is to stop."""

    # chosen: seconds after which the time loop looks up from its work, or twice as many
    piece: float = 0.1
    look: float = 0.1  # chosen: seconds after which the bar is drawn anew


INTERRUPTION = Interruption()


@dataclass(frozen=True)
class Tilt:
    """The polynomials by which the noise is shifted towards a level, see `tilted.tilt`."""

    # chosen: largest degree for one to four state variables; the next ones explain less than one
    # per cent more of the variance of int g in the nine scenes of the paper
    degrees: tuple[int, int, int, int] = (7, 5, 3, 3)
    # chosen: of the polynomials that multiply higher powers of q
    higher_degree: int = 5
    # fitted: time added to what is left, because noise has no time to act just before the end
    pause: float = 0.3
    haste: float = 1.0  # chosen: rate at which the polynomial of the last moments comes in
    # fitted: bound of q, in units of 1/gamma, and in units of that of a straight way to the level
    least_cap: float = 1.3
    share: float = 1.0
    # fitted: largest theta, in units of gamma times the bound of q; more gives single paths large
    # weights
    bound: float = 1.25
    # fitted: time for which a shift is kept, in units of the coarsest step; with twice as much for
    # white noise, which moves the mechanical variables themselves, errors grow by a fifth
    kept: float = 1.0
    kept_white: float = 0.5


TILT = Tilt()


@dataclass(frozen=True)
class PoissonFit:
    """The fit of the Poisson solution, see `tilted.poisson`."""

    stretch: float = 10.0  # chosen: in units of the larger of 1 and 1/C_b, several relaxation times
    most_steps: int = 200_000  # chosen: of a stretch; then minutes
    stretches: int = 4  # chosen: of a thousand paths; their noise is below the polynomial's error
    margin: float = 1.3  # chosen: reach of the polynomials over the largest states seen
    singular: float = 1e-8  # chosen: singular values that count as 0, near single precision
    # chosen: part of the variance of int g that the martingale must explain
    least: float = 0.1


POISSON_FIT = PoissonFit()


@dataclass(frozen=True)
class Passages:
    """Paths that are dropped after they have crossed, see `absorption.passages`."""

    # chosen: times at which they are; a path that has crossed is followed a 64th of the way at most
    pieces: int = 64


PASSAGES = Passages()


@dataclass(frozen=True)
class CrossEntropy:
    """The fit of a guide to paths that have reached a level, see `tilted.cross_entropy`."""

    records: int = 120  # chosen: most steps of a path at which the fit looks
    look: float = 0.3  # chosen: time for which it looks, in which the state changes little
    # chosen: weight of the old guide, where few paths have come by, over that of the new one
    defence: float = 0.1
    # chosen: inverse variances of a coefficient a priori among which the evidence decides, in units
    # of what all paths tell of one; from full freedom to hardly any
    ridges: tuple[float, float, int] = (1e-4, 10.0, 26)


CROSS_ENTROPY = CrossEntropy()
