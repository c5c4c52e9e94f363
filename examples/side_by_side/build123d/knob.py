from build123d import Box, Cylinder, fillet

body = Box(40, 30, 12)
part = fillet(body.edges(), 3) - Cylinder(4, 20)
print(part.volume)
