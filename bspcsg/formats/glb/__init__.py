"""Reading and writing GLB, the binary form of glTF."""
