"""The mesh of a scene: a box that holds its invariant density, cut into elements.

The state space is unbounded, but outside a box the density is too small to matter. Along each
variable the box is cut into elements whose edges lie on the kinks of the drift and crowd together
there, so that the solution is smooth within each element.

- `box.half_widths`, `box.narrowed`: how large the box must be; `box.suits`: whether there is one.
- `box_effect.BoxEffect`: what a larger box changes.
- `edges.kinks`, `edges.potentials`, `edges.element_edges`: where the elements end.
- `layers.is_held`, `layers.resolves_layer`, `layers.misses_layer`, `layers.layered_edges`: the same
  for densities that are concentrated along a line.
- `hermite.hermite`: polynomials of a normal variable, in the place of elements.
- `axes.variables`, `axes.axes`: nodes, weights and derivatives on these elements.
"""
