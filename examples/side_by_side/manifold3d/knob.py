from itertools import product

from manifold3d import Manifold

corners = product((-17, 17), (-12, 12), (-3, 3))
body = Manifold.batch_hull([Manifold.sphere(3, 32).translate(corner) for corner in corners])
part = body - Manifold.cylinder(20, 4, 4, 32, True)
print(part.volume())
