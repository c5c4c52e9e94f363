from build123d import Pos, RectangleRounded, extrude

body = extrude(RectangleRounded(80, 50, 6), 30)
room = Pos(0, 0, 2) * extrude(RectangleRounded(76, 46, 4), 28)
rim = Pos(0, 0, 28) * extrude(RectangleRounded(78, 48, 5), 2)
part = body - room - rim
print(part.volume)
