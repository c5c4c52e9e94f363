"""Meshes to turn in a browser."""
