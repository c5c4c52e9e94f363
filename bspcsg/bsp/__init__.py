"""Partition trees as tools of their own, in one, two and three dimensions."""

from .adaptive import AdaptiveTree, StabStats, StabTree, StaticTree, Tests
from .distribution import optimised_tree, scores
from .rays import EDGE, INTERIOR, MISS, VERTEX, HitLists, Hits, Intervals, RayCaster

__all__ = [
    "EDGE",
    "INTERIOR",
    "MISS",
    "VERTEX",
    "AdaptiveTree",
    "HitLists",
    "Hits",
    "Intervals",
    "RayCaster",
    "StabStats",
    "StabTree",
    "StaticTree",
    "Tests",
    "optimised_tree",
    "scores",
]
