"""The attributes of a mesh besides its shape: named arrays of vertices, corners and faces."""
