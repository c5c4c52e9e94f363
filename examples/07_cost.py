"""The cost of a partition tree: pivot policies compared, in the plane and for a surface."""

import bspcsg as csg
from bspcsg import bsp
from bspcsg.bsp import analysis

print("100 disjoint segments; cost is the expected number of nodes that a query visits:")
segments = analysis.disjoint_segments(100, seed=5)
print(bsp.compare_policies(segments))

print("\nThe same with axis-parallel cuts until a region has at most 4 segments:")
print(bsp.compare_policies(segments, top=4))

print("\nFrom least splits (0) to balance (1):")
for alpha in (0.0, 0.25, 0.5, 0.75, 1.0):
    tree = bsp.PartitionTree(segments, "weighted", alpha=alpha)
    figures = tree.stats()
    print(
        f"  alpha {alpha:.2f}: {figures.splits:3d} splits, depth {figures.depth:2d},"
        f" point cost {tree.cost('point'):6.3f}, ray cost {tree.cost('ray'):7.3f}"
    )

plate = csg.cube(1).scale((4, 3, 1)) - csg.cylinder(4, 0.6, segments=24).translate(2, 1.5, -1)
mesh = plate.to_mesh()
print(f"\nA drilled plate of {len(mesh.faces)} triangles:")
print(bsp.compare_policies(mesh.vertices[mesh.faces], top=8))
