"""Points, hyperplanes, polygons and transforms: the geometry on which meshes are built."""
