"""What a mesh says besides its shape: named arrays of vertices, corners and faces."""
