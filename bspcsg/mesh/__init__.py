"""Meshes: the type, its certificate, and the exchange with other libraries."""
