"""The kinetic equation of two state variables in time: q_t = A q + g q_x by Strang's splitting.

- `split_step.SplitStep`: what a scheme must do, and the transport by g that all share.
- `coefficients.CoefficientSteps`: exp(A t) as a dense matrix, on any grid.
- `tensor.TensorSteps`: exp(A t) by alternating directions, on tensor grids.
"""
