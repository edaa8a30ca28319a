"""Scenes with one state variable."""
