"""The attributes of a mesh other than its shape: named arrays of vertices, corners and faces."""
