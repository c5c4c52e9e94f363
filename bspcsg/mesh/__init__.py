"""Triangle meshes: the type `Mesh`, exact checks, and conversion to and from other libraries."""
