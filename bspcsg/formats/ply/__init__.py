"""Reading and writing PLY, the Stanford polygon format."""
