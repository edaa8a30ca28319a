"""What only the paper needs."""
