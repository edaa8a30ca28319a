"""Instructions that Python has no name for, on numbers in kernels of either precision."""

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic


@intrinsic
def like(typing, x, constant):
    """Convert a constant to the type of x, so that it does not widen the arithmetic."""

    def generate(context, builder, signature, arguments):
        return context.cast(builder, arguments[1], signature.args[1], signature.args[0])

    return x(x, constant), generate


@intrinsic
def fma(typing, x, y, z):
    """Return x*y + z, rounded once."""

    def generate(context, builder, signature, arguments):
        return builder.fma(*arguments)

    return x(x, x, x), generate


@intrinsic
def where(typing, condition, x, y):
    """Return x where the condition holds, else y, having computed both."""

    def generate(context, builder, signature, arguments):
        return builder.select(*arguments)

    return x(types.boolean, x, x), generate


def _extremum(comparison, documentation):
    """Make a function of (x, y): y where `y comparison x` holds, else x; a single instruction."""

    @intrinsic
    def extremum(typing, x, y):
        def generate(context, builder, signature, arguments):
            first, second = arguments
            chosen = builder.fcmp_ordered(comparison, second, first)
            return builder.select(chosen, second, first)

        return x(x, x), generate

    extremum.__doc__ = documentation
    return extremum


maximum = _extremum(">", "The larger number; x if either is not a number.")
minimum = _extremum("<", "The smaller number; x if either is not a number.")


def _extreme_number(name, documentation):
    """Make a function of (x, y): the larger or smaller; if one is not a number, the other one.

    `maximum` and `minimum` give x if either is not a number. Unlike these, the function made here
    stays a single instruction also where its result replaces x in memory.
    """

    @intrinsic
    def extreme(typing, x, y):
        def generate(context, builder, signature, arguments):
            kind = arguments[0].type
            signature = ir.FunctionType(kind, [kind, kind])
            function = builder.module.declare_intrinsic(name, [kind], signature)
            return builder.call(function, arguments)

        return x(x, x), generate

    extreme.__doc__ = documentation
    return extreme


larger = _extreme_number("llvm.maxnum", "The larger number, the other if one is not a number.")
smaller = _extreme_number("llvm.minnum", "The smaller number, the other if one is not a number.")


@intrinsic
def bits(typing, x):
    """Return the bits of a number."""
    single = x == types.float32

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.IntType(32 if single else 64))

    return types.uint32(x) if single else types.uint64(types.float64), generate


@intrinsic
def from_bits(typing, x):
    """Return the number with the given bits."""
    single = x == types.uint32

    def generate(context, builder, signature, arguments):
        return builder.bitcast(arguments[0], ir.FloatType() if single else ir.DoubleType())

    return types.float32(x) if single else types.float64(types.uint64), generate


@intrinsic
def polynomial(typing, coefficients, x):
    """Evaluate a polynomial, highest coefficient first, by Estrin's scheme.

    Its terms wait for each other half as long as those of Horner's, which is what takes the time.
    """

    def generate(context, builder, signature, arguments):
        terms, power = cgutils.unpack_tuple(builder, arguments[0])[::-1], arguments[1]
        while len(terms) > 1:
            pairs = zip(terms[::2], terms[1::2], strict=False)
            left_over = terms[len(terms) - len(terms) % 2 :]
            terms = [builder.fma(high, power, low) for low, high in pairs] + left_over
            power = builder.fmul(power, power)
        return terms[0]

    return x(coefficients, x), generate
