"""Numbers with a bound on their rounding error, for formulas as Python computes them."""

import math
from dataclasses import dataclass

# of an operation: numbers are printed with 15 digits when a formula is compiled, and the
# functions of C libraries are right to four units in the last place
UNIT = 5e-15 + 4 * 2**-52


@dataclass(frozen=True)
class Rounded:
    """A number and a bound on its error, to first order."""

    value: float
    error: float = 0.0

    @classmethod
    def of(cls, number):
        """Take a number as it stands, printed with 15 digits."""
        return number if isinstance(number, Rounded) else cls(number, UNIT * abs(number))

    @classmethod
    def computed(cls, value, error, size=None):
        """Add the rounding of an operation; sums are rounded by the size of their terms."""
        if not abs(value) < 1e100 or not error < 1e90:
            raise OverflowError
        return cls(value, error + UNIT * abs(value if size is None else size))

    def __add__(self, other):
        """Terms may be added in another order."""
        other = Rounded.of(other)
        size = abs(self.value) + abs(other.value)
        return Rounded.computed(self.value + other.value, self.error + other.error, size)

    def __neg__(self):
        """Exact."""
        return Rounded(-self.value, self.error)

    def __pos__(self):
        """Exact."""
        return self

    def __sub__(self, other):
        """As a sum."""
        return self + -Rounded.of(other)

    def __rsub__(self, other):
        """As a sum."""
        return -self + other

    def __mul__(self, other):
        """Relative errors add."""
        a, b = self, Rounded.of(other)
        error = abs(a.value) * b.error + (abs(b.value) + b.error) * a.error
        return Rounded.computed(a.value * b.value, error)

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, other):
        """Divide by a number that is known not to be 0."""
        return self * Rounded.of(other) ** -1

    def __rtruediv__(self, other):
        """Divide by this number."""
        return Rounded.of(other) * self**-1

    def __pow__(self, other):
        """Powers of a base whose sign is known."""
        a, b = self, Rounded.of(other)
        exact = float(b.value).is_integer() and b.value > 0 and not isinstance(other, Rounded)
        if not exact and abs(a.value) <= 2 * a.error:
            raise ArithmeticError
        value = math.pow(a.value, b.value)
        if exact:
            error = b.value * (abs(a.value) + a.error) ** (b.value - 1) * a.error
        else:
            least = abs(a.value) - a.error
            error = (
                abs(value)
                * 2
                * (abs(b.value) * a.error / least + abs(math.log(abs(a.value))) * b.error)
            )
        return Rounded.computed(value, error)

    def __rpow__(self, other):
        """Powers of a number."""
        return Rounded.of(other) ** self


def _function(name, slope):
    """Return a function whose slope within an error of its argument is bounded."""

    def function(argument):
        a = Rounded.of(argument)
        return Rounded.computed(getattr(math, name)(a.value), slope(a.value, a.error) * a.error)

    return function


def _compare(choose):
    def function(*arguments):
        parts = [Rounded.of(a) for a in arguments]
        return Rounded(choose(a.value for a in parts), max(a.error for a in parts))

    return function


def _sign(argument):
    a = Rounded.of(argument)
    if 0 < abs(a.value) <= 4 * a.error or (a.value == 0 and a.error > 0):
        raise ArithmeticError  # the sign is not known
    return Rounded((a.value > 0) - (a.value < 0))


def _positive(name, slope):
    """Return a function of a number that is known to be positive."""
    plain = _function(name, slope)

    def function(argument):
        a = Rounded.of(argument)
        if a.value <= 2 * a.error:
            raise ArithmeticError
        return plain(a)

    return function


def _absolute(argument):
    a = Rounded.of(argument)
    return Rounded(abs(a.value), a.error)


FUNCTIONS = {
    "pi": math.pi,
    "abs": _absolute,
    "max": _compare(max),
    "min": _compare(min),
    "sign": _sign,
    "sqrt": _positive("sqrt", lambda a, e: 1 / math.sqrt(a - e)),
    "log": _positive("log", lambda a, e: 1 / (a - e)),
    "exp": _function("exp", lambda a, e: math.exp(a + e)),
    "sinh": _function("sinh", lambda a, e: math.cosh(abs(a) + e)),
    "cosh": _function("cosh", lambda a, e: math.cosh(abs(a) + e)),
    **{name: _function(name, lambda a, e: 1.0) for name in ("sin", "cos", "tanh", "atan")},
}
