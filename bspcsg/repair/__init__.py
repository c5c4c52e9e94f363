"""Diagnosis of the defects of meshes, and repair by pymeshlab."""
