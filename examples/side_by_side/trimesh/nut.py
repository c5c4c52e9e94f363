from trimesh.creation import cylinder, revolve

profile = [(7, 1.5), (8.5, 0), (11.5, 0), (16, 2.6), (16, 10.4), (11.5, 13), (8.5, 13), (7, 11.5)]
body = cylinder(24 / 3**0.5, 13, 6).apply_translation((0, 0, 6.5))
part = body.intersection(revolve([*profile, profile[0]], sections=32))
print(part.volume)
