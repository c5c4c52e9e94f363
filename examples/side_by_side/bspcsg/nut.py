import bspcsg as csg

profile = [(7, 1.5), (8.5, 0), (11.5, 0), (16, 2.6), (16, 10.4), (11.5, 13), (8.5, 13), (7, 11.5)]
part = csg.Region.regular_polygon(6, flats=24).extrude(13) & csg.revolve(profile)
print(part.volume)
