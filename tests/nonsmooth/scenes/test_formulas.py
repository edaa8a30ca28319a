"""Formulas: arithmetic passes, everything else is refused in one line, quickly, and never run."""

import keyword
import sys
import time
import warnings

import numba
import numpy as np
import pytest
import sympy
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from nonsmooth.errors import AssumptionWarning, ExpressionError, NonsmoothError
from nonsmooth.paths.kernels.compiled_formulas import compiled, evaluate
from nonsmooth.scenes.formulas import FUNCTIONS, parse, vectorised
from nonsmooth.scenes.symbols import STATE_VARIABLES, x
from rounded import FUNCTIONS as ROUNDED
from rounded import Rounded


@numba.njit
def call_on(address, out, state):
    """Evaluate a compiled formula over the columns of a state."""
    evaluate(address, out.ctypes, state.ctypes, state.shape[1], len(out))


def test_formula_means_what_python_means():
    """The parsed formula agrees with plain numpy, vectorised and compiled."""
    formula = parse("x**2/2 + 0.3*cos(3*x) - max(x, 0)", (x,))
    points = np.linspace(-2, 2, 9)
    expected = points**2 / 2 + 0.3 * np.cos(3 * points) - np.maximum(points, 0)
    assert np.allclose(vectorised(formula, (x,))(points), expected, rtol=1e-14)
    state, out = np.zeros((4, 9)), np.empty(9)
    state[3] = points
    address = compiled(formula, STATE_VARIABLES).address

    call_on(address, out, state)
    assert np.allclose(out, expected, rtol=1e-14)


EVENTS = []  # what the interpreter did while a formula was read
WATCHED = [False]
SECOND = 1.0


def watch(event, arguments):
    """Record what reading a formula should not do; Python's own parser announces a compilation."""
    if WATCHED[0] and not event.startswith(("object.__", "sys._getframe", "gc.", "builtins.id")):
        parsed = event == "compile" and arguments[1] == "<unknown>"
        lazy = event == "import" and str(arguments[0]).startswith(("sympy.", "mpmath."))
        if not (parsed or lazy):
            EVENTS.append(f"{event} {str(arguments)[:80]}")


sys.addaudithook(watch)


def read(text):
    """Read a formula or return None, and hold what must hold for every text."""
    EVENTS.clear()
    began = time.process_time()
    WATCHED[0] = True
    try:
        found = parse(text, STATE_VARIABLES)
    except ExpressionError as error:
        found = None
        message = str(error)
    finally:
        WATCHED[0] = False
    assert time.process_time() - began < SECOND
    assert not EVENTS
    if found is None:
        assert "\n" not in message
        assert message.isascii()
        assert len(message) < 300
    else:
        assert isinstance(found, sympy.Expr)
        assert not found.has(sympy.I, sympy.zoo, sympy.nan, sympy.oo)
    return found


@pytest.fixture(scope="module", autouse=True)
def _sympy_is_loaded():
    """Let sympy import what it imports at first use."""
    for name in FUNCTIONS:
        first = f"{name}(x, 2*y)" if name in ("max", "min") else f"{name}(x + 1)"
        parse(f"{first}**2 + {first}*x/3.5 - pi*abs(y)**0.3", STATE_VARIABLES)


REFUSED = {
    "strings": ["'x'", 'exp("x")', "b'x'", "f'{x}'", "exp(\"__import__('os').system('true')\")"],
    "statements": [
        "x; y",
        "x = 2",
        "(x := 2)",
        "import os",
        "del x",
        "x\n;y",
        "pass",
        "# x",
        "x # y",
    ],
    "Python": [
        "x.real",
        "x[0]",
        "[x, y]",
        "(x, y)",
        "x,",
        "{x}",
        "lambda: x",
        "x if y else 1",
        "...",
    ],
    "logic": ["x < 1", "x == y", "not x", "x and y", "x & y", "x | y", "~x", "x is y", "x in y"],
    "operations": ["x^2", "x // 2", "x % 2", "x @ y", "x << 2", "2x", "2(x)", "(x + 1)(x - 1)"],
    "calls": [
        "max(x)",
        "max()",
        "sin(x, y)",
        "max(*x)",
        "max(x, key=y)",
        "pi(2)",
        "x(2)",
        "foo(x)",
    ],
    "names": [
        "q",
        "_x",
        "__builtins__",
        "sin",
        "True",
        "None",
        "X",
        "\u0445 + 1",
        "\uff58",
        "x\ufe0e",
    ],
    "incomplete": [
        "",
        " \n",
        "x +",
        "(x",
        "x)",
        "+",
        "()",
        "x y",
        "1..2",
        "x\0",
        "\ud800",
        "x\\\n",
    ],
    "not real": ["1j", "sqrt(-1)", "log(-2)", "(-8)**(1/3)", "sqrt(-1 - x**2)", "sqrt(-1)**2 + x"],
    "infinite": ["1/0", "x/0", "x/(y - y)", "log(0)", "0**-1", "0**x", "(-2)**x", "nan", "inf"],
    "range": [
        "1e400",
        "1e-400",
        "9" * 400,
        "1e200*x*1e200",
        "1e-200*1e-200",
        "exp(1000)",
        "exp(-1e9)",
    ],
    "powers": ["(9**9999)**9999", "2**9999*y", "9**9**9**9", "x**999999", "((7*x)**99)**99"],
    "towers": ["exp(exp(exp(9)))", "exp(10**15*log(x/3))", "((7*pi/22)**99)**99", "2**(x + 10**9)"],
    "size": [
        "x" * 30_000,
        "(" * 500,
        "-" * 500 + "x",
        "sin(" * 99 + "x" + ")" * 99,
        "x" + "+x" * 300,
    ],
    "no text": [None, 3, 2.5, b"x", ["x"], True, sympy.Symbol("x")],
}


@pytest.mark.parametrize("text", [text for texts in REFUSED.values() for text in texts])
def test_anything_but_arithmetic_is_refused(text):
    """Each of these is an `ExpressionError` of one short line."""
    assert read(text) is None


def test_a_message_quotes_the_formula_and_names_the_cure():
    """It quotes at most 80 characters."""
    with pytest.raises(ExpressionError, match=r"'x\^2'.*write 'x\*\*2'"):
        parse("x^2", (x,))
    with pytest.raises(ExpressionError) as error:
        parse("x + " * 300 + "q", (x,))
    assert repr(("x + " * 300)[:75] + "...")[1:] in str(error.value)


def test_line_breaks_are_white_space():
    """All lines of a formula count."""
    assert parse("x**2/2\n  + 0.3*cos(\r\n3*x)\n", (x,)) == parse("x**2/2 + 0.3*cos(3*x)", (x,))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x**2/2", "Mul(Rational(1, 2), Pow(Symbol('x', real=True), Integer(2)))"),
        ("1/2*x", "Mul(Float('0.5', precision=53), Symbol('x', real=True))"),
        ("-3", "Integer(-3)"),
        ("2*pi", "Mul(Integer(2), pi)"),
        ("1_000.5", "Float('1000.5', precision=53)"),
    ],
)
def test_numbers_are_computed_as_in_python(text, expected):
    """Quotients of numbers are floats; coefficients of symbols stay exact."""
    assert sympy.srepr(parse(text, (x,))) == expected


@pytest.mark.parametrize("section", ["potential", "observable"])
def test_a_scene_does_not_run_text(section, tmp_path):
    """Commands hidden in strings are refused before anything happens."""
    mark = tmp_path / "touched"
    with pytest.raises(ExpressionError):
        ns.Scene("friction", **{section: f"exp(\"__import__('os').system('touch {mark}')\")"})
    with pytest.raises(ExpressionError):
        ns.Langevin(f"exp(\"open('{mark}', 'w')\")")
    assert not mark.exists()


NAMES = ["x", "y", "eta", "zeta", "pi", "e", "_", "__import__", "os", "True", "None", *FUNCTIONS]
NUMBERS = [
    "0",
    "1",
    "2",
    "0.5",
    "1e300",
    "1e-300",
    "99",
    "10**15",
    "1j",
    "0x1F",
    "1_0",
    "9" * 30,
    "1.",
]
SIGNS = [*"+-*/(),.;:=<>&|^~%@!#[]{}'\"\n\\\0", "**", "//", ":=", "->"]
WORDS = [*keyword.kwlist, "exec", "eval", "open", "print"]
SNIPPETS = [
    "__import__('os').system('touch hacked')",
    "open('hacked', 'w')",
    "().__class__.__bases__[0].__subclasses__()",
    "exec('import socket')",
    "[c for c in (1).__class__.__mro__]",
    "f\"{__import__('os')}\"",
    "eval(compile('x', '', 'eval'))",
    "(lambda: x)()",
    "getattr(x, 'subs')(x, 1)",
]
VALID = ["x**2/2 + 0.3*cos(3*x)", "max(min(20*y, 1), -1)", "abs(y)**0.3", "exp(-2*x**2)*log(y)"]


@st.composite
def nested(draw):
    """Put a snippet into a call or between quotes, some levels deep."""
    text = draw(st.sampled_from(SNIPPETS + VALID))
    for _ in range(draw(st.integers(0, 4))):
        form = draw(st.sampled_from(['exp("{}")', "sin({})", "x + {}", "'{}'", "{}**{}", "({},)"]))
        text = form.replace("{}", text)
    return text


@st.composite
def mutated(draw):
    """Delete from, double in, or insert into a valid formula."""
    text = draw(st.sampled_from(VALID))
    for _ in range(draw(st.integers(1, 4))):
        start, stop = sorted(draw(st.integers(0, len(text))) for _ in range(2))
        part = draw(st.sampled_from(["", text[start:stop] * 2, *SIGNS, *NAMES, *NUMBERS]))
        text = text[:start] + part + text[stop:]
    return text


@st.composite
def formulas(draw, depth=4):
    """Write a formula by the rules of the grammar."""
    if depth == 0 or draw(st.integers(0, 5)) == 0:
        leaf = ["x", "y", "eta", "zeta", "1", "2", "3", "0.5", "1.25", "pi", "7", "10"]
        return draw(st.sampled_from(leaf))
    part = [draw(formulas(depth=depth - 1)) for _ in range(2)]
    kind = draw(st.sampled_from([*"+-*/p-", *FUNCTIONS]))
    if kind in ("max", "min"):
        return f"{kind}({part[0]}, {part[1]})"
    if kind in FUNCTIONS:
        return f"{kind}({part[0]})"
    if kind == "p":
        return f"({part[0]})**{draw(st.sampled_from(['2', '3', '0.5', '-1', '(1/3)', 'x']))}"
    return f"({part[0]}) {kind} {part[1]}"


TEXTS = {
    "unicode": (st.text(st.characters(), max_size=60), 2500),
    "signs of formulas": (st.text("xyepi0123456789.+-*/() ,", max_size=40), 2500),
    "tokens": (st.lists(st.sampled_from(NAMES + NUMBERS + SIGNS + WORDS)).map("".join), 2500),
    "spaced tokens": (
        st.lists(st.sampled_from(NAMES + NUMBERS + SIGNS + WORDS)).map(" ".join),
        1000,
    ),
    "mutations": (mutated(), 1500),
    "snippets": (nested(), 500),
    "grammar": (formulas(depth=6), 300),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", TEXTS)
def test_any_text_is_read_or_refused(kind):
    """No other exception, none slower than a second, nothing run: 10,800 texts in all."""
    texts, examples = TEXTS[kind]

    @settings(
        max_examples=examples,
        deadline=None,
        database=None,
        derandomize=True,
        suppress_health_check=list(HealthCheck),
    )
    @given(texts)
    def check(text):
        read(text)

    check()


@pytest.mark.slow
@settings(
    max_examples=300,
    deadline=None,
    database=None,
    derandomize=True,
    suppress_health_check=list(HealthCheck),
)
@given(formulas(), st.lists(st.floats(-4, 4, allow_subnormal=False), min_size=4, max_size=4))
def test_formula_has_the_value_of_pythons_arithmetic(text, place):
    """Within the rounding error of both, which `rounded` follows through the formula."""
    names = {s.name: Rounded(value) for s, value in zip(STATE_VARIABLES, place, strict=True)}
    try:
        expected = eval(text, {"__builtins__": {}}, names | ROUNDED)
    except (ArithmeticError, ValueError):  # not defined at this place, or not to any digit
        assume(False)
    formula = read(text)
    assume(formula is not None)
    value = float(vectorised(formula, STATE_VARIABLES)(*place))
    expected = Rounded.of(expected)
    assert abs(value - expected.value) <= 2 * expected.error


NASTY = [
    "exp(exp(exp(exp(x))))",
    "x**x**x",
    "(x + 1)**100*(x - 1)**100",
    "sqrt(sqrt(x**2 - 1))",
    "log(x)",
    "1/x",
    "abs(log(x))",
    "sign(x)",
    "sign(sqrt(x))",
    "((x + 1)**9 + 1)**9",
    "max(x, x**2, sin(x))",
    "sin(10**300) + x",
    "cosh(x)**50/x**50",
    "(x/10)**100",
    "1e300*x**100",
    "0",
    "tanh(exp(x**99))",
    "*".join(["(x + 1.5)"] * 60),
    "abs(" * 20 + "x" + " - 1)" * 20,
    "max(0, abs(x) - 1)**0.5",
]


@pytest.mark.parametrize("text", NASTY)
def test_a_scene_of_any_formula_is_made_or_refused_quickly(text):
    """Scenes, their states and symmetries, and noises: nothing but errors for the user."""
    began = time.process_time()
    for make in (
        lambda: ns.Scene("friction", potential=text, observable=text).is_odd(),
        lambda: ns.Scene("obstacle", n=np.inf, potential=text, observable=text).state,
        lambda: ns.Langevin(text.replace("x", "eta").replace("eeta", "ex").replace("metap", "exp")),
        lambda: ns.Hamiltonian(f"zeta**2/2 + {text}".replace("x", "eta"), "1"),
    ):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", AssumptionWarning)
            try:
                make()
                message = ""
            except NonsmoothError as error:
                message = str(error)
        assert "\n" not in message
        assert len(message) < 400
    assert time.process_time() - began < 4 * SECOND
