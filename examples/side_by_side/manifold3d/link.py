from manifold3d import Manifold

left, right = Manifold.sphere(6, 32).translate((-20, 0, 0)), Manifold.sphere(10, 32)
body = Manifold.batch_hull([left, right.translate((20, 0, 0))])
part = body - Manifold.cylinder(30, 4, 4, 32, True).translate((20, 0, 0))
print(part.volume())
