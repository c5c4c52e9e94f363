"""Plane figures: offsets, hulls, curves, text, projections of solids."""
