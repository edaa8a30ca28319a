"""Arguments for `benchmarks.trials.calls`, written as Python: valid, odd and extreme ones."""

_FRICTION = 'ns.Scene("friction")'
_YIELDING = 'ns.Scene("elasto_plastic", potential="x**2/2")'
_STRUCTURE = "dimensions.Structure('friction',1.0,1.0,1.0,1.0)"
_COUNTED = {"method": '"monte_carlo"', "tol": "0.1", "step": "0.05", "paths": "1000"}
_COUNTED |= {"seed": "1", "threads": "1"}

# valid and cheap calls of every function that takes arguments; what follows a blank tells those of
# one function apart
VALID: dict[str, dict[str, str]] = {
    "Scene": {
        "model": '"obstacle"',
        "noise": '"white"',
        "n": "100",
        "damping": "1.0",
        "potential": '"x**2/2"',
        "observable": '"y"',
        "start": "{'y': 0.5}",
    },
    "White": {"sigma": "1.0"},
    "Langevin": {"potential": '"eta**2/2"', "sigma": "1.0"},
    "Hamiltonian": {"H": '"eta**2/2 + zeta**2/2"', "F": '"1"', "sigma": "1.0"},
    "OrnsteinUhlenbeck": {"theta": "1.0", "sigma": "1.0"},
    "KanaiTajimi": {"stiffness": "1.0", "damping": "1.0", "sigma": "1.0"},
    "asymptotic_variance": {
        "scene": _FRICTION,
        "tol": "0.3",
        "method": '"monte_carlo"',
        "seed": "1",
        "threads": "1",
    },
    "mean": {
        "scene": _FRICTION,
        "tol": "0.3",
        "method": '"monte_carlo"',
        "seed": "1",
        "threads": "1",
    },
    "variance": {
        "scene": _FRICTION,
        "times": "[0.5, 1.0]",
        "tol": "0.3",
        "method": '"monte_carlo"',
        "seed": "1",
        "threads": "1",
    },
    "invariant_density": {
        "scene": _YIELDING,
        "tol": "0.3",
        "points": "{'y': [0.0, 1.0], 'x': [-1.0, 0.0, 1.0]}",
    },
    "spectral_gap": {"scene": _FRICTION, "tol": "1e-3"},
    "simulate": {
        "scene": _FRICTION,
        "horizon": "1.0",
        "tol": "0.3",
        "step": "0.1",
        "paths": "64",
        "seed": "1",
        "times": "[0.5, 1.0]",
        "keep": '"moments"',
        "scheme": '"strang"',
        "precision": '"float64"',
        "threads": "1",
    },
    "crossing_probability": {
        "scene": _FRICTION,
        "threshold": "0.1",
        "horizons": "[0.5, 1.0]",
        "p": "1.0",
        "method": '"monte_carlo"',
        "tol": "0.1",
        "step": "0.05",
        "paths": "1000",
        "seed": "1",
        "precision": '"float64"',
        "threads": "1",
        "order": "None",
        "envelope": "None",
    },
    "crossing_probability by importance_sampling": {
        "scene": _FRICTION,
        "threshold": "0.5",
        "horizons": "[2.0, 4.0]",
        "p": "1.0",
        **_COUNTED,
        "method": '"importance_sampling"',
    },
    "state_crossing_probability": {
        "scene": _FRICTION,
        "variable": '"y"',
        "threshold": "1.0",
        "horizons": "[0.5, 1.0]",
        **_COUNTED,
        "precision": '"float64"',
        "envelope": '"1"',
    },
    "crossing_threshold": {
        "scene": _FRICTION,
        "probability": "[0.5, 0.3]",
        "horizons": "[0.5, 1.0]",
        "p": "1.0",
        "sides": '"both"',
        **_COUNTED,
        "order": "None",
    },
    "failure_time": {
        "scene": _FRICTION,
        "threshold": "0.2",
        "probability": "[0.3, 0.5]",
        "p": "1.0",
        **_COUNTED,
        "order": "None",
    },
    "mean_time_to_failure": {
        "scene": _FRICTION,
        "threshold": "0.2",
        "p": "1.0",
        **_COUNTED,
    },
    "hazard_rate": {
        "scene": _FRICTION,
        "threshold": "0.2",
        "horizons": "[0.5, 1.0]",
        "p": "1.0",
        **_COUNTED,
        "order": "None",
    },
    "reliability_index": {
        "crossing": f"ns.crossing_probability({_FRICTION}, 0.5, [1.0], method='asymptotic')"
    },
    "asymptotic_variance_sensitivity": {
        "scene": _FRICTION,
        "parameter": '"damping"',
        "tol": "0.1",
    },
    "crossing_sensitivity": {
        "scene": _FRICTION,
        "threshold": "0.5",
        "horizons": "[0.5, 1.0]",
        "parameter": '"damping"',
        "p": "1.0",
        "method": '"monte_carlo"',
        "tol": "0.3",
        "seed": "1",
        "threads": "1",
    },
    "plot": {"result": "ns.Estimate(1.0, 0.1, 'quadrature', 0.0)"},
    "dimensions.Structure": {
        "model": '"obstacle"',
        "mass": "1.0",
        "damping": "1.0",
        "limit": "1.0",
        "spectral_density": "1.0",
        "stiffness": "1.0",
        "ground_frequency": "1.0",
        "ground_damping": "0.5",
    },
    f"{_STRUCTURE}.scene": {"observable": '"y"', "n": "100"},
    "brownian_crossing": {"b": "1.0", "T": "[0.5, 1.0]", "lower": "-2.0"},
    "brownian_survival": {"b": "1.0", "T": "[0.5, 1.0]", "lower": "-2.0"},
    "brownian_first_passage_density": {"b": "1.0", "T": "[0.5, 1.0]", "lower": "-2.0"},
    "extrapolation_length": {
        "scene": _FRICTION,
        "tol": "1e-3",
        "side": '"upper"',
        "seed": "1",
        "threads": "1",
    },
}

# for every argument
ANYWHERE = (
    *("None", "True", "False", "...", "object()", "int", "lambda: 1", "print"),
    *("''", "'abc'", "'1'", "'nan'", "b'1'", "'x' * 10**5", "'float32\\n'"),
    *("0", "-0.0", "-1", "1", "2", "3.0", "1.5", "-1e-9", "1e-9", "1e-300", "5e-324", "1e300"),
    *("10**400", "-(10**400)", "2**63", "2**31", "nan", "inf", "-inf", "1j", "1 + 0j"),
    *("Decimal('0.5')", "Decimal('NaN')", "Decimal('sNaN')", "Fraction(1, 2)"),
    *("sympy.pi", "sympy.Symbol('q')", "sympy.oo", "mpmath.mpf('0.5')"),
    *("[]", "()", "{}", "set()", "[1.0]", "(1.0,)", "[0.5, 1.0]", "[1.0, 0.5]", "[1.0, 1.0]"),
    *("[[0.5, 1.0]]", "[0.5, 'a']", "[0.5, [1.0, 2.0]]", "[0.5, None]", "[0.5, nan]", "['0.5']"),
    *("[0.0, 1.0]", "[-1.0, 1.0]", "[0.5, inf]", "[1e-300, 1.0]", "[0.5, 1j]", "[10**400]"),
    *("np.float32(0.5)", "np.float16(0.5)", "np.int64(1)", "np.uint8(1)", "np.bool_(True)"),
    *("np.array(0.5)", "np.array(1)", "np.array([0.5])", "np.array([])", "np.zeros((2, 2))"),
    *("np.array([0.5, 1.0], dtype=object)", "np.array(['a'])", "np.str_('1')", "np.longdouble(1)"),
    *("np.ma.masked", "np.ma.array([0.5, 1.0], mask=[True, False])", "np.datetime64('2020')"),
    *("np.timedelta64(1)", "np.array([1, 2], dtype='m8[s]')", "np.arange(1, 4)[::2]"),
    *("xr.DataArray([0.5, 1.0], dims='time')", "xr.DataArray(0.5)", "range(0)", "range(1, 3)"),
    *("iter([0.5])", "(k for k in [0.5])", "{'y': 1.0}", "{1: 2}", "{0.5, 1.0}", "frozenset()"),
    *("ns.Scene", _FRICTION, "ns.White()", "ns", "Exception('no')", "memoryview(b'1')"),
)

_SCENES = (
    *("'friction'", "['friction']", "{'model': 'friction'}", "ns.White", "ns.KanaiTajimi()"),
    *("ns.Scene('friction', observable='1')", "ns.Scene('friction', observable='0')"),
    "ns.Scene('friction', observable='eta', noise='langevin')",
    "ns.Scene('friction', n=inf)",
)
_FORMULAS = (
    *("'y'", "'x'", "'eta'", "'zeta'", "'n'", "'C_b'", "'y +'", "'y; x'", "'y\\nx'", "' y '"),
    *("'1'", "'0'", "'-x**2'", "'x**4'", "'1/x'", "'1/y'", "'log(x)'", "'sqrt(x)'", "'I*x'"),
    *("'1j*y'", "'x**0.5'", "'exp(x**2)'", "'exp(1000*x)'", "'abs(x)'", "'max(x, 0)'"),
    *("'1e400*x'", "'1e-400*x'", "'1e308*x**2'", "'x**1000'", "'9**9**9'", "'tan(x)'", "'pi'"),
    *("'friction_force'", "'contact_force'", "'plastic_strain_rate'", "'sign(y)'", "'nan'"),
    *("'eta**2'", "'eta**4/4 - eta**2/2'", "'-eta**2'", "'eta**2/2 + zeta**2/2'", "'1e300*eta**2'"),
    *(
        "'True'",
        "'x == 1'",
        "'x < 1'",
        "'x and y'",
        "'(x, y)'",
        "'__import__(\"os\")'",
        "'cos(1e9*y)'",
    ),
    *("'(' * 200 + 'x' + ')' * 200", "'+'.join(['x'] * 10000)", "'β*x'", "'\\x00'", "'exp(\"1\")'"),
)
_SEEDS = (
    *("(1, 'a')", "(1, 2, 3)", "(-1,)", "('a',)", "(1.0,)", "(None,)", "[1]", "2**64", "2**200"),
    *("np.int64(-1)", "np.random.default_rng(0)", "np.random.SeedSequence(0)", "(1, object())"),
    *("((1, 2), 3)", "(True,)", "(1, [])"),
)
_NUMBERS = (
    *("1e-12", "1e-6", "1e6", "1e12", "1e100", "1e-100", "1e-16", "0.999", "1.0000001"),
    *("1.7e308", "2.3e-308", "-5e-324", "10**30", "np.float64('nan')", "np.float64('inf')"),
)
_LEVELS = (
    *("(-1.0, 1.0)", "(1.0, -1.0)", "(-1.0, 0.0)", "(0.0, 1.0)", "(-inf, 1.0)", "(-inf, inf)"),
    *(
        "(-1.0, inf)",
        "(-1.0, 1.0, 2.0)",
        "(-1.0, nan)",
        "('a', 1.0)",
        "[-0.1, 0.2]",
        "(-1e-300, 1)",
    ),
    *("(-1.0, 1e300)", "(None, 1.0)", "((-1.0, 1.0),)", "np.array([-0.1, 0.1])"),
)

_RESULTS = (
    f"ns.variance({_FRICTION}, [1.0])",
    f"ns.simulate({_FRICTION}, 1.0, step=0.1, paths=8, keep='paths', seed=1)",
    f"ns.simulate({_FRICTION}, 1.0, step=0.1, paths=8, keep='paths', seed=1)['y']",
    f"ns.crossing_probability({_FRICTION}, 0.5, [1.0], method='asymptotic').isel(horizon=0)",
    f"ns.crossing_probability({_FRICTION}, 0.5, [1.0], method='asymptotic') * np.nan",
    f"ns.crossing_probability({_FRICTION}, 0.5, [1.0], method='asymptotic') + 1",
    f"ns.crossing_probability({_FRICTION}, [0.5, 1.0], [1.0, 2.0], method='asymptotic')",
    f"ns.invariant_density({_YIELDING}, tol=0.1)",
    "xr.Dataset()",
    "xr.Dataset({'probability': 0.5, 'probability_error': 0.1})",
    "xr.Dataset({k: 'a' for k in ('probability', 'probability_error', 'lower', 'upper')})",
    "xr.Dataset({k: 0.5j for k in ('probability', 'probability_error', 'lower', 'upper')})",
    "xr.Dataset({k: ('t', []) for k in ('probability', 'probability_error', 'lower', 'upper')})",
    "xr.DataArray(np.zeros((2, 2, 2)))",
    "xr.DataArray(['a', 'b'], dims='t', coords={'t': ['c', 'd']}, name='v')",
    "{'a': ns.Estimate(1.0, nan, 'quadrature', 0.0), 'b': ns.Estimate(inf, 0.1, '', 0.0)}",
    f"{{'a': ns.Estimate(1.0, 0.1, '', 0.0), 'b': ns.variance({_FRICTION}, [1.0])}}",
    "{1: ns.Estimate(1.0, 0.1, '', 0.0), 'b': ns.Estimate(1.0, 0.1, '', 0.0)}",
    f"{{'$x': ns.variance({_FRICTION}, [1.0]), None: ns.variance({_FRICTION}, [1.0, 2.0])}}",
)
# in addition, by the name of the argument
SPECIAL: dict[str, tuple[str, ...]] = {
    "scene": _SCENES,
    "model": ("'friction'", "'Friction'", "'frictoin'", "ns.Scene('friction').mechanics"),
    "noise": ("'White'", "ns.White", "'langevin'", "ns.KanaiTajimi(2.0)", "{'sigma': 1.0}"),
    **dict.fromkeys(("potential", "observable", "H", "F"), _FORMULAS),
    "start": (
        *("{'x': 0.5}", "{'x': inf}", "{'y': nan}", "{'y': 'a'}", "{'y': None}", "{'z': 1.0}"),
        *(
            "{'eta': 1.0}",
            "{'y': [1.0]}",
            "{'y': 1e300}",
            "{'y': 1j}",
            "{None: 1.0}",
            "[('y', 1.0)]",
        ),
        *("{'y': 10**400}", "{'y': 1.0, 2: 3.0}", "{'y': np.array([1.0, 2.0])}", "{'y': True}"),
    ),
    "points": (
        *("{'y': []}", "{'y': [0.0]}", "{'x': [0.0]}", "{'y': [nan], 'x': [0.0]}"),
        *("{'y': [0.0], 'x': []}", "{'y': [0.0], 'x': ['a']}", "{'y': [0.0], 'z': [0.0]}"),
        *("{'y': [1.0, 0.0], 'x': [0.0]}", "{'y': [0.0, 0.0], 'x': [0.0]}"),
        *("{'y': [[0.0]], 'x': [0.0]}", "{'y': 0.0, 'x': 0.0}", "{'y': [1e300], 'x': [-1e300]}"),
        *(
            "{'y': [inf], 'x': [0.0]}",
            "{'y': None, 'x': None}",
            "{'y': [0.0], 'x': [0.0], 'eta': [0]}",
        ),
        *("{'y': np.linspace(-1, 1, 3), 'x': (0.0,)}", "{'y': [1j], 'x': [0.0]}", "[('y', [0.0])]"),
        "xr.Dataset(coords={'y': [0.0, 1.0], 'x': [0.0]})",
    ),
    "threshold": _LEVELS,
    "seed": _SEEDS,
    "method": (
        *("'deterministic'", "'asymptotic'", "'corrected'", "'Monte_Carlo'", "'monte carlo'"),
        *("['monte_carlo']", "'montecarlo'", "('deterministic',)"),
    ),
    "variable": ("'x'", "'eta'", "'zeta'", "'z'", "'Y'", "['y']"),
    "parameter": ("'n'", "'sigma'", "'threshold'", "'p'", "'theta'", "'Damping'", "['n']"),
    "sides": ("'upper'", "'lower'", "'Both'", "['both']"),
    "probability": ("1e-9", "1 - 1e-9", "[0.5, 0.5]", "[0.9, 0.1]", "[1e-300]", "[0.5, 1.0]"),
    "envelope": (
        *("'t'", "'-t'", "'t - 0.5'", "'1/t'", "'exp(1e3*t)'", "'1e-30'", "'0'", "'sin(1e9*t)'"),
        *("'y'", "'sqrt(-t)'", "'t**-0.4'", "'log(t)'", "'t; 1'", "'nan'", "'9**9**9*t'"),
    ),
    "crossing": _RESULTS,
    "result": _RESULTS,
    "keep": ("'paths'", "'path'", "['paths']"),
    "scheme": (
        "'lie'",
        "'drift_implicit'",
        "'euler_maruyama'",
        "'dry_friction'",
        "'Strang'",
        "['lie']",
    ),
    "precision": ("'float32'", "'float16'", "'double'", "np.float32", "float", "['float32']"),
    "side": ("'lower'", "'Upper'", "'both'", "['upper']", "('lower', 'upper')"),
    "order": ("1.0", "4", "-2", "'1'", "True"),
    **dict.fromkeys(
        ("threads", "paths"), ("1000000", "10**7", "10**9", "10**15", "7", "1.0", "64.0")
    ),
    **dict.fromkeys(("times", "horizons", "T"), ("[1e-12, 1.0]", "[1e12]", "[1e-300]", "[1e300]")),
    **dict.fromkeys(
        (
            *("n", "damping", "sigma", "theta", "stiffness", "tol", "horizon", "step", "p", "b"),
            *("lower", "mass", "limit", "spectral_density", "ground_frequency", "ground_damping"),
        ),
        _NUMBERS,
    ),
}


def of(name: str) -> tuple[str, ...]:
    """Odd values for the argument of that name."""
    return tuple(dict.fromkeys(ANYWHERE + SPECIAL.get(name, ())))


# extreme scenes that the constructor may refuse or take
SCENES = (
    *(
        f"ns.Scene('friction', n={n})"
        for n in ("1e-300", "1e-12", "1e-3", "1e6", "1e12", "1e300", "inf")
    ),
    *(
        f"ns.Scene('friction', damping={c})"
        for c in ("1e-300", "1e-12", "1e-5", "1e5", "1e12", "1e300")
    ),
    *(f"ns.Scene('friction', noise=ns.White({s}))" for s in ("1e-200", "1e-9", "1e9", "1e200")),
    *(f"ns.Scene('friction', noise=ns.OrnsteinUhlenbeck({t}))" for t in ("1e-9", "1e9", "1e300")),
    "ns.Scene('friction', noise=ns.OrnsteinUhlenbeck(sigma=1e-9))",
    "ns.Scene('friction', noise=ns.KanaiTajimi(1e9, 1e-9))",
    "ns.Scene('friction', noise=ns.KanaiTajimi(1e-9, 1e9))",
    "ns.Scene('friction', noise=ns.KanaiTajimi(1e200, 1e200))",
    *(
        f"ns.Scene('friction', observable={g!r})"
        for g in (
            *("0", "1", "y**2", "y**3", "exp(y)", "exp(y**2)", "1e-200*y", "1e200*y", "1e-320*y"),
            *(
                "sign(y)",
                "cos(1e9*y)",
                "1/y",
                "1/(y - 0.5)",
                "log(y)",
                "sqrt(y)",
                "y/abs(y)",
                "tanh(1e9*y)",
            ),
            *("friction_force", "x", "y**51", "abs(y)", "max(y, 0)", "1e-30"),
        )
    ),
    "ns.Scene('friction', start={'y': 1e6})",
    "ns.Scene('friction', start={'y': 1e300})",
    *(
        f"ns.Scene('elasto_plastic', potential={u!r})"
        for u in (
            "0",
            "1e-12*x**2",
            "1e12*x**2",
            "1e200*x**2",
            "-x**2",
            "x**8",
            "exp(x)",
            "1/x",
            "cos(1e6*x)",
        )
    ),
    *(f"ns.Scene('elasto_plastic', potential='x**2/2', n={n})" for n in ("1e-9", "1e9", "inf")),
    "ns.Scene('elasto_plastic', potential='x**2/2', observable='plastic_strain_rate', n=inf)",
    *(
        f"ns.Scene('obstacle', potential={u!r}, observable='x')"
        for u in ("0", "1e6*x**2", "-1e6*x**2", "30*(x**2 - 0.25)**2", "1e3*x", "log(x)")
    ),
    *(f"ns.Scene('obstacle', observable='x', n={n})" for n in ("1e-9", "1e9", "1e300", "inf")),
    "ns.Scene('obstacle', observable='contact_force', n=inf)",
    "ns.Scene('obstacle', observable='x**2', damping=1e-6)",
    "ns.Scene('friction', noise=ns.Langevin('eta**4/4 - 100*eta**2/2'))",
    "ns.Scene('friction', noise=ns.Langevin('exp(eta**2)'))",
    "ns.Scene('friction', noise=ns.Hamiltonian('eta**4 + zeta**2/2', '1 + eta**2'))",
    "ns.Scene('obstacle', noise='hamiltonian', potential='x**2/2', observable='x', n=inf)",
    "ns.Scene('elasto_plastic', noise='langevin', potential='x**4/4', n=1e6)",
    *(
        f"dimensions.Structure({arguments}).scene()"
        for arguments in (
            *("'friction', 1e20, 1, 1, 1", "'obstacle', 1, 1e-20, 1e10, 1, 1e20"),
            *("'elasto_plastic', 1, 1e-30, 1e30, 1e-30, 1", "'friction', 1e-30, 1e30, 1e30, 1e30"),
            "'obstacle', 1, 1, 1, 1, 1, 1e25, 1e-25",
        )
    ),
)

# what is asked of each of them
QUESTIONS: tuple[tuple[str, dict[str, str]], ...] = (
    ("asymptotic_variance", {"tol": "0.3", "method": '"deterministic"'}),
    ("asymptotic_variance", {"tol": "0.3", "method": '"monte_carlo"'}),
    ("variance", {"times": "[0.0, 1.0]", "tol": "0.1"}),
    ("variance", {"times": "[1.0, 2.0]", "tol": "0.3", "method": '"monte_carlo"'}),
    ("invariant_density", {"tol": "0.1"}),
    ("spectral_gap", {"tol": "1e-3"}),
    ("simulate", {"horizon": "1.0", "tol": "0.3"}),
    ("simulate", {"horizon": "1.0", "step": "0.1", "paths": "64", "keep": '"paths"'}),
    ("crossing_probability", {"threshold": "0.5", "horizons": "[1.0]", "tol": "0.1"}),
    (
        "crossing_probability",
        {"threshold": "0.5", "horizons": "[1.0]", "method": '"deterministic"'},
    ),
    ("crossing_probability", {"threshold": "0.5", "horizons": "[1.0]", "method": '"asymptotic"'}),
    ("crossing_probability", {"threshold": "0.5", "horizons": "[1.0]", "method": '"corrected"'}),
    (
        "crossing_probability",
        {"threshold": "3.0", "horizons": "[1.0]", "method": '"importance_sampling"', "tol": "0.1"},
    ),
    ("extrapolation_length", {"tol": "0.1"}),
    ("state_crossing_probability", {"variable": '"y"', "threshold": "1.0", "horizons": "[1.0]"}),
    ("crossing_threshold", {"probability": "0.5", "horizons": "[1.0]", "tol": "0.1"}),
    ("failure_time", {"threshold": "0.5", "tol": "0.1"}),
    ("mean_time_to_failure", {"threshold": "0.5", "tol": "0.1"}),
    ("hazard_rate", {"threshold": "0.5", "horizons": "[1.0]", "tol": "0.1"}),
    ("asymptotic_variance_sensitivity", {"parameter": '"damping"', "tol": "0.1"}),
    (
        "crossing_sensitivity",
        {"threshold": "0.5", "horizons": "[1.0]", "parameter": '"damping"', "tol": "0.3"},
    ),
)
