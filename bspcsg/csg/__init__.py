"""OpenSCAD's `.csg` scripts: read, evaluated and written."""
