from shapely import box
from trimesh.creation import extrude_polygon

outline = box(-34, -19, 34, 19).buffer(6, quad_segs=8)
room = extrude_polygon(outline.buffer(-2), 28).apply_translation((0, 0, 2))
rim = extrude_polygon(outline.buffer(-1), 2).apply_translation((0, 0, 28))
part = extrude_polygon(outline, 30).difference([room, rim])
print(part.volume)
