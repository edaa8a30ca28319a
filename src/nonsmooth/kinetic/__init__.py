"""The kinetic equation between two thresholds.

Let tau be the first time at which x + int_0^t g leaves an interval. Its Laplace transform
h(x, Z) = E exp(-z tau), Z the state, solves

    (z - A) h = g d_x h,    h = 1 where the flow leaves: at the upper wall for g > 0, at the lower
                            one for g < 0.

This is the equation of one-dimensional radiative transfer: x is the depth in a slab, g the
direction cosine, A the scattering. The methods here are those of that field. The state is
discretised by nodes (discrete ordinates). In x the solution is exact with Case's elementary
solutions. Those of all nodes, at a few z, span a basis of few combinations of nodes, in which they
are taken at all others. The manual page is `docs/methods/kinetic.md`.

- `ordinates_line.ordinates`: nodes of one state variable, in the space L^2(m).
- `ordinates_plane.plane_ordinates`, `ordinates_gibbs.gibbs_ordinates`: nodes of two, in general
  and where the invariant density is known.
- `case_modes.modes`: elementary solutions, for one variable.
- `derivatives`: of the transform with respect to parameters.
- `bases`: few combinations of nodes that solutions at many depths span.
- `marching`: the equation in time, by Strang's splitting.
- `tail_descent.tail`: a start so far in the tails that the modes cancel; the state falls from there
  to a level near the bulk.
- `tail_equation.equation`: the kinetic equation on the way down, marched in x.
"""
