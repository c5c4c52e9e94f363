from manifold3d import Manifold, OpType

body = Manifold.cylinder(14, 60, 60, 32) + Manifold.cylinder(40, 30, 30, 32)
bore = Manifold.cylinder(40, 22.5, 22.5, 32)
hole = Manifold.cylinder(14, 4.5, 4.5, 32) + Manifold.cylinder(5, 7.5, 7.5, 32).translate((0, 0, 9))
holes = [hole.translate((45, 0, 0)).rotate((0, 0, 60 * k)) for k in range(6)]
part = Manifold.batch_boolean([body, bore, *holes], OpType.Subtract)
print(part.volume())
