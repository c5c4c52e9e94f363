"""Partition trees as tools of their own, in one, two and three dimensions."""

from .rays import EDGE, INTERIOR, MISS, VERTEX, HitLists, Hits, Intervals, RayCaster

__all__ = ["EDGE", "INTERIOR", "MISS", "VERTEX", "HitLists", "Hits", "Intervals", "RayCaster"]
