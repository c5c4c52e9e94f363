"""Assemblies: named, coloured, placed solids."""
