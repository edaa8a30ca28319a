"""A scene: mechanical model + noise + potential + damping + penalization + observable."""

import difflib
import html
import itertools
import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
import sympy

from nonsmooth.checks import (
    PARAMETERS,
    PENALIZATIONS,
    as_number,
    require_choice,
    require_number,
    require_parameter,
    require_positive,
)
from nonsmooth.errors import AssumptionWarning, SceneError, quoted
from nonsmooth.scenes import equations, noises, regularity, symbols, tuning
from nonsmooth.scenes.formulas import ODD, parity, parse, require_slope, vectorised
from nonsmooth.scenes.models.model import Model
from nonsmooth.scenes.models.registry import MODELS
from nonsmooth.scenes.penalties import n as penalization
from nonsmooth.scenes.regularity import require_moderate
from nonsmooth.scenes.symbols import STATE_VARIABLES, x

_FORCES = {model.force_name for model in MODELS.values()}


@dataclass(frozen=True)
class Scene:
    """What is simulated and solved.

    Parameters
    ----------
    model : str or Model
        ``"elasto_plastic"``, ``"friction"``, ``"obstacle"``, or a model object.
    noise : str or Noise
        ``"white"``, ``"ornstein_uhlenbeck"`` or ``"langevin"``, ``"kanai_tajimi"`` or
        ``"hamiltonian"`` (both of unit parameters), or a noise object.
    n : float
        Penalization, "1"; ``inf`` is the non-smooth limit.
    damping : float
        C_b > 0, "1".
    potential : str
        U, a formula in ``x``.
    observable : str
        g, a formula in ``zeta, eta, y, x``, or the penalty force by its name in the model:
        ``"plastic_strain_rate"``, ``"friction_force"``, ``"contact_force"``. Unless given, it is
        y; with obstacles x, because the integral of y is a displacement, which they bound.
    start : dict
        Initial values of the state variables; those not named start at 0.

    Raises
    ------
    SceneError
        If a name is unknown or a parameter out of range.
    ExpressionError
        If a formula cannot be read.
    """

    model: str | Model
    noise: Any = "white"  # a name is replaced by the noise that it stands for
    n: float = 100.0
    damping: float = 1.0
    potential: str = "0"
    observable: Any = None  # replaced by that of the model unless given
    start: dict = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        self._check()
        self._warn_if_not_confined()
        self._warn_if_g_grows()

    def _check(self):
        """Bring the arguments into their usual form and refuse those that make no scene."""
        self._check_model_and_noise()
        if self.observable is None:
            self._set("observable", self.mechanics.default_observable)
        self._check_numbers()
        self._check_start()
        for name, example in (("potential", "x**2/2"), ("observable", "y")):
            if not isinstance(getattr(self, name), str):
                raise SceneError(
                    f"{name} is {quoted(getattr(self, name))}; write a formula in quotes, "
                    f"such as {example!r}"
                )
        self._check_force()
        require_moderate("U", self.potential, self.potential_expression, (x,))
        require_slope(self.potential, self.potential_expression, x)
        unknown = self.observable_expression.free_symbols - {*self.variables, penalization}
        if unknown:
            used = ", ".join(sorted(map(str, unknown)))
            raise SceneError(
                f"the observable {quoted(self.observable)} uses {used}, which "
                f"{self.noise.title} does not have; use {', '.join(map(str, self.variables))}"
            )
        if not self.observes_penalty_force:
            self._check_observable()

    def _check_model_and_noise(self):
        # a known model is stored by its name, so that scenes made either way are equal
        if isinstance(self.model, Model):
            if MODELS.get(self.model.name) == self.model:
                self._set("model", self.model.name)
        else:
            self._set("model", require_choice("model", self.model, MODELS))
        if isinstance(self.noise, str):
            self._set("noise", noises.named(require_choice("noise", self.noise, noises.NAMES)))
        if isinstance(self.noise, type) or not isinstance(self.noise, noises.Noise):
            raise SceneError(
                f"noise is {quoted(self.noise)}; choose from {', '.join(noises.NAMES)}, or give a "
                "noise object such as nonsmooth.White(sigma=0.5)"
            )
        require_parameter("sigma", self.noise.sigma)

    def _check_numbers(self):
        if isinstance(self.n, str) and self.n.lower().startswith("inf"):
            raise SceneError(f"n is {quoted(self.n)}; write float('inf')")
        rigid = as_number(self.n) == math.inf
        self._set("n", math.inf if rigid else require_positive("n", self.n, *PENALIZATIONS))
        self._set("damping", require_parameter("damping", self.damping))

    def _check_start(self):
        if not isinstance(self.start, Mapping):
            raise SceneError(f"start is {quoted(self.start)}; give a dict such as {{'y': 1.0}}")
        for name in self.start:
            require_choice("a variable of start", name, [s.name for s in self.variables])
        start = {
            name: require_number(f"start[{name!r}]", self.start[name], PARAMETERS[1])
            for name in sorted(self.start)
        }
        wall = self.mechanics.wall
        if math.isinf(self.n) and abs(start.get("x", 0.0)) > wall:
            raise SceneError(
                f"at n = inf the displacement is confined to [{-wall:g}, {wall:g}], but it starts "
                f"at {start['x']}; start inside or choose a finite n"
            )
        self._set("start", start)

    def _check_observable(self):
        wall = self.mechanics.wall if math.isinf(self.n) else math.inf
        fault = regularity.fault(self.observable_expression, wall)
        if fault:
            raise SceneError(
                f"g = {quoted(self.observable)} {fault}; choose one that is real, finite and "
                "varies less"
            )
        require_moderate("g", self.observable, self.observable_expression, self.variables)

    def _set(self, name, value):
        object.__setattr__(self, name, value)

    def _check_force(self):
        """Refuse a name of a force that is nearly the model's, or that of another."""
        known, name = self.mechanics.force_name, self.observable
        if name in _FORCES - {known}:
            raise SceneError(f"observable is {name!r}, the force of another model; write {known!r}")
        if name.isidentifier() and name != known and difflib.get_close_matches(name, [known]):
            raise SceneError(f"observable is {quoted(name)}; did you mean {known!r}?")

    def _warn_if_not_confined(self):
        """Warn if U grows less than quadratically, against assumption (HU2) of the paper.

        Where the penalty is part of the potential, U_n is meant: a penalty confines, too, unless U
        falls more steeply.
        """
        if "x" in self.state and not self.is_confined:
            warnings.warn(
                f"U = {quoted(self.potential)} violates (HU2), U(x) >= c x**2 - C: the paper's "
                "theorems do not cover this scene; add a confining term such as x**2/2",
                AssumptionWarning,
                stacklevel=4,
            )

    @cached_property
    def is_confined(self) -> bool:
        """Whether U, with the penalty that is part of the potential, grows quadratically."""
        if self.mechanics.in_potential and math.isinf(self.n):
            return True
        U = self._with_numbers(self.potential_expression + self.mechanics.added_potential)
        ends = np.outer([-1, 1], tuning.FAR_OUT.distances)
        with np.errstate(all="ignore"):
            ratio = vectorised(U, (x,))(ends) / ends**2
        kept = ratio[:, -1] > tuning.FAR_OUT.kept * np.abs(ratio[:, 0])
        return bool(np.all(kept) and np.all(ratio > 0))

    def _warn_if_g_grows(self):
        """Warn unless g^2 <= C V_n, which Theorem 6 of the paper asks for."""
        if self.grows_too_fast:
            warnings.warn(
                f"g = {quoted(self.observable)} violates g**2 <= V, V the Lyapunov function, which "
                "grows like the energy: the paper's limit theorem does not cover this scene, and "
                "int g may have no variance; choose a g that stays finite and grows less",
                AssumptionWarning,
                stacklevel=4,
            )

    @cached_property
    def grows_too_fast(self) -> bool:
        """Whether g^2 <= C V_n is violated, as read off the formula of g.

        V_n, the paper's Lyapunov function, grows like the energy, |z|^2 + U. The two are compared
        at the origin and, far out, on the axes and the diagonals.
        """
        if self.observes_penalty_force:
            return False
        used = [s for s in self.variables if s in self.observable_expression.free_symbols]
        far, grown = np.array(tuning.FAR_OUT.distances), tuning.FAR_OUT.grown
        signs = np.array(list(itertools.product([-1, 0, 1], repeat=len(used))), dtype=float)
        place = {s: signs[:, [k]] * far for k, s in enumerate(used)}
        if x in place and math.isinf(self.n):
            wall = self.mechanics.wall
            place[x] = np.clip(place[x], -wall, wall)
        with np.errstate(all="ignore"):
            V = 1 + sum(value**2 for value in place.values())
            if x in place:
                V = V + np.abs(vectorised(self.potential_expression, (x,))(place[x]))
            g = vectorised(self._with_numbers(self.observable_expression), tuple(used))
            ratio = np.abs(g(*place.values())) / np.sqrt(V)
        ratio = np.broadcast_to(ratio, (len(signs), len(far)))
        return not (
            np.all(np.isfinite(ratio)) and np.all(grown * ratio[:, 0] + 1 >= ratio[:, 1:].T)
        )

    @property
    def identity(self) -> tuple:
        """All that tells scenes apart except n: random streams depend on this and not on n."""
        return (
            self.model if isinstance(self.model, str) else repr(self.model),
            repr(self.noise),
            self.damping,
            self.potential,
            self.observable,
            self.start,
        )

    def with_n(self, n: float) -> "Scene":
        """Return the same scene with another penalization."""
        return self._changed(n=n)

    def with_observable(self, observable: str) -> "Scene":
        """Return the same scene with another observable, whose variables may be others."""
        return self._changed(observable=observable)

    def with_parameter(self, name: str, value: float) -> "Scene":
        """Return the same scene with another `n`, `damping` or, of its noise, `sigma`."""
        if name == "sigma":
            return self._changed(noise=replace(self.noise, sigma=value))
        return self._changed(**{name: value})

    def with_start(self, start: dict[str, float]) -> "Scene":
        """Return the same scene from another starting point."""
        return self._changed(start=start)

    def _changed(self, **changes):
        """Return a changed scene without repeating the warnings that this one has given."""
        other = object.__new__(type(self))
        other.__dict__.update({f.name: getattr(self, f.name) for f in fields(self)} | changes)
        other._check()
        return other

    @property
    def mechanics(self) -> Model:
        """The mechanical model's definition."""
        return self.model if isinstance(self.model, Model) else MODELS[self.model]

    @cached_property
    def variables(self) -> tuple[sympy.Symbol, ...]:
        """All the variables of the paper's state Z^n, whether the observable needs them or not."""
        own = set(self.noise.drift)
        return tuple(s for s in STATE_VARIABLES if s in own or s in (symbols.y, symbols.x))

    @cached_property
    def potential_expression(self) -> sympy.Expr:
        """U(x), a sympy expression."""
        return parse(self.potential, (x,))

    @cached_property
    def observable_expression(self) -> sympy.Expr:
        """The observable g, a sympy expression; with n in it if it is the penalty force."""
        if self.observes_penalty_force:
            return self.mechanics.penalty_force
        return parse(self.observable, STATE_VARIABLES)

    @property
    def observes_penalty_force(self) -> bool:
        """Whether g is phi_n', the built-in observable named after what it is in the model."""
        return self.observable == self.mechanics.force_name

    @cached_property
    def drift(self) -> dict[sympy.Symbol, sympy.Expr]:
        """F_n of the paper's Table 2: maps the symbols of `variables` to expressions in n, C_b."""
        return self.noise.drift | self.mechanics.drift(
            self.potential_expression, self.noise.forcing
        )

    @cached_property
    def state(self) -> tuple[str, ...]:
        """Names of the smallest set of variables that determines the observable's law.

        The observable's variables, closed under "the drift of one contains the other".
        """
        needed = self.observable_expression.free_symbols & set(self.variables)
        while True:
            grown = needed.union(
                *(self.drift[s].free_symbols & set(self.variables) for s in needed)
            )
            if grown == needed:
                return tuple(s.name for s in STATE_VARIABLES if s in needed)
            needed = grown

    @property
    def dimension(self) -> int:
        """Number of variables of `state`."""
        return len(self.state)

    @property
    def is_line(self) -> bool:
        """Whether the state is the velocity alone, with white noise: A is then self-adjoint."""
        return self.state == ("y",) and self.noise.kind == "white"

    @cached_property
    def primitive_variable(self) -> sympy.Symbol | None:
        """The variable q of which g is, along paths, the derivative of a function; None if none.

        Noise does not act on q, so that d phi(q)/dt = phi'(q) times the drift of q. Where g is of
        this form, as g = y with obstacles and q = x, int_0^t g = phi(q_t) - phi(q_0) stays bounded:
        E g = 0 and gamma^2 = 0. Only formulas that show it after cancelling are noticed.
        """
        g = self._with_numbers(self.observable_expression)
        for q in (s for s in self.variables if s.name in self.state and s != self.noise.driven):
            if q == x and not self.is_confined:  # x has no invariant law
                continue
            ratio = g / self._with_numbers(self.drift[q])
            if not ratio.has(sympy.Piecewise):
                ratio = sympy.cancel(ratio)
            if ratio.free_symbols & {*self.variables} <= {q}:
                return q
        return None

    def is_odd(self) -> bool:
        """Whether g and the drift change sign with the state, so that E g = 0 by symmetry.

        This is read off the structure of the formulas, see `formulas.parity`.
        """
        return self._odd_observable and self._odd_drift

    def has_odd_drift(self) -> bool:
        """Whether the drift changes sign with the state, so that the invariant measure is even."""
        return self._odd_drift

    @cached_property
    def _odd_observable(self):
        return self._all_odd([self.observable_expression])

    @cached_property
    def _odd_drift(self):
        return self._all_odd(self.drift[s] for s in self.variables if s.name in self.state)

    def _all_odd(self, expressions):
        return all(f == 0 or parity(f, self.variables) == ODD for f in expressions)

    def numerical_drift(self) -> dict[sympy.Symbol, sympy.Expr]:
        """Return `drift` with the scene's numbers in the place of n and C_b.

        Raises
        ------
        SceneError
            If n is infinite: the drift is then set-valued.
        """
        if self.n == float("inf"):
            raise SceneError("the non-smooth limit n = inf has no drift; choose a finite n")
        return {s: self._with_numbers(expression) for s, expression in self.drift.items()}

    def numerical_observable(self) -> sympy.Expr:
        """Return `observable_expression` with the scene's n; Sgn(y) is sign(y).

        Raises
        ------
        SceneError
            If g is the force of a wall that is rigid, n = inf.
        """
        if self.observes_penalty_force and self.n == float("inf"):
            if not self.mechanics.is_dry_friction:
                raise SceneError(
                    f"at n = inf the {self.observable} is not a function of the state; "
                    "use Monte Carlo, which integrates it, or a finite n"
                )
            return sympy.sign(symbols.y)
        return self._with_numbers(self.observable_expression)

    def _written(self):
        """Return the equations that define the scene."""
        potential = sympy.Eq(sympy.Symbol("U"), self.potential_expression, evaluate=False)
        lines = equations.of_motion(
            self.mechanics, self.noise, self.potential_expression, self.damping
        )
        force = equations.PENALTY_FORCE(self.mechanics.argument)
        if (own := self._force()) is not None:
            lines.append(sympy.Eq(force, own, evaluate=False))
        if self.potential_expression != 0:
            lines.append(potential)
        g = force if self.observes_penalty_force else self.observable_expression
        return [*lines, sympy.Eq(sympy.Symbol("g"), g, evaluate=False)]

    def _force(self):
        """Return the penalty force as a formula, or its limit; None if that is not known."""
        model = self.mechanics
        if math.isfinite(self.n):
            return equations.plain(self._with_numbers(model.penalty_force))
        if model.is_dry_friction:
            return sympy.sign(symbols.y)
        if not model.confines_displacement:
            return None
        inside = sympy.Abs(x) < sympy.nsimplify(model.wall)
        return sympy.Piecewise((0, inside), (sympy.Symbol("reaction"), True))

    def _title(self):
        """Say in words what the equations leave out."""
        begun = ", ".join(f"{name} = {value:g}" for name, value in self.start.items())
        n = "the non-smooth limit" if math.isinf(self.n) else f"n = {self.n:g}"
        return f"{self.mechanics.title}, {self.noise.title}, {n}, from {begun or 'rest'}"

    def _repr_html_(self) -> str:
        """Summary for notebooks: the equations of motion in MathML."""
        lines = "".join(
            f"<div style='margin: 0.4em 0'>{equations.mathml(line)}</div>"
            for line in self._written()
        )
        return f"<div><b>{html.escape(self._title())}</b>{lines}</div>"

    def _repr_latex_(self) -> str:
        """Summary for notebooks that are printed."""
        lines = r" \\ ".join(
            f"{equations.latex(line.lhs)} &= {equations.latex(line.rhs)}"
            for line in self._written()
        )
        title = self._title().replace("_", r"\_")
        return rf"$$\begin{{aligned}} & \text{{{title}}} \\ {lines} \end{{aligned}}$$"

    def _with_numbers(self, expression):
        return expression.subs(
            {penalization: sympy.Float(self.n), symbols.damping: sympy.Float(self.damping)}
        )


def by_formulas(parameters: dict) -> Scene:
    """Return the scene of a table of parameters, whose colored noise may be given by formulas.

    Parameters
    ----------
    parameters : dict
        Arguments of `Scene`; `noise` may be a dict of the arguments of `Langevin` or, if it has
        an ``H``, of `Hamiltonian`.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError, ExpressionError
        As from `Scene` and the noises.
    """
    noise = parameters["noise"]
    if isinstance(noise, dict):
        kind = noises.Hamiltonian if "H" in noise else noises.Langevin
        noise = kind(**noise)
    return Scene(**parameters | {"noise": noise})


def require_scene(value: object) -> None:
    """Refuse, as the first argument of a public function, what is no scene."""
    if not isinstance(value, Scene):
        raise SceneError(f"scene is {quoted(value)}; write {_meant(value)}")


def _meant(value):
    """Guess which scene somebody has in mind who gave something else."""
    match value:
        case str():
            near = difflib.get_close_matches(value.lower(), MODELS, n=1)
            return f"nonsmooth.Scene({(near or ['friction'])[0]!r})"
        case Mapping():
            return "nonsmooth.Scene(**scene)"
        case Model():
            return "nonsmooth.Scene(model)"
    return "nonsmooth.Scene('friction'), for example"


def require_velocity(scene: Scene, cure: str) -> None:
    """Refuse, for a solver, a scene whose g is a function of the noise alone."""
    if "y" not in scene.state:
        raise SceneError(
            f"g = {quoted(scene.observable)} is a function of the noise alone, which the solvers "
            f"do not take without the velocity; {cure}"
        )


def uncentred(what: str, scene: Scene, mean: float, cure: str = "subtract it from g") -> SceneError:
    """Make the error of a formula that needs E g = 0."""
    return SceneError(
        f"{what} needs E g = 0, but g = {quoted(scene.observable)} has the mean {mean:.10g}; {cure}"
    )


def require_random(scene: object) -> None:
    """Refuse what is no scene, and a scene whose g is constant, so that it has no state."""
    require_scene(scene)
    if isinstance(scene, Scene) and not scene.state:
        raise SceneError(
            f"g = {quoted(scene.observable)} is constant; choose an observable with variables"
        )
