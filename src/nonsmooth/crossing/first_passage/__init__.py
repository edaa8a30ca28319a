"""First passage without Monte Carlo."""
