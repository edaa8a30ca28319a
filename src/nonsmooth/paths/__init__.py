"""Simulation of paths."""
