"""An oscillator with dry friction: a force of size at most 1 against the velocity."""

from nonsmooth.scenes.models.model import Model
from nonsmooth.scenes.penalties import ABSOLUTE_VALUE
from nonsmooth.scenes.symbols import y

FRICTION = Model(
    name="friction",
    title="Friction",
    inequality="SVI-1",
    penalty=ABSOLUTE_VALUE,
    argument=y,
    equation=y,
    force_name="friction_force",
)
