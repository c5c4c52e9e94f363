"""Sets of points on the line, in the plane and in space, as trees with in and out leaves."""
