"""Few combinations of nodes in which the kinetic equation is solved at many places z.

Solutions at all depths and all z of interest lie close to a space of few dimensions, which those at
a few z span.

- `reduced_line.on_line`: with one state variable, on a vertical line of places.
- `fields.fields`: solutions at many depths with two, by modes.
- `doubled_slabs.fields`: the same by doubling of slabs, where modes are nearly parallel.
- `reduced_ordinates.reduced`: the basis that they span, and the transform in it.
"""
