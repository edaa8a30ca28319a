"""Crossing probabilities."""
