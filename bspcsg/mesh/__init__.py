"""Meshes: what they are, what is proven of them, and how other libraries' come in and out."""
