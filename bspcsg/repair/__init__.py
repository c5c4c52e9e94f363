"""What is wrong with a mesh, and closing it."""
