"""The models that a scene may call by their names."""

from nonsmooth.scenes.models.elasto_plastic import ELASTO_PLASTIC
from nonsmooth.scenes.models.friction import FRICTION
from nonsmooth.scenes.models.model import Model
from nonsmooth.scenes.models.obstacle import OBSTACLE

MODELS: dict[str, Model] = {model.name: model for model in (ELASTO_PLASTIC, FRICTION, OBSTACLE)}
