"""The three mechanical models of the paper (Figure 1, Tables 1 and 3)."""

from dataclasses import dataclass

import sympy

from nonsmooth.scenes.penalties import ABSOLUTE_VALUE, BARRIER, Penalty

zeta, eta, y, x = sympy.symbols("zeta eta y x", real=True)
STATE_VARIABLES = (zeta, eta, y, x)
damping = sympy.Symbol("C_b", positive=True)


def oscillator(velocity_penalty, displacement_penalty, potential_slope, forcing):
    """Return the drift of (y, x) common to all models (eq. dynZnFn, Table 2).

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
    """A mechanical model: where the penalty reads its argument and where it acts.

    Attributes
    ----------
    name, title : str
    inequality : str
        Which of the paper's two stochastic variational inequalities: ``"SVI-1"``, ``"SVI-2"``.
    penalty : Penalty
    argument : sympy.Symbol
        The variable whose penalty it is.
    equation : sympy.Symbol
        The equation of motion in which the penalty force stands.
    force_name : str
        What the penalty force is called, as an observable.
    """

    name: str
    title: str
    inequality: str
    penalty: Penalty
    argument: sympy.Symbol
    equation: sympy.Symbol
    force_name: str

    @property
    def penalty_force(self):
        """The penalty force phi_n', a sympy expression in `argument`."""
        return self.penalty.force(self.argument)

    @property
    def in_potential(self):
        """Whether the penalty force is conservative, so that it belongs to U_n (Table 3)."""
        return self.argument != self.equation and self.equation == y

    @property
    def velocity_penalty(self):
        """f_{n,y}(y) of Table 3."""
        return self.penalty_force if self.argument == self.equation == y else sympy.Integer(0)

    @property
    def displacement_penalty(self):
        """f_{n,x}(x) of Table 3."""
        return self.penalty_force if self.equation == x else sympy.Integer(0)

    @property
    def added_potential(self):
        """U_n(x) - U(x) of Table 3."""
        return self.penalty.potential(x) if self.in_potential else sympy.Integer(0)

    def drift(self, potential, forcing):
        """Return the drift of (y, x) for a potential U(x) and a forcing term (Table 2).

        The obstacle's force is entered as such; it is the derivative of `added_potential`.
        """
        slope = sympy.diff(potential, x) + (self.penalty_force if self.in_potential else 0)
        return oscillator(self.velocity_penalty, self.displacement_penalty, slope, forcing)


ELASTO_PLASTIC = Model(
    name="elasto_plastic",
    title="Elasto-perfectly-plastic",
    inequality="SVI-1",
    penalty=BARRIER,
    argument=x,
    equation=x,
    force_name="plastic_strain_rate",
)
FRICTION = Model(
    name="friction",
    title="Friction",
    inequality="SVI-1",
    penalty=ABSOLUTE_VALUE,
    argument=y,
    equation=y,
    force_name="friction_force",
)
OBSTACLE = Model(
    name="obstacle",
    title="Obstacle",
    inequality="SVI-2",
    penalty=BARRIER,
    argument=x,
    equation=y,
    force_name="contact_force",
)
MODELS = {model.name: model for model in (ELASTO_PLASTIC, FRICTION, OBSTACLE)}
