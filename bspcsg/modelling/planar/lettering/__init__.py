"""Text as plane figures: fonts, glyphs and their layout."""
