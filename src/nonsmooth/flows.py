"""Exact flows of the piecewise-linear parts of the equations of motion.

They are exact for every penalization, infinity included, which makes every splitting built
on them stable for every n at every step.
"""

import math

from nonsmooth.kernels import inlined, kernel


@kernel
def _relaxation(z, t, rate, drive):
    """Value at time t of z' = drive - rate z."""
    if rate == 0.0:
        return z + drive * t
    return z * math.exp(-rate * t) - drive * math.expm1(-rate * t) / rate


@kernel
def _arrival(z, target, rate, drive):
    """Time at which z' = drive - rate z reaches a target that lies on its way."""
    if rate == 0.0:
        return (target - z) / drive
    return math.log1p(rate * (target - z) / (drive - rate * target)) / rate


@inlined
def penalised(z, t, drive, rate, knot, inner, outer):
    """Flow of z' = drive - rate z - phi_n'(z) over a time t.

    phi_n' is odd with slope `inner` up to `knot` and `outer` beyond. The right-hand side is
    continuous and decreasing in z, so that z moves monotonically through at most three pieces.
    """
    if rate + outer == 0.0 and abs(z) > knot:
        # the commonest case, dry friction in slip, is worth a short cut: constant speed
        end = (z + drive * t) - math.copysign((inner - outer) * knot * t, z)
        if end * z > 0.0 and abs(end) >= knot:
            return end
    return _through_the_pieces(z, t, drive, rate, knot, inner, outer)


@kernel
def _through_the_pieces(z, t, drive, rate, knot, inner, outer):
    if not math.isfinite(z + t + drive):
        return math.nan
    jump = (inner - outer) * knot
    while True:
        if z > knot or (z == knot and drive - rate * knot > inner * knot):
            side, r, b = 1.0, rate + outer, drive - jump
        elif z < -knot or (z == -knot and drive + rate * knot < -inner * knot):
            side, r, b = -1.0, rate + outer, drive + jump
        else:
            side, r, b = 0.0, rate + inner, drive
        end = _relaxation(z, t, r, b)
        if side > 0.0:
            if end >= knot:
                return end
            target = knot
        elif side < 0.0:
            if end <= -knot:
                return end
            target = -knot
        else:
            if abs(end) <= knot:
                return end
            target = math.copysign(knot, end)
        t -= _arrival(z, target, r, b)
        z = target
        if t <= 0.0:
            return z


@kernel
def dry_friction(z, t, drive, rate):
    """Flow of z' in drive - rate z - Sgn(z) over a time t: sticks at 0 while |drive| <= 1."""
    if not math.isfinite(z + t + drive):
        return math.nan
    while True:
        if z == 0.0:
            if abs(drive) <= 1.0:
                return 0.0
            side = math.copysign(1.0, drive)
        else:
            side = math.copysign(1.0, z)
        end = _relaxation(z, t, rate, drive - side)
        if end * side >= 0.0:
            return end
        t -= _arrival(z, 0.0, rate, drive - side)
        z = 0.0
        if t <= 0.0:
            return z


@kernel
def confined(z, t, drive):
    """Flow of z' = drive reflected in the sense of Skorokhod: the projection on [-1, 1]."""
    return min(1.0, max(-1.0, z + drive * t))


@kernel
def spring_contact(y, x, t, n):
    """Flow of x' = y, y' = -n (x - proj x): free flight between two elastic walls at x = +-1."""
    omega = math.sqrt(n)
    speed = math.hypot(y, omega * max(abs(x) - 1.0, 0.0))
    if speed == 0.0 or not math.isfinite(speed):
        return y, x
    # two flights and two contacts bring every orbit back to where it was
    t %= 4.0 / speed + 2.0 * math.pi / omega
    while True:
        side = math.copysign(1.0, x)
        depth, inward = side * x - 1.0, -side * y
        if depth > 0.0 or (depth == 0.0 and inward < 0.0):
            phase = math.atan2(-inward / omega, depth) + math.pi / 2
            amplitude = math.hypot(depth, inward / omega)
            if phase >= omega * t:
                angle = omega * t - phase
                x = side * (1.0 - amplitude * math.sin(angle))
                y = -side * omega * amplitude * math.cos(angle)
                return y, x
            t -= phase / omega
            x, y = side, -side * omega * amplitude
        wall = math.copysign(1.0, y)
        flight = (wall - x) / y
        if flight >= t:
            return y, x + y * t
        t -= flight
        x = wall


@kernel
def elastic_impact(y, x, t):
    """Flow of x' = y on [-1, 1] with y -> -y at the walls: a straight line, folded."""
    straight = x + y * t
    folds = math.floor((straight + 1.0) / 2.0)
    x = straight - 2.0 * folds
    if folds % 2.0 == 0.0:
        return y, x
    return -y, -x
