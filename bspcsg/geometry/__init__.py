"""Points, hyperplanes, polygons and motions, before there are meshes."""
