"""Points, hyperplanes, polygons and motions, on which meshes are built."""
