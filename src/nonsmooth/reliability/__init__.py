"""Reliability: what follows from crossing probabilities, with errors that follow from theirs.

The derivations are in `docs/methods/reliability.md`.

- `quantiles.crossing_threshold`: the threshold that is crossed with a given probability;
  `quantiles.failure_time`: the time by which it is, such as the median time to failure.
- `mean_time.mean_time_to_failure`: the mean time of the first passage, by `transformed_mean` or
  `sampled_mean`.
- `hazard.hazard_rate`: the rate at which those cross that have not crossed yet.
- `index.reliability_index`: the index beta of crossing probabilities.
- `roots`: where W takes a value, with limits from the limits of W.
- `reach`: how far int g gets, with which a search begins.
- `tuning`: resolutions.
"""
