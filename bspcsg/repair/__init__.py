"""The diagnosis of a mesh, and its repair."""
