from manifold3d import Manifold, OpType

hole = Manifold.cylinder(6, 2.5, 2.5, 32, True)
places = [(20 * i - 30, 15 * j - 15, 0) for i in range(4) for j in range(3)]
holes = Manifold.batch_boolean([hole.translate(place) for place in places], OpType.Add)
part = Manifold.cube((90, 60, 4), True) - holes
print(part.volume())
