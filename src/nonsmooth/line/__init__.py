"""Scenes with one state variable: the velocity y of dry friction under white noise.

The velocity then solves dY = -b(Y) dt + sigma dW, and the generator A = (sigma^2/2) d_yy - b d_y
is self-adjoint in the space of square-integrable functions weighted by the invariant density m.
Everything that the library asks of such a scene is an integral over m or follows from the
eigenfunctions of A, to nearly full precision. The manual page is `docs/methods/line.md`.

- `potential.potential`, `potential.depth`: Phi = -log m, up to a constant.
- `quadrature.asymptotic_variance`, `quadrature.mean`, `quadrature.density`: gamma^2, E g and m.
- `spectral_elements.mesh`: the elements of Galerkin's method.
- `eigenfunctions.spectrum`, `eigenfunctions.moments`: eigenpairs of -A; mean and variance of
  int_0^t g at finite times.
- `dry_friction.friction_variance`: gamma^2 for g(y) = y in closed form but for one integral.
- `finite_differences.moments`: the paper's own scheme.
- `kinks.switches`, `kinks.sign_changes`, `kinks.isolated_zeros`: where a formula may have a kink,
  changes its sign, or vanishes.
"""
