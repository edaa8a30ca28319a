"""Simulation: paths of a scene, and averages over many of them with their errors.

Equations of motion are split into parts whose flows are known exactly, so that the time step need
not follow the penalization. A thousand paths at a time advance side by side, each with a random
stream that depends on the seed and the number of the path only. Paths with a step and with half of
it on the same noise measure the bias of the step.

- `simulation.simulate`: statistics of int g, or paths, to a tolerance
- `sampling.Sampling`: step, paths, seed, threads, scheme and precision of one Monte Carlo run
- `ensembles`: `gram`, `integrals_at`, `paths_at` and `coupled` run an ensemble
- `moments.moments`, `moments.step_bias`: mean and variance of int g, and the bias of the step
- `resolution`: how many paths and how long a step a tolerance takes
- `time_loop.march`: the loop over time steps
- `time_grids`, `control_variate`: output times, and what reduces the variance
- `schemes` holds the time-stepping schemes, `kernels` what they are built from
"""
