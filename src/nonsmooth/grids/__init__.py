"""Functions of the state on tensor grids."""
