from manifold3d import CrossSection, Manifold

profile = [(7, 1.5), (8.5, 0), (11.5, 0), (16, 2.6), (16, 10.4), (11.5, 13), (8.5, 13), (7, 11.5)]
body = Manifold.cylinder(13, 24 / 3**0.5, circular_segments=6)
part = body ^ CrossSection([profile]).revolve(32)
print(part.volume())
