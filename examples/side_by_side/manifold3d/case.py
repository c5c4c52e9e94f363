from manifold3d import CrossSection, JoinType

outline = CrossSection.square((68, 38), True).offset(6, JoinType.Round, circular_segments=32)
room = outline.offset(-2).extrude(28).translate((0, 0, 2))
rim = outline.offset(-1).extrude(2).translate((0, 0, 28))
part = outline.extrude(30) - room - rim
print(part.volume())
