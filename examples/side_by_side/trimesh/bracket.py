import trimesh
from trimesh.creation import box, cylinder

legs = [box(bounds=[(0, 0, 0), (50, 40, 5)]), box(bounds=[(0, 0, 0), (5, 40, 50)])]
corners = [(x, y, z) for y in (17.5, 22.5) for x, z in [(0, 0), (35, 0), (0, 35)]]
body = trimesh.boolean.union([*legs, trimesh.PointCloud(corners).convex_hull])
feet = [cylinder(3, segment=[(38, y, -1), (38, y, 6)], sections=32) for y in (8, 32)]
backs = [cylinder(3, segment=[(-1, y, 38), (6, y, 38)], sections=32) for y in (8, 32)]
part = body.difference([*feet, *backs])
print(part.volume)
