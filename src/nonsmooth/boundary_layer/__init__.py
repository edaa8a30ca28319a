"""The boundary layer at a threshold: what int g does there that Brownian motion does not.

int g is differentiable, so it meets a threshold with g > 0, and cannot turn there at once. In a
layer below the threshold it obeys the Milne problem, a kinetic equation in a half space, whose
constants correct the asymptotic formula for crossing probabilities; the first is the extrapolation
length kappa. The manual derives them in `docs/methods/boundary_layer.md`.

- `extrapolation_length.extrapolation_length`: kappa of any scene for which it is known.
- `milne.layer_constants`: all constants, by the method that the scene allows.
- `constants.LayerConstants`: the record of them, which every method returns.
- `symmetric_line.layer_constants`: one variable, odd g; up to the order 3.
- `asymmetric_line.layer_constants`: one variable, any g; up to the order 3.
- `two_variables.layer_constants`: two variables, odd g; up to the order 3.
- `half_space.constants`: the Milne problem of two variables and its adjoint on one grid.
- `sampled.sampled_kappa`, `sampled.sampled_poisson`: any odd g, by Monte Carlo; the order 1.
- `cycles.followed`: paths that pass thresholds again and again, and their states then.
- `poisson.mean_at`: the Poisson solution at such states, on grids.
- `tuning`: resolutions and switching points.
"""
