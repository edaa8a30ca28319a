"""An oscillator between two obstacles, at the displacements -1 and 1, which it hits elastically."""

from nonsmooth.scenes.models.model import Model
from nonsmooth.scenes.penalties import BARRIER
from nonsmooth.scenes.symbols import x, y

OBSTACLE = Model(
    name="obstacle",
    title="Obstacle",
    inequality="SVI-2",
    penalty=BARRIER,
    argument=x,
    equation=y,
    force_name="contact_force",
)
