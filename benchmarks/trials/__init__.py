"""Destructive trials: what happens on bad configurations, bad arguments and damaged files."""
