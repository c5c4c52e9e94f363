from build123d import Plane, Polygon, RegularPolygon, extrude, revolve

profile = [(7, 1.5), (8.5, 0), (11.5, 0), (16, 2.6), (16, 10.4), (11.5, 13), (8.5, 13), (7, 11.5)]
body = extrude(RegularPolygon(12, 6, major_radius=False), 13)
part = body & revolve(Plane.XZ * Polygon(profile, align=None))
print(part.volume)
