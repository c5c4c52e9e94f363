from manifold3d import CrossSection, Manifold

triangle = CrossSection([[(0, 0), (35, 0), (0, 35)]])
rib = triangle.extrude(5).rotate((90, 0, 0)).translate((0, 22.5, 0))
body = Manifold.cube((50, 40, 5)) + Manifold.cube((5, 40, 50)) + rib
hole = Manifold.cylinder(5, 3, 3, 32)
holes = hole.translate((38, 8, 0)) + hole.rotate((0, 90, 0)).translate((0, 8, 38))
part = body - holes - holes.translate((0, 24, 0))
print(part.volume())
