"""Functions that make solids and regions of others, or of points, curves and functions."""
