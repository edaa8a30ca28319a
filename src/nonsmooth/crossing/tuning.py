"""The tuned numbers of the methods of this package."""

from dataclasses import dataclass


@dataclass(frozen=True)
class MethodChoice:
    """Times that predict which method meets a tolerance first; seconds are those of one core."""

    # seconds for a coarse step of a path of one and of two variables, everything included; fitted:
    # measured on one machine, the choices that follow are checked by benchmarks/requests.py
    seconds_of_step: tuple[float, float] = (4e-9, 1.1e-8)
    # seconds of the deterministic method for one and for two variables, for each factor `window`
    # between the first and the last time; fitted: as above
    seconds_solved: tuple[float, float] = (0.4, 8.0)
    # the same for one more threshold, over that of the first; fitted: measured on four scenes
    one_more: tuple[float, float] = (0.2, 0.6)
    window: float = 20.0
    # of the corrected formula, for one and two variables; fitted: as above
    seconds_corrected: tuple[float, float] = (0.05, 5.0)
    # least error of the corrected formula of the order 3, times p^2; fitted: as above
    least_corrected: float = 0.03
    # relaxation times from which on rounding, some 5e-15 each, keeps the solver from 1e-7; fitted:
    # friction, n = 100
    rounded: float = 1e7
    # error of the order 1 for two variables, times p, above which it is tried; fitted: below 2 for
    # the models at unit damping, b = 0.5 or 1
    first_order: float = 10.0
    # part of the solver's time that a pilot may cost; chosen: small, as it may be in vain
    pilot_share: float = 0.1
    # tolerance and steps up to which Monte Carlo replaces a solver that fails; chosen: minutes
    sampled_tolerance: float = 1e-4
    sampled_steps: float = 1e11
    # steps up to which paths are counted without more ado, times 1/C_b if that is above 1; chosen:
    # a second or two of one core, several times what the fit of a guide takes
    counted_steps: float = 5e8
    # of paths that are led to a threshold: what a step takes, over what one takes that is counted;
    # the error of a path over the probability; and how many led steps take as long as the fits at
    # C_b = 1; fitted: nine scenes at p = 10 and 100, where they are 1.0 to 2.2, 0.3 to 2.0 (in the
    # middle 0.6), and 4e7 to 1e8
    dearer: float = 2.0
    spread_led: float = 1.0
    fitted_steps: float = 1e8


@dataclass(frozen=True)
class Centred:
    """The largest |E g| that counts as 0 for the asymptotic formula."""

    relative: float = 1e-8  # over gamma; chosen: above rounding of E g
    uncertainties: float = 5.0  # if E g is sampled; chosen: a false alarm in two million runs


@dataclass(frozen=True)
class LimitError:
    """The distance of the limit to a finite p."""

    kappa: float = (
        0.3  # error wanted of kappa over gamma with two and more variables; chosen: quick
    )


@dataclass(frozen=True)
class BrownianSeries:
    """The two series of Brownian crossing, each used where none of its terms cancel."""

    # the odd modes; derived: the next is exp(-(33^2 - 1) z) of the first where L = 10 sqrt(T)
    modes: range = range(1, 33, 2)
    # derived: the next is exp(-(11^2 - 1) / 2) of the first where near = far = sqrt(T)
    images: range = range(5)
    images_from: float = 100.0  # L^2 / T from which images serve; derived: their sum is rounding
    reach: float = 100.0  # in sqrt(T); derived: exp(-5000), the chance to get there, is 0 in double
    exit_modes: range = range(1, 9)  # derived: the next is below exp(-300) for T > L^2
    exit_turns: int = 8  # derived: the next is below exp(-100) for T < L^2
    rounding: float = 4e-16  # of the asymptotic formula; derived: two units in the last place of 1


@dataclass(frozen=True)
class RandomClock:
    """The mean over the random clock."""

    reach: float = 8.2  # standard deviations; derived: 1e-15 of the law is left beyond
    # of the trapezoidal rule; chosen: exact to rounding for what is smooth and 0 at both ends
    nodes: int = 80


@dataclass(frozen=True)
class Orders:
    """The orders of the corrected formula where the expansion is not small."""

    # order 1 takes over where the layer is thicker than the distance to the threshold divided by
    # this; fitted: errors of scenes of one variable, tests/nonsmooth/crossing/test_expansion.py and
    # test_corrected_formula.py
    thin: float = 2.0
    # largest distance of order 2 from order 3, over that of order 1; fitted: as above
    nearer: float = 0.5
    # slopes of the rate of passage are taken only where it is above exp(-300); chosen: there it is
    # far above underflow
    deepest: float = 300.0
    # relative, of difference quotients; chosen: their error, about its square, is 1e-8 of a
    # correction
    step: float = 1e-4


@dataclass(frozen=True)
class Drift:
    """Brownian motion with a drift, in the corrected formula of order 1."""

    nodes: int = 100  # chosen: of Gauss, on the logarithm of the time
    deepest: float = 700.0  # derived: before, the passage has a probability below exp(-700), ...
    largest: float = 700.0  # derived: ... and a weight above exp(700) overflows


@dataclass(frozen=True)
class CorrectedError:
    """The stated error of the corrected formula, see `corrected_formula`."""

    # a and c for the highest known orders 1, 2 and 3; fitted: errors of a hundred scenes and
    # intervals of one variable, with a margin
    next_order: tuple[tuple[float, float], ...] = ((1.0, 0.0), (0.3, 2.0), (0.6, 2.0))
    # the factor a for order 1 where it takes over because the layer is thick; fitted: as above
    thick: float = 1.3
    # R is at most the first number plus the second times log(1 + 2 m / b); fitted: as above
    longest: tuple[float, float] = (1.5, 2.0)
    drift: float = 2.0  # factor of X; fitted: errors of forty random scenes of one variable
    at_once: float = 1e-9  # derived: part of the first time, in which nothing crosses
    lasting: float = 2.0  # chosen: the error from then on, over what the formula says has crossed
    # part of a tolerance that the error of kappa may take; and an error of kappa of two variables
    # that costs much less than the usual one; chosen
    share_of_kappa: float = 0.2
    loose_kappa: float = 1e-2
    rounding: float = 1e-15  # of every value; derived: some units in the last place of 1


@dataclass(frozen=True)
class Counting:
    """Sizes of the pilots and runs that count paths."""

    # chosen: level of the confidence limits of the probability, that of three standard errors
    confidence: float = 0.997
    # chosen: paths of the pilot, over the inverse of the tolerance. If one path crosses with one
    # step but not with the other, the measured bias is then about an eighth of the tolerance
    pilot: float = 12.0
    # fitted: upper limit at that level, in paths, where none has crossed
    skew: float = 5.1
    # chosen: to be careful, a probability that few paths tell may raise their number by this factor
    enlarge: float = 8
    # derived: work including the measurement of the bias, over that of the paths alone: an eighth
    # of the paths is run again with the step and with its half, which is 3/8
    checked: float = 1 + 3 / 8
    # chosen: largest number of runs, each with a shorter step; as a rule one is enough
    attempts: int = 3
    # chosen: share of paths that reach a threshold within the first step, from which on it is near
    at_once: float = 0.01
    nearer: float = 0.25  # chosen: the pilot's step is then so many times as long, ...
    pilot_steps: float = 1e9  # chosen: ... unless it takes more steps of paths than these
    # chosen: below 0.25 and 0.22, those of Brownian motion that is integrated once and twice
    order_at_once: float = 0.2


@dataclass(frozen=True)
class Weights:
    """Importance sampling: how guides are fitted, and which weighted sums are trusted."""

    relative: float = 0.1  # chosen: error wanted over the probability, where no tolerance is given
    fitted: int = 4000  # chosen: paths of a fit; a guide has up to fifty coefficients
    first: int = 4000  # chosen: least number of paths of a sample
    # chosen: numbers of equal parts of the way to a level by which guides to it are fitted
    ladder: tuple[int, ...] = (1, 2, 4, 8, 16)
    # chosen: fits at the level itself after the first one there, at most, and by how much the
    # effective number of paths must grow for another one
    repeated: int = 3
    improved: float = 1.2
    even: float = 0.25  # chosen: effective part of the paths from which one fit is enough
    # chosen: least effective number of paths of a fit, a few for each coefficient
    led: float = 50.0
    # derived: order in the step of the crossings that are missed where the noise drives g itself
    rough_order: float = 1.25
    # chosen: most paths that measure the bias of the step, over those of the estimate
    most_halved: int = 16
    # chosen: least effective number of paths of an estimate; the largest weight is then at most a
    # tenth of the sum, and the standard error known to ten per cent or so
    least: float = 100.0
    # chosen: a guide also serves earlier horizons with at most so many times its relative error
    worse: float = 2.0
    # chosen: probabilities that are not told from 0 if no tolerance is given
    negligible: float = 1e-14
    # chosen: probability of one side over the other, both in the Brownian limit, below which no
    # paths are led there; those that come by chance are counted
    other_side: float = 1e-6


METHOD_CHOICE = MethodChoice()
CENTRED = Centred()
LIMIT_ERROR = LimitError()
BROWNIAN_SERIES = BrownianSeries()
RANDOM_CLOCK = RandomClock()
ORDERS = Orders()
DRIFT = Drift()
CORRECTED_ERROR = CorrectedError()
COUNTING = Counting()
WEIGHTS = Weights()
