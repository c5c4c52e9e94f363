"""Mesh files as bytes: STL, OBJ, PLY, OFF, 3MF, GLB, and VTK through meshio."""
