"""Readers that return the objects of a written file as arrays, to check that file.

They accept only the exact layout that the writers of this package make. They share no code with the
writers, and read every byte that describes a triangle.
"""
