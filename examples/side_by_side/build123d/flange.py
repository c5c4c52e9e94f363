from build123d import Align, CounterBoreHole, Cylinder, Plane, PolarLocations

up = (Align.CENTER, Align.CENTER, Align.MIN)
body = Cylinder(60, 14, align=up) + Cylinder(30, 40, align=up) - Cylinder(22.5, 40, align=up)
part = body - Plane.XY.offset(14) * PolarLocations(45, 6) * CounterBoreHole(4.5, 7.5, 5, 14)
print(part.volume)
