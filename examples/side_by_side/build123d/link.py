from build123d import Axis, Circle, Cylinder, Plane, Pos, make_hull, revolve, split

outline = make_hull((Pos(-20, 0) * Circle(6) + Pos(20, 0) * Circle(10)).edges())
part = revolve(split(outline, Plane.XZ), Axis.X) - Pos(20, 0, 0) * Cylinder(4, 30)
print(part.volume)
