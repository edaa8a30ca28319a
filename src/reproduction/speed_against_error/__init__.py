"""Work-precision diagrams."""
