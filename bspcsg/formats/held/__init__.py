"""The content of written files as arrays, object by object, for the proof of a file.

These modules are no general readers: they accept only the exact layout that the writers of this
package make. They share no code with the writers, and read every byte that describes a triangle.
"""
