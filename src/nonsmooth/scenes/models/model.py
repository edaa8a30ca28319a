"""What a mechanical model is, and how to add one."""

from dataclasses import dataclass

import sympy

from nonsmooth.errors import SceneError
from nonsmooth.scenes.penalties import ABSOLUTE_VALUE, Penalty
from nonsmooth.scenes.symbols import damping, x, y

# (argument, equation) of a penalty: a friction force, plastic flow, a spring
_PLACES = ((y, y), (x, x), (x, y))


def oscillator(
    velocity_penalty: sympy.Expr,
    displacement_penalty: sympy.Expr,
    potential_slope: sympy.Expr,
    forcing: sympy.Expr,
) -> dict[sympy.Symbol, sympy.Expr]:
    """Return the drift of (y, x) common to all models (eq. (5) and Table 2 of the paper).

    Parameters
    ----------
    velocity_penalty, displacement_penalty, potential_slope, forcing : sympy.Expr
        f_{n,y}, f_{n,x}, U' (or U_n') and the forcing term of the velocity equation.

    Returns
    -------
    dict
        Maps the symbols y and x to their drifts.
    """
    return {
        y: forcing - potential_slope - damping * y - velocity_penalty,
        x: y - displacement_penalty,
    }


@dataclass(frozen=True)
class Model:
    """A mechanical model: what its penalty is, which variable it reads and where it acts.

    How to add one: make an instance in a file of its own and hand it to `Scene(model=...)`;
    nothing else has to be changed. Everything that the library asks of a model is a property of
    this class and follows from its penalty. The penalty may read and act in three ways:

    ==========  ==========  ======================================================
    `argument`  `equation`  the penalty force is
    ==========  ==========  ======================================================
    y           y           a friction force, as in the friction model
    x           x           a plastic flow of x, as in the elasto-plastic model
    x           y           the force of a spring, as in the obstacle model
    ==========  ==========  ======================================================

    All solvers on grids take any penalty. The default scheme of `simulate` has exact flows for
    all but springs that also act below the knot, and for the paper's own penalties at n = inf;
    other scenes are simulated by the Euler-Maruyama scheme. `examples/dead_zone.py` is a fourth
    model.

    Attributes
    ----------
    name, title : str
        The name tells models apart. A model with parameters has them in its name, see
        `examples/dead_zone.py`. The title is for messages and captions.
    inequality : str
        Which of the paper's two stochastic variational inequalities: ``"SVI-1"``, ``"SVI-2"``.
    penalty : Penalty
        Its potential and force, with the position of the kinks.
    argument : sympy.Symbol
        The variable that the penalty reads.
    equation : sympy.Symbol
        The equation of motion in which the penalty force stands.
    force_name : str
        What the penalty force is called, as an observable.

    Raises
    ------
    SceneError
        If the penalty acts in none of the three ways, or reads the displacement and does not grow
        with it.
    """

    name: str
    title: str
    inequality: str
    penalty: Penalty
    argument: sympy.Symbol
    equation: sympy.Symbol
    force_name: str

    def __post_init__(self) -> None:
        if (self.argument, self.equation) not in _PLACES:
            known = ", ".join(f"({a}, {e})" for a, e in _PLACES)
            raise SceneError(
                f"the penalty of the model {self.name!r} reads {self.argument} and acts on "
                f"{self.equation}; choose (argument, equation) from {known}"
            )
        if self.argument == x and not self.penalty.at(1.0)[2] > 0:
            raise SceneError(
                f"the penalty of the model {self.name!r} does not grow with the displacement; "
                "choose a penalty with outer > 0"
            )

    @property
    def penalty_force(self) -> sympy.Expr:
        """The penalty force phi_n', a sympy expression in `argument`."""
        return self.penalty.force(self.argument)

    @property
    def is_friction(self) -> bool:
        """Whether the penalty force is a friction force, which reads the velocity."""
        return self.argument == y

    @property
    def is_dry_friction(self) -> bool:
        """Whether it is the dry friction of the paper, of size 1, which has closed forms."""
        return self.is_friction and self.penalty == ABSOLUTE_VALUE

    @property
    def is_plastic(self) -> bool:
        """Whether the penalty force is a flow of the displacement."""
        return self.equation == x

    @property
    def in_potential(self) -> bool:
        """Whether the penalty force is conservative, so that it belongs to U_n (Table 3)."""
        return self.argument == x and self.equation == y

    @property
    def default_observable(self) -> str:
        """The observable of a scene that names none: its integral must not stay bounded."""
        return "x" if self.in_potential else "y"

    @property
    def wall(self) -> float:
        """The displacement that n = inf does not let the oscillator pass, inf if there is none."""
        knot, _, outer = self.penalty.at(float("inf"))
        return knot if self.argument == x and outer == float("inf") else float("inf")

    @property
    def confines_displacement(self) -> bool:
        """Whether the displacement stays between walls at n = inf."""
        return self.wall < float("inf")

    @property
    def velocity_penalty(self) -> sympy.Expr:
        """f_{n,y}(y) of Table 3."""
        return self.penalty_force if self.is_friction else sympy.Integer(0)

    @property
    def displacement_penalty(self) -> sympy.Expr:
        """f_{n,x}(x) of Table 3."""
        return self.penalty_force if self.is_plastic else sympy.Integer(0)

    @property
    def added_potential(self) -> sympy.Expr:
        """U_n(x) - U(x) of Table 3."""
        return self.penalty.potential(x) if self.in_potential else sympy.Integer(0)

    def drift(self, potential: sympy.Expr, forcing: sympy.Expr) -> dict[sympy.Symbol, sympy.Expr]:
        """Return the drift of (y, x) for a potential U(x) and a forcing term (Table 2).

        The force of a spring is added to U'(x) as a formula of its own, because it is simpler than
        the derivative of `added_potential`, which it equals.
        """
        slope = sympy.diff(potential, x) + (self.penalty_force if self.in_potential else 0)
        return oscillator(self.velocity_penalty, self.displacement_penalty, slope, forcing)
