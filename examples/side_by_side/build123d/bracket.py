from build123d import Align, Box, Cylinder, GridLocations, Plane, Polygon, Pos, Rot, extrude

legs = Box(50, 40, 5, align=Align.MIN) + Box(5, 40, 50, align=Align.MIN)
triangle = Plane.XZ * Polygon((0, 0), (35, 0), (0, 35), align=None)
rib = Pos(0, 20, 0) * extrude(triangle, 2.5, both=True)
holes = GridLocations(0, 24, 1, 2) * Cylinder(3, 20)
part = legs + rib - Pos(38, 20, 0) * holes - Pos(0, 20, 38) * Rot(0, 90, 0) * holes
print(part.volume)
