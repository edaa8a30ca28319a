"""Table 4: what the paper prints for a scene and a horizon."""

from collections.abc import Mapping

from nonsmooth.scenes.scene import Scene
from reproduction.rendering.printed import printed_values


def printed_in_table_4(scene: Mapping, horizon: float) -> dict[float, float]:
    """Return v(0, T)/T as the paper prints it.

    Parameters
    ----------
    scene : mapping
        Parameters of a scene, without n.
    horizon : float
        T.

    Returns
    -------
    dict
        From n to the printed value; empty if the scene or the horizon is not that of the paper.
    """
    paper = printed_values("tab:convergence-vng-n")
    same = Scene(**scene) == Scene(**paper["scene"]) and horizon == paper["horizon"]
    return paper["values"] if same else {}
