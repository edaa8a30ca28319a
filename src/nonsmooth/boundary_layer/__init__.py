"""The boundary layer at a threshold."""
