"""Simulation: paths of a scene, and averages over many of them with their errors.

Equations of motion are split into parts whose flows are known exactly, so that the time step need
not become shorter as n grows. A thousand paths at a time advance side by side: a block of paths.
The noise of a path depends on the seed, on the scene without n, and on the number of the path, and
not on how many threads there are. The bias of the time step is measured by simulating paths with
the step and with half of it on the same noise.

- `simulation.simulate`: statistics of int g, or paths, to a tolerance
- `sampling.Sampling`: step, paths, seed, threads, scheme and precision of one Monte Carlo run
- `ensembles`: `gram`, `integrals_at`, `paths_at` and `coupled` run an ensemble
- `moments.moments`, `moments.step_bias`: mean and variance of int g, and the bias of the step
- `resolution`: how many paths and how long a step a tolerance takes
- `time_loop.march`: the loop over time steps
- `parallel.parallel`: blocks of paths on several threads, which Ctrl-C stops
- `cost`: what a simulation would cost; what nobody can wait for is refused
- `absorption.survival.crossed`: how many paths have left an interval of the state
- `absorption.passages.coupled_passages`: first-passage times of int g with two steps
- `time_grids`, `control_variate`: output times; a variable of known mean that reduces the
  standard error
- `schemes` holds the time-stepping schemes, `kernels` what they are built from
"""
