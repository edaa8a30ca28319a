"""Time scales of penalized scenes."""

from nonsmooth.scenes.scene import Scene


def contact_time(scene: Scene) -> float:
    """Time scale of the penalty, which steps must resolve.

    An elastic contact takes a time of the order n^(-1/2), a relaxation 1/n. A Brownian velocity
    crosses |y| < 1/n in a time of the order n^(-2).
    """
    if scene.mechanics.in_potential:
        return scene.n**-0.5
    diffuses = scene.mechanics.argument == scene.noise.driven
    return scene.n**-2.0 if diffuses else 1 / scene.n
