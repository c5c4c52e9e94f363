"""What nodes are made of: numbers of sides, offsets, drawings, height fields."""
