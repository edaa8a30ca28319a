"""Rare crossings by paths that are led to the threshold and weighted.

- `importance_sampling.importance_sampled_crossing`: probabilities to a tolerance.
- `choice.leading_is_quicker`: whether that is quicker than counting paths.
"""
