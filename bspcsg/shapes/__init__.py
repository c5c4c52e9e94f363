"""Solids by name, and solids swept from plane polygons."""
