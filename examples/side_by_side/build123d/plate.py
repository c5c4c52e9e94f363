from build123d import Box, Cylinder, GridLocations

part = Box(90, 60, 4) - GridLocations(20, 15, 4, 3) * Cylinder(2.5, 6)
print(part.volume)
