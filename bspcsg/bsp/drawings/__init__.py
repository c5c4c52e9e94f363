"""Regions of the plane as drawings: SVG and DXF."""
