"""Long-time statistics."""
