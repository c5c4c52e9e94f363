"""Figures of the plane: offsets, hulls, curves, text, shadows of solids."""
