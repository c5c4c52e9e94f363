"""Python scripts that make a solid."""
