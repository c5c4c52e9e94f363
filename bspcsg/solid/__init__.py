"""Solids: the value, the expression it stands for, and what can be measured of it."""
