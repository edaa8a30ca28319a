"""The effect of a larger box, tried on finer and finer levels."""

from nonsmooth.grids.mesh.box_effect import BoxEffect


def test_finer_levels_are_tried_only_while_the_effect_is_too_large():
    """Each level is tried once, and the smallest change counts."""
    changes, tried = [8.0, 4.0, 5.0, 1.0], []

    def change(level):
        tried.append(level)
        return changes[level]

    box = BoxEffect(change, float)
    assert box.below(0, 3, lambda effect: effect <= 9) == 8
    assert box.below(0, 1, lambda effect: effect <= 3) == 4
    assert box.below(0, 2, lambda effect: effect <= 3) == 4
    assert box.below(0, 3, lambda effect: effect <= 5) == 4
    assert tried == [0, 1, 2]
    assert box.below(0, 3, lambda effect: effect <= 3) == 1
