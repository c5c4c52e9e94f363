from build123d import Pos, RegularPolygon, Rot, loft

turned = [Pos(0, 0, k) * Rot(0, 0, -1.5 * k) * RegularPolygon(20, 6) for k in range(61)]
part = loft(turned, ruled=True)
print(part.volume)
