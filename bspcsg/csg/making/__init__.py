"""The making of nodes: numbers of sides, offsets, drawings, height fields."""
