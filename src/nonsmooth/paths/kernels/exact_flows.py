"""Exact flows of the piecewise-linear parts of the equations of motion, without branches.

They are exact for every penalization, infinity included, so that splittings built on them are
stable for every n at every step. Both sides of every choice are computed and one is selected, so
that loops over paths are turned into vector instructions.
"""

import math

import numpy as np

from nonsmooth.paths.kernels.compilation import inlined
from nonsmooth.paths.kernels.instructions import fma, like, maximum, minimum, where
from nonsmooth.paths.kernels.vector_math import arctan2, decay, expm1, log1p, sincos


@inlined
def _relaxed(t, rate, inverse):
    """(1 - exp(-rate t)) / rate: how far z' = -rate z goes in t per unit of initial speed."""
    return -expm1(-rate * t) * inverse


@inlined
def relax(z, t, drive, rate):
    """Flow of z' = drive - rate z over a time t."""
    rate = _nonzero(rate)
    return fma(drive - rate * z, _relaxed(t, rate, like(z, 1.0) / rate), z)


@inlined
def _nonzero(rate):
    """Replace a rate of 0, by which one cannot divide, by one too small to make a difference."""
    return maximum(rate, like(rate, 1e-15))


@inlined
def _arrival(gap, speed, rate, inverse):
    """Time to cover the distance `gap` with a speed that decays exponentially at `rate`.

    `speed` is the speed at the end of the gap. The time is infinite if that is not positive, since
    the motion then ends before, and 0 if the end has been passed already.
    """
    time = log1p(rate * gap / speed) * inverse
    zero = like(gap, 0.0)
    return where(gap > zero, where(speed > zero, time, like(gap, np.inf)), zero)


@inlined
def penalised(z, t, drive, rate, knot, inner, outer):
    """Flow of z' = drive - rate z - phi_n'(z) over a time t.

    phi_n' is odd with slope `inner` up to `knot` and `outer` beyond. The right-hand side is
    continuous and decreasing in z, so that z moves monotonically through at most three pieces.
    Within a piece the speed is calculated from that at a knot: where the slope is large, rounding
    of z would spoil it otherwise.
    """
    near, far = _nonzero(rate + inner), _nonzero(rate + outer)
    inverse_near, inverse_far = like(z, 1.0) / near, like(z, 1.0) / far
    within = minimum(maximum(z, -knot), knot)
    speed = drive - near * within - far * (z - within)
    side = math.copysign(like(z, 1.0), speed)
    z, drive = side * z, side * drive  # now it moves to the right
    first_speed, last_speed = fma(near, knot, drive), fma(-near, knot, drive)
    first = _arrival(-knot - z, first_speed, far, inverse_far)
    entry = maximum(z, -knot)
    last = first + _arrival(knot - entry, last_speed, near, inverse_near)
    before, between = t < first, t < last
    place = where(before, z, where(between, entry, maximum(z, knot)))
    left = t - where(before, like(z, 0.0), where(between, first, last))
    ahead = where(before, -knot, knot) - place
    inside = between & (not before)
    decay, inverse = where(inside, near, far), where(inside, inverse_near, inverse_far)
    speed = fma(decay, ahead, where(before, first_speed, last_speed))
    return side * fma(speed, _relaxed(left, decay, inverse), place)


@inlined
def yielding(z, t, drive, knot, outer):
    """Flow of z' = drive - phi_n'(z) over a time t, where phi_n' is 0 up to `knot`.

    This is `penalised` with `inner` and `rate` 0, with half of the operations, as the speed is
    constant between the knots.
    """
    zero, inverse = like(z, 0.0), like(z, 1.0) / outer
    side = math.copysign(like(z, 1.0), drive)
    z, speed = side * z, abs(drive)  # now it moves to the right
    per_speed = like(z, 1.0) / maximum(speed, like(z, 1e-30))
    entry, farther = maximum(z, -knot), maximum(z, knot)
    first = log1p(outer * (entry - z) * per_speed) * inverse
    last = fma(maximum(knot - entry, zero), per_speed, first)
    straight = minimum(fma(speed, t - first, entry), knot)
    behind = t < first
    place = where(behind, z, farther)
    beyond = where(behind, entry - z, knot - farther)
    left = where(behind, t, maximum(t - last, zero))
    bent = fma(fma(outer, beyond, speed), _relaxed(left, outer, inverse), place)
    return side * where(behind | (t > last), bent, straight)


@inlined
def at_rest(z, t, knot, inner):
    """Flow of z' = -phi_n'(z) for dry friction: constant speed 1, then exponential decay."""
    size = abs(z)
    late = maximum(t - maximum(size - knot, like(z, 0.0)), like(z, 0.0))
    return math.copysign(maximum(size - t, minimum(size, knot) * decay(inner * late)), z)


@inlined
def dry_friction(z, t, drive, rate):
    """Flow of z' in drive - rate z - Sgn(z) over a time t: sticks at 0 while |drive| <= 1."""
    one = like(z, 1.0)
    rate = _nonzero(rate)
    side, size = math.copysign(one, z), abs(z)
    speed = one - side * drive  # towards 0, on arrival there
    need = _arrival(size, speed, rate, one / rate)
    slips = t < need
    # the product is 0, but stays NaN for a path that has diverged, so that this is noticed
    place = where(slips, size, size * like(z, 0.0))
    slip = side * drive - minimum(maximum(side * drive, -one), one)
    outward = where(slips, -fma(rate, size, speed), slip)
    left = where(slips, t, t - need)
    return side * fma(outward, _relaxed(left, rate, one / rate), place)


@inlined
def confined(z, t, drive):
    """Flow of z' = drive reflected in the sense of Skorokhod: the projection on [-1, 1]."""
    return minimum(maximum(fma(drive, t, z), like(z, -1.0)), like(z, 1.0))


@inlined
def spring_contact(y, x, t, omega):
    """Flow of x' = y, y' = -omega^2 (x - proj x): free flight between two elastic walls.

    Every orbit is periodic: half a period is a flight from wall to wall, which takes 2/speed,
    and a contact, which takes pi/omega. The state is mapped to its time on the orbit and back.
    """
    zero, one, pi = like(x, 0.0), like(x, 1.0), like(x, math.pi)
    per_omega = one / omega
    side = math.copysign(one, where(abs(x) > one, x, y))
    depth = maximum(side * x - one, zero)
    bend = omega * depth
    speed = maximum(math.sqrt(fma(bend, bend, y * y)), like(x, 1e-18))
    per_speed = one / speed
    flight = like(x, 2.0) * per_speed
    in_contact = fma(arctan2(bend, side * y), per_omega, flight)
    phase = t + where(depth > zero, in_contact, (side * x + one) * per_speed)
    half = fma(pi, per_omega, flight)
    turns = np.floor(phase / half)
    phase = fma(-turns, half, phase)
    odd = turns - like(x, 2.0) * np.floor(turns * like(x, 0.5)) > zero
    sine, cosine = sincos(minimum(maximum(omega * (phase - flight), zero), pi))
    hits = phase > flight
    ahead = where(hits, fma(speed, sine * per_omega, one), fma(speed, phase, -one))
    along = where(hits, speed * cosine, speed)
    turned = where(odd, -side, side)
    straight = fma(y, t, x)
    free = (depth == zero) & (abs(straight) <= one)
    return where(free, y, turned * along), where(free, straight, turned * ahead)


@inlined
def elastic_impact(y, x, t):
    """Flow of x' = y on [-1, 1] with y -> -y at the walls: a straight line, folded."""
    one, two = like(x, 1.0), like(x, 2.0)
    straight = fma(y, t, x)
    folds = np.floor((straight + one) / two)
    folded = fma(-two, folds, straight)
    odd = folds - two * np.floor(folds / two) > like(x, 0.0)
    return where(odd, -y, y), where(odd, -folded, folded)
