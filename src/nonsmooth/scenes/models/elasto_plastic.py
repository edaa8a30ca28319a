"""An elasto-perfectly-plastic oscillator: x is its elastic deformation, whose limit is 1."""

from nonsmooth.scenes.models.model import Model
from nonsmooth.scenes.penalties import BARRIER
from nonsmooth.scenes.symbols import x

ELASTO_PLASTIC = Model(
    name="elasto_plastic",
    title="Elasto-perfectly-plastic",
    inequality="SVI-1",
    penalty=BARRIER,
    argument=x,
    equation=x,
    force_name="plastic_strain_rate",
)
