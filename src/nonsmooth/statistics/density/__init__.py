"""The density that the state settles to (Theorem 4 of the paper), and its marginals.

- `invariant_density.invariant_density`: the public function, which chooses between
- `closed_form.closed_form`: dry friction and obstacles with white noise,
- `on_grids.solved_densities`: the discretised invariant measure, and
- `sampled.sampled_densities`: histograms of simulated paths, also at n = inf.
- `bins.bin_averages`: probabilities of bins without Monte Carlo.
"""
