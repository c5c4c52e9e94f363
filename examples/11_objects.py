"""Two sets as partition trees, on the line and in the plane: split, merged and printed."""

from bspcsg import bsp


def show(tree: bsp.ObjectTree, node: int = 0, depth: int = 0) -> None:
    """Print the inner nodes and leaves below a node, indented by depth."""
    names = {tree.nodes.IN: "in", tree.nodes.OUT: "out"}
    if node < 0:
        print("  " * depth + names[node])
        return
    *normal, offset = tree.nodes.hyperplanes[node] + 0.0
    terms = " ".join(f"{n:+.3g}{axis}" for n, axis in zip(normal, "xyz", strict=False) if n)
    print("  " * depth + f"{terms} = {offset:.3g}")
    show(tree, int(tree.nodes.minus[node]), depth + 1)
    show(tree, int(tree.nodes.plus[node]), depth + 1)


a = bsp.Intervals([(0, 4), (6, 9)])
b = bsp.Intervals([(2, 7)])
for op in ("union", "intersection", "difference", "xor"):
    merged = bsp.merge(a, b, op)
    print(f"1D {op}: {merged}, length {merged.measure}")
show(bsp.merge(a, b, "intersection").tree)

square = bsp.Region.rectangle(4, 4)
triangle = bsp.Region([(2, 1), (7, 1), (2, 6)])
for op in ("union", "intersection", "difference", "xor"):
    merged = bsp.merge(square, triangle, op)
    print(f"2D {op}: area {merged.measure}, {merged.tree.stats()['nodes']} nodes")

print("\nHow a line can lie to the root of a tree:")
half = bsp.ObjectTree.half_space((1, 0), 0)
lines = [((1, 0), 0), ((-1, 0), 0), ((1, 0), -1), ((-1, 0), 1), ((1, 0), 1), ((-1, 0), -1)]
for normal, offset in [*lines, ((1, 1), 0)]:
    print(f"{normal!s:>8} · x = {offset:2}: {half.split_case(normal, offset)}")
minus, plus = bsp.split_tree(square ^ triangle, ((1, 1), 6))
print("split by x + y = 6:", minus.measure, "+", plus.measure, "=", (square ^ triangle).measure)
