"""Solids: the value, the expression behind it, and its measures."""
