"""The kinetic equation between two thresholds."""
