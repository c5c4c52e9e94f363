"""The growth of partition trees: fragments against facets, with the bounds."""

import bspcsg as csg
from bspcsg.bsp import analysis

balls = [csg.sphere(1, segments=count) for count in (16, 32, 64, 128)]
table = analysis.growth_table((50, 100, 200, 400, 800, 1600), (16, 32, 64, 128), balls, trials=3)
print(table)
