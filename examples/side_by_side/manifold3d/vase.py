from manifold3d import CrossSection, Manifold

part = Manifold.extrude(CrossSection.circle(20, 6), 60, 59, -90)
print(part.volume())
