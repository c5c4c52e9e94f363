"""Interactive 3D views of meshes in a browser."""
