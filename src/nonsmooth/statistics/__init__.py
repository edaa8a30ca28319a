"""Long-time statistics: what the state and int g settle to.

By Theorem 6 of the paper the variance of int_0^t g grows like gamma^2 t. Each quantity has one
public function, which chooses between methods by the scene and the tolerance.

- `asymptotic_variance.asymptotic_variance`: gamma^2
- `mean.mean`: E g
- `variance.variance`: mean and variance of int_0^tau g over finite times
- `density.invariant_density`: the density that the state settles to
- `spectral_gap.spectral_gap`: the rate at which correlations decay
- `gamma2_on_grids`, `moments_on_grids`: gamma^2 and v(0, tau) on grids of elements
- `sampled_gamma2`, `sampled_moments`: the same by Monte Carlo
- `combined_grids.combined`: a functional of three and four variables to a tolerance.
"""
