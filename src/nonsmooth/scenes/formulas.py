"""Formulas given as text: one expression of arithmetic, kept symbolic, evaluated on arrays.

Text is never run. Python parses it to a syntax tree, of which only numbers, names, arithmetic and
calls of listed functions are read; each is replaced by the sympy expression that it means.
"""

import ast
import math
import operator
import re
from collections.abc import Callable, Collection, Iterable
from contextlib import contextmanager
from functools import lru_cache

import numpy as np
import sympy

from nonsmooth.errors import ExpressionError, quoted
from nonsmooth.scenes import tuning
from nonsmooth.scenes.constant_parts import (
    ConstantParts,
    evaluated,
    in_range,
    require_small_numbers,
)

FUNCTIONS = {
    "abs": sympy.Abs,
    "atan": sympy.atan,
    "cos": sympy.cos,
    "cosh": sympy.cosh,
    "exp": sympy.exp,
    "log": sympy.log,
    "max": sympy.Max,
    "min": sympy.Min,
    "sign": sympy.sign,
    "sin": sympy.sin,
    "sinh": sympy.sinh,
    "sqrt": sympy.sqrt,
    "tanh": sympy.tanh,
}
_OPERATIONS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}
# other signs, and what is written here
_WRITTEN = str.maketrans(
    {"^": "**", "²": "**2", "³": "**3", "·": "*", "×": "*", "−": "-", "η": "eta", "ζ": "zeta"}
    | {"π": "pi", "[": "(", "]": ")", "{": "(", "}": ")"}
)
# names from elsewhere, and what is written here
MEANT = {
    "velocity": "y",
    "displacement": "x",
    "position": "x",
    "deformation": "x",
    "ln": "log",
    "e": "exp",
    "sgn": "sign",
    "arctan": "atan",
    "fabs": "abs",
    "maximum": "max",
    "minimum": "min",
}
_COMPARED = ("max", "min")  # take two arguments or more, the other functions one
# sums and products without brackets are deep in the syntax tree, but flat in sympy's
_FLAT = (ast.Add, ast.Sub), (ast.Mult, ast.Div)
_FOREIGN = re.compile(r"[^A-Za-z0-9_+\-*/(). ,]")
_NUMBER = r"(?>(?:\d[\d_]*\.?[\d_]*|\.\d[\d_]*)(?:[eE][+-]?\d[\d_]*)?)"
_NUMBER_AND_NAME = re.compile(rf"(?<![\w.]){_NUMBER}[A-Za-z]\w*")
_EXAMPLE = "write arithmetic, for example x**2/2 + 0.3*cos(x)"
# sympy writes the derivatives of functions with these that may be complex
_NOT_FORMULAS = (sympy.Derivative, sympy.re, sympy.im, sympy.arg, sympy.atan2, sympy.conjugate)
_PART = 30  # characters of a part of a formula in a message, which has the formula already
EVEN, ODD, NEITHER = 1, -1, 0
_ODD_FUNCTIONS = (sympy.sin, sympy.sinh, sympy.tanh, sympy.atan, sympy.sign)
_EVEN_FUNCTIONS = (sympy.cos, sympy.cosh, sympy.Abs)
_TOO_DEEP = "it is nested too deeply; simplify it"


def parse(text: str, variables: Iterable[sympy.Symbol]) -> sympy.Expr:
    """Read a formula.

    Parameters
    ----------
    text : str
        One expression of numbers, the variables, ``+ - * / **``, parentheses, the functions of
        `FUNCTIONS` and the constant ``pi``, for example ``"x**2/2 + 0.3*cos(x)"``. Line breaks are
        white space.
    variables : iterable of sympy.Symbol
        The variables the formula may contain, all real.

    Returns
    -------
    sympy.Expr

    Raises
    ------
    ExpressionError
        If the text is anything else, if a part of it is not a real number of double precision, or
        if it is larger than `tuning.FORMULA` allows.
    """
    try:
        if not isinstance(text, str):
            raise ExpressionError("it is not text; write it in quotes")
        return _parsed(text, tuple(variables))
    except ExpressionError as error:
        reason = str(error)
    except RecursionError:
        reason = _TOO_DEEP
    raise ExpressionError(f"cannot read the formula {quoted(text)}: {reason}")


@lru_cache(maxsize=256)  # sweeps ask for the same formulas again and again
def _parsed(text, variables):
    tree, line = _syntax_tree(text)
    return _Reader(line, variables).expression(tree)


def _syntax_tree(text):
    """Return the syntax tree of a formula, and the formula as one line."""
    if len(text) > tuning.FORMULA.length:
        raise ExpressionError(f"it has {len(text)} characters; use at most {tuning.FORMULA.length}")
    line = " ".join(text.split())
    if not line:
        raise ExpressionError(f"it is empty; {_EXAMPLE}")
    if foreign := _FOREIGN.search(line):
        written = line.translate(_WRITTEN)
        cure = _EXAMPLE if _FOREIGN.search(written) else f"write {quoted(written)}"
        raise ExpressionError(f"{quoted(foreign[0])} means nothing in a formula; {cure}")
    if glued := _NUMBER_AND_NAME.search(line):
        raise ExpressionError(f"{quoted(glued[0], _PART)} is no number; write * for a product")
    try:
        return ast.parse(line, mode="eval").body, line
    except (SyntaxError, ValueError, MemoryError) as error:
        place = getattr(error, "offset", None) or 1
        raise ExpressionError(
            f"it is not one expression, see {quoted(line[place - 1 :], _PART)}; "
            "write * for every product and close every bracket"
        ) from None


class _Reader:
    """Turns a syntax tree into what it means: a Python number or a sympy expression.

    Numbers are computed as Python computes them, all else as sympy does.
    """

    def __init__(self, line, variables):
        self._line = line
        self._variables = {symbol.name: symbol for symbol in variables}
        self._constants = ConstantParts()
        self._operations = self._compared = 0
        self._within = self._operations_within = 0  # arguments of max and min
        self._nested = 0  # functions and powers around what is read
        self._operations_nested = 0  # in the outermost of them

    def expression(self, tree):
        return sympy.sympify(self._read(tree, 0))  # a number or an expression, never text

    def _read(self, node, depth):
        if depth > tuning.FORMULA.depth:
            raise ExpressionError(_TOO_DEEP)
        match node:
            case ast.Constant(value=int() | float()) if not isinstance(node.value, bool):
                return self._number(node)
            case ast.Name():
                return self._named(node.id)
            case ast.UnaryOp(op=ast.UAdd() | ast.USub()):
                self._count()
                return self._checked(
                    _OPERATIONS[type(node.op)](self._read(node.operand, depth + 1))
                )
            case ast.BinOp(op=ast.Pow()):
                self._count()
                with self._deeper():
                    return self._checked(self._operation(node, depth))
            case ast.BinOp() if type(node.op) in _OPERATIONS:
                self._count()
                return self._checked(self._operation(node, depth))
            case ast.Call(func=ast.Name(), keywords=[]):
                self._count()
                with self._deeper():
                    return self._checked(self._call(node, depth))
            case ast.Call(keywords=[]):
                self._refuse_module(node.func)
                raise ExpressionError(
                    f"{self._quoted(node.func)} is no function; for a product write *"
                )
        self._refuse_module(node)
        raise ExpressionError(f"{self._quoted(node)} is not arithmetic; {_EXAMPLE}")

    @contextmanager
    def _deeper(self):
        """Read a function or a power, whose arguments may have others."""
        if not self._nested:
            self._operations_nested = 0
        self._nested += 1
        if self._nested > tuning.FORMULA.nested:
            raise ExpressionError(
                f"it has more than {tuning.FORMULA.nested} functions and powers within one "
                "another; simplify it"
            )
        yield
        self._nested -= 1

    def _quoted(self, node):
        return quoted(ast.get_source_segment(self._line, node), _PART)

    def _count(self):
        self._operations += 1
        if self._operations > tuning.FORMULA.operations:
            raise ExpressionError(
                f"it has more than {tuning.FORMULA.operations} operations; simplify it"
            )
        self._operations_nested += self._nested > 0
        if self._operations_nested > tuning.FORMULA.operations_nested:
            raise ExpressionError(
                "the arguments of one of its functions or powers have more than "
                f"{tuning.FORMULA.operations_nested} operations; simplify them"
            )
        self._operations_within += self._within > 0
        if self._operations_within > tuning.FORMULA.operations_compared:
            raise ExpressionError(
                "the arguments of its max and min have more than "
                f"{tuning.FORMULA.operations_compared} operations; simplify them"
            )

    def _number(self, node):
        mantissa = re.split("[eE]", ast.get_source_segment(self._line, node))[0]
        lost = node.value == 0 and mantissa.strip("0._")
        return in_range(math.inf if lost else node.value)

    def _named(self, name):
        if name == "pi":
            return sympy.pi
        if name in self._variables:
            return self._variables[name]
        if name in FUNCTIONS:
            raise ExpressionError(f"{name} is a function; write {name}(...)")
        raise self._unknown(name)

    def _unknown(self, name):
        known = [*sorted(self._variables), "pi", *FUNCTIONS]
        meant = MEANT.get(name.lower(), name.lower())
        cure = f"write {meant}" if meant in known else f"use {', '.join(known)}"
        return ExpressionError(f"{quoted(name, _PART)} is unknown; {cure}")

    def _refuse_module(self, node):
        """Tell how np.sin or math.pi is written."""
        if isinstance(node, ast.Attribute) and node.attr in (*FUNCTIONS, "pi"):
            raise ExpressionError(f"{self._quoted(node)} is unknown; write {node.attr}")

    def _operation(self, node, depth):
        kind = type(node.op)
        flat = isinstance(node.left, ast.BinOp) and any(
            kind in kinds and isinstance(node.left.op, kinds) for kinds in _FLAT
        )
        left = self._read(node.left, depth if flat else depth + 1)
        right = self._read(node.right, depth + 1)
        if kind is ast.Div and right == 0:
            raise ExpressionError("it divides by zero; change that")
        if kind is ast.Pow:
            self._require_power(left, right)
        value = _OPERATIONS[kind](left, right)
        if kind in (ast.Mult, ast.Div) and value == 0 and 0 not in (left, right):
            return math.inf  # the product of numbers has underflown
        return value

    def _require_power(self, base, exponent):
        """Refuse powers that are not real, or have too many digits to be computed."""
        number, power = self._double(base), self._double(exponent)
        if number == 0 and not (power is not None and power >= 0):
            raise ExpressionError("it takes a power of zero that is not positive; change that")
        if number is not None and power is not None:
            evaluated(sympy.Pow, [number, power])
        elif number is not None and number < 0:
            raise ExpressionError("a negative number to a variable power is not real; use abs(...)")
        if isinstance(base, sympy.Expr) or isinstance(exponent, sympy.Expr):
            require_small_numbers(sympy.sympify(exponent), sympy.sympify(base))

    def _call(self, node, depth):
        name, count = node.func.id, len(node.args)
        if name in self._variables or name == "pi":
            raise ExpressionError(f"{name} is no function; for a product write {name}*(...)")
        if name not in FUNCTIONS:
            raise self._unknown(name)
        if count < 2 if name in _COMPARED else count != 1:
            wanted = "two arguments or more" if name in _COMPARED else "one argument"
            raise ExpressionError(f"{name} takes {wanted}, but here {count}; correct that")
        self._compared += count if name in _COMPARED else 0
        if self._compared > tuning.FORMULA.compared:
            raise ExpressionError(
                f"its max and min have more than {tuning.FORMULA.compared} arguments; simplify it"
            )
        self._within += name in _COMPARED
        arguments = [self._read(argument, depth + 1) for argument in node.args]
        self._within -= name in _COMPARED
        values = [self._double(argument) for argument in arguments]
        if None not in values:
            evaluated(FUNCTIONS[name], values)
        if name == "exp" and sympy.sympify(arguments[0]).has(sympy.log):
            require_small_numbers(arguments[0])  # because exp(m log x) is x**m
        return FUNCTIONS[name](*arguments)

    def _double(self, value):
        """Return the value of a number or constant expression, None if it has variables."""
        return self._constants.value(value) if isinstance(value, sympy.Expr) else float(value)

    def _checked(self, value):
        if isinstance(value, sympy.Expr):
            self._constants.value(value)
            return value
        return in_range(value)


def require_slope(text: str, expression: sympy.Expr, variable: sympy.Symbol) -> None:
    """Check that a formula has a derivative that is a real function, but perhaps at kinks.

    Parameters
    ----------
    text : str
        The formula, for the message.
    expression : sympy.Expr
        What it means.
    variable : sympy.Symbol

    Raises
    ------
    ExpressionError
        If it jumps, or a part of it is real only for some values of the variable and the
        derivative is not a formula therefore.
    """
    slope = sympy.diff(expression, variable)
    if slope.has(sympy.DiracDelta):
        raise ExpressionError(
            f"the derivative of {quoted(text)} is not a formula, as its sign(...) jumps; write it "
            "with abs, max or min"
        )
    if slope.has(*_NOT_FORMULAS):
        raise ExpressionError(
            f"the formula {quoted(text)} has no derivative, as it is not real everywhere; "
            "put abs(...) into its roots and logarithms"
        )


def compilable(expression: sympy.Expr) -> sympy.Expr:
    """Return an expression whose values are the same and which compilers understand.

    Integers too large for a machine, as (x/10)**20 has them, become doubles. The derivative of a
    jump, which the second derivative of a kink has, is 0 but at one point.

    Raises
    ------
    ExpressionError
        If it is a derivative that is not a formula.
    """
    known = {
        number: sympy.Float(number)
        for number in expression.atoms(sympy.Rational)
        if max(abs(number.p), number.q) > 2**53
    }
    jumps = expression.atoms(sympy.DiracDelta, sympy.Derivative)
    smooth = expression.xreplace(known | dict.fromkeys(jumps, sympy.Integer(0)))
    if smooth.has(*_NOT_FORMULAS):
        raise ExpressionError(
            "the second derivative of a formula is not real everywhere; put abs(...) into its "
            "roots and logarithms"
        )
    return smooth


def parity(expression: sympy.Expr, variables: Collection[sympy.Symbol]) -> int:
    """Tell how an expression changes if all variables change their signs.

    The parts of the expression decide, which takes no time. Terms that only cancel after they
    are multiplied out, as in (y + 1)**2 - (y - 1)**2, are not seen.

    Parameters
    ----------
    expression : sympy.Expr
    variables : collection of sympy.Symbol

    Returns
    -------
    int
        1 if it is even, -1 if it is odd, 0 if its structure shows neither. 0 itself is even.
    """
    if not expression.free_symbols.intersection(variables):
        return EVEN
    if expression.is_Symbol:
        return ODD
    if isinstance(expression, sympy.Piecewise):
        return _of_branches(expression, variables)
    parts = [parity(part, variables) for part in expression.args]
    if expression.is_Add:
        return parts[0] if len(set(parts)) == 1 else NEITHER
    if expression.is_Mul:
        return math.prod(parts)
    if all(part == EVEN for part in parts):
        return EVEN
    if expression.is_Pow:
        return parts[0] ** int(expression.exp % 2) if expression.exp.is_Integer else NEITHER
    if NEITHER in parts or expression.func not in _ODD_FUNCTIONS + _EVEN_FUNCTIONS:
        return NEITHER
    return ODD if expression.func in _ODD_FUNCTIONS else EVEN


def _of_branches(piecewise, variables):
    mirrored = {variable: -variable for variable in variables}
    for _, condition in piecewise.args:
        if condition.subs(mirrored, simultaneous=True) != condition:
            return NEITHER
    parts = {parity(branch, variables) for branch, _ in piecewise.args if branch != 0}
    return parts.pop() if len(parts) == 1 else NEITHER


@lru_cache(maxsize=256)
def vectorised(
    expression: sympy.Expr, variables: tuple[sympy.Symbol, ...]
) -> Callable[..., np.ndarray]:
    """Compile an expression to a numpy function of arrays, one argument per variable."""
    # the name "numpy" would import all of its rarely used parts, a tenth of a second
    function = sympy.lambdify(variables, compilable(expression), modules=np, cse=True)

    def evaluate(*values):
        shape = np.broadcast_shapes(*(np.shape(value) for value in values))
        # a Python float would raise exceptions where numpy's has the value inf
        values = [np.float64(v) if isinstance(v, float) else v for v in values]
        with np.errstate(all="ignore"):  # what is not finite is refused where it matters
            return np.broadcast_to(np.asarray(function(*values), dtype=float), shape)

    return evaluate
