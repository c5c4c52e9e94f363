from build123d import Circle, Plane, Polyline, Transition, sweep

path = Polyline((0, 0, 0), (30, 0, 0), (30, 30, 0), (30, 30, 30))
part = sweep(Plane.YZ * (Circle(4) - Circle(3)), path, transition=Transition.RIGHT)
print(part.volume)
