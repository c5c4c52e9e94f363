from build123d import Box, Text, extrude

name = Text("Workshop", font_size=11.1, font="Liberation Sans")
part = Box(60, 16, 2) + extrude(name, 2)
print(part.volume)
