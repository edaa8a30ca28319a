"""Scenes and numbers that several tests share, each number with where it comes from.

Every number is that of C_b = 1 and a white forcing of unit strength. Two independent computations
agreed on it before it was published in the manual, on the page that is named. gamma2 is the
asymptotic variance, kappa the extrapolation length and W the probability of a threshold crossing.
"""

from dataclasses import replace

import nonsmooth as ns

FALSE_ALARM = 1e-5  # the probability with which a correct sample fails a test

FRICTION = ns.Scene("friction", n=100)  # g = y
PLASTIC = ns.Scene("elasto_plastic", n=100, potential="x**2/2")  # g = y
OBSTACLE = ns.Scene("obstacle", n=100, potential="x**2/2", observable="x")
COLORED_FRICTION = ns.Scene("friction", "langevin")
PLASTIC_STRAIN = ns.Scene("elasto_plastic", potential="x**2/2", observable="plastic_strain_rate")
# dry friction with a g without symmetry, centred; 4e-16 is the error of the mean
SKEWED = ns.Scene("friction", observable="y + 0.3*abs(y) - 0.0958534263954079")
SKEWED_AND_STARTED = replace(SKEWED, start={"y": 0.2})
MIRRORED = ns.Scene("friction", observable="y - 0.3*abs(y) + 0.0958534263954079")  # -g(-y)

# of FRICTION and its limit n = inf: docs/methods/line.md
GAMMA2 = 0.137696412899501
GAMMA2_LIMIT = 0.137679199643661
# the first eigenvalue of -A of that limit, its digits cut off: docs/methods/line.md
LAMBDA_LIMIT = 2.53719
# of OBSTACLE, the last digit rounded: docs/methods/statistics.md
GAMMA2_OBSTACLE = 0.441883416
# of FRICTION, the last digit rounded: docs/methods/boundary_layer.md
KAPPA = 0.2911259630
# W of FRICTION by the scale p, for b = 0.6 and T = 2, and its limit for large p, the last digit
# rounded: docs/methods/first_passage.md
W = {1: 0.1606775, 10: 0.3674251, 100: 0.4595991, 1000: 0.4902812}
W_STAR = 0.5045888


def far(start, **parameters):
    """Dry friction that starts far out."""
    return ns.Scene("friction", start={"y": start}, **parameters)
