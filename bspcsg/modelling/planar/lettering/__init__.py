"""Text as figures of the plane: which font, which glyphs, where they go."""
