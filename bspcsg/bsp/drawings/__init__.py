"""Regions of the plane as drawings: reading and writing SVG and DXF files."""
