"""The content of a written file, read by its layout alone: arrays, object by object.

These are no readers: they take the very layout that the writers of this package make, byte for
byte, and nothing else. They share no code with the writers, and every byte that tells of a triangle
is read.
"""
