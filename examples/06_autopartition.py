"""Autopartition: a tree over segments, and the bounds of the lecture measured."""

import bspcsg as csg
from bspcsg import bsp
from bspcsg.bsp import analysis

segments = analysis.disjoint_segments(24, seed=3)
tree = bsp.PartitionTree(segments, "random", seed=1)
print(tree, "cuts", len(tree.splits), "times")

print("\nFragments and time, against n + 2 n ln n (segments), n² (grid), n (surfaces):")
balls = [csg.sphere(1, segments=count) for count in (16, 32, 64)]
print(analysis.growth_table((100, 200, 400, 800), (16, 32, 64, 128), balls, trials=3))

print("\nHow often the line of one segment cuts another, by what lies between (4000 orders):")
rows = analysis.cut_frequencies(segments, trials=4000)
for distance in sorted({row.distance for row in rows}):
    shares = [row.frequency for row in rows if row.distance == distance]
    print(
        f"  distance {distance}: at most {1 / (distance + 2):.3f},"
        f" measured {min(shares):.3f} to {max(shares):.3f} for {len(shares)} pairs"
    )

wheel = [[[-1, -3], [-1, 1]], [[-3, 1], [1, 1]], [[1, 3], [1, -1]], [[3, -1], [-1, -1]]]
print(
    "\nA tree without any cut, for the four segments of a wheel:", bsp.PartitionTree.perfect(wheel)
)
print("and for three of them:", bsp.PartitionTree.perfect(wheel[:3]))
