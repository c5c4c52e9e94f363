"""Solids from solids: hulls, sums, cuts, gaps, refinement, functions of points."""
