"""Trees and regions drawn with matplotlib, for the code in GALLERY.md."""

from collections.abc import Callable
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection

from bspcsg import bsp

COLOURS = plt.get_cmap("tab20").colors
MINUS, PLUS, INK, SOFT = "#2d6cdf", "#d9730d", "#20252c", "#aab2bd"
_DISC = {"boxstyle": "circle,pad=0.12", "fc": "w", "ec": SOFT}
mpl.rcParams.update({"font.size": 8, "axes.titlesize": 9, "savefig.dpi": 110})
mpl.rcParams.update({"figure.constrained_layout.use": True, "svg.hashsalt": "gallery"})


def panels(rows: int, columns: int, size: float = 2.4) -> Any:
    """Return a figure and its axes, (rows, columns), without ticks."""
    shape = (size * columns, size * rows)
    figure, axes = plt.subplots(rows, columns, figsize=shape, squeeze=False)
    for axis in axes.flat:
        axis.set_axis_off()
    return figure, axes


def partition(axes: Axes, tree: bsp.PartitionTree) -> None:
    """Draw regions, cuts and numbered fragments of a tree over segments."""
    axes.set_aspect("equal")
    leaves = [side.region for node in tree.nodes for side in node.children if _is_leaf(side)]
    axes.add_collection(PolyCollection(leaves, facecolor="#f4f6f9", edgecolor="none"))
    for node in tree.nodes:
        axes.plot(*node.span.T, color=COLOURS[(node.pivot or 0) % 20], linewidth=0.7, zorder=2)
    for segment, source in zip(tree.fragments, tree.fragments.source, strict=True):
        axes.plot(*segment.T, color=COLOURS[source % 20], linewidth=3, zorder=3)
        axes.plot(*segment.T, ".", color=INK, markersize=2.5, zorder=4)
        place = segment.mean(axis=0)
        name = axes.annotate(
            str(source + 1), place, fontsize=7, ha="center", va="center", bbox=_DISC
        )
        name.set_in_layout(False)
    axes.autoscale_view()


def _is_leaf(side: bsp.Node | bsp.Leaf) -> bool:
    return isinstance(side, bsp.Leaf)


def diagram(axes: Axes, tree: bsp.PartitionTree | bsp.ObjectTree) -> None:
    """Draw a tree as a diagram, leaves as squares; those inside a set are green."""
    walk = _facet_walk if isinstance(tree, bsp.PartitionTree) else _set_walk
    state: dict[str, Any] = {"next": 0, "lines": [], "marks": []}
    _place(walk(tree), 0, state)
    axes.add_collection(LineCollection(state["lines"], colors=SOFT, linewidths=1, zorder=1))
    for (x, y), name, colour, marker in state["marks"]:
        axes.plot(x, y, marker, color=colour, markeredgecolor=INK, markersize=9, zorder=2)
        text = axes.text(x, y, name, fontsize=6, ha="center", va="center", zorder=3)
        text.set_in_layout(False)
    axes.margins(0.08)
    axes.autoscale_view()


def _facet_walk(tree: bsp.PartitionTree) -> Any:
    def grown(side: bsp.Node | bsp.Leaf) -> Any:
        if isinstance(side, bsp.Leaf):
            return "", "w", "s", ()
        pivot = side.pivot or 0
        return str(pivot + 1), COLOURS[pivot % 20], "o", tuple(map(grown, side.children))

    return grown(tree.root)


def _set_walk(tree: bsp.ObjectTree) -> Any:
    table = tree.nodes

    def grown(number: int) -> Any:
        if number < 0:
            return "", "#7fd3a8" if number == table.IN else "w", "s", ()
        children = (int(table.minus[number]), int(table.plus[number]))
        return "", "#dfe5ee", "o", tuple(map(grown, children))

    return grown(0 if len(table) else table.OUT)


def _place(node: Any, depth: int, state: dict[str, Any]) -> float:
    """Lay out a subtree: leaves side by side, parents above the middle of their children."""
    name, colour, marker, children = node
    places = [_place(child, depth + 1, state) for child in children]
    if not places:
        state["next"] += 1
    x = float(np.mean(places)) if places else float(state["next"])
    state["lines"] += [[(x, -depth), (place, -depth - 1)] for place in places]
    state["marks"].append(((x, -depth), name, colour, marker))
    return x


def region(axes: Axes, part: bsp.Region, colour: str = "#57b894", cuts: bool = True) -> None:
    """Draw a region with the convex cells that its tree cuts it into."""
    cells = part.tree.cells()
    outlines = []
    for cell in np.unique(cells.owner):
        walls = [cells[int(k)] for k in np.flatnonzero(cells.owner == cell)]
        corners = np.concatenate(walls)
        angle = np.arctan2(*(corners - corners.mean(axis=0)).T[::-1])
        outlines.append(corners[np.argsort(angle)])
    edge = "#00000055" if cuts else "none"
    axes.add_collection(PolyCollection(outlines, facecolor=colour, edgecolor=edge, linewidths=0.6))
    for loop in part.to_polygons():
        axes.plot(*np.concatenate([loop, loop[:1]]).T, color=INK, linewidth=1.3)
    axes.set_aspect("equal")


def comb(n: int) -> Any:
    """Return (n, 2, 2) segments: long horizontals, and below them short cutters in a row."""
    half = n // 2
    levels = np.arange(half) * 16.0 + 64
    long = [[[0, y], [16.0 * half, y]] for y in levels]
    short = [[[16.0 * k + 8, 0], [16.0 * k + 9, 32]] for k in range(n - half)]
    return np.array(long + short)


def window(triangles: int, batches: int, size: int) -> tuple[Any, list[Any]]:
    """Return triangles of very different sizes, and batches of rays through a narrow window.

    A batch is (origins, directions); all origins are the same point.
    """
    draw = np.random.default_rng(1).normal
    middles, offsets = draw(size=(triangles, 1, 3)) * 6, draw(size=(triangles, 3, 3))
    facets = middles + offsets * 0.3 * np.exp(1.5 * draw(size=(triangles, 1, 1)))
    eye = np.full((size, 3), 12.0)
    return facets, [(eye, draw(size=(size, 3)) * 0.6 - [6, 7, 18]) for _ in range(batches)]


#: A root cut at 0 and eight hyperplanes, as normal and offset, that are all cases of a split.
CASES = ((1, 0), (-1, 0), (1, -1), (-1, 1), (1, 1), (-1, -1))


def split_case(axes: Axes, dimension: int, normal: Any, offset: float) -> None:
    """Draw the half-space x < 0 of a dimension, and a hyperplane H that splits its tree."""
    first = np.eye(dimension)[0]
    half = bsp.ObjectTree.half_space(1 if dimension == 1 else first, 0)
    row = np.atleast_1d(normal).astype(float)
    axes.set_title(half.split_case(normal if dimension > 1 else float(row[0]), offset))
    pair = [(first, 0.0, INK), (row, float(offset), "#d6336c")]
    draw: Callable[..., None] = (_on_line, _in_plane, _in_space)[dimension - 1]
    for n, d, colour in pair:
        draw(axes, n, d, colour)


def _on_line(axes: Axes, n: Any, d: float, colour: str) -> None:
    axes.plot([-2, 2], [0, 0], color=SOFT, zorder=1)
    axes.plot([-2, 0], [0, 0], color=MINUS, linewidth=4, alpha=0.35, zorder=1)
    height = 0.55 if colour == INK else 0.4
    axes.plot([d * n[0]] * 2, [-height, height], color=colour, linewidth=2)
    arrow = {"arrowstyle": "->", "color": colour}
    y = height if colour == INK else -height
    axes.annotate("", (d * n[0] + 0.7 * n[0], y), (d * n[0], y), arrowprops=arrow)
    axes.set(xlim=(-2, 2), ylim=(-1, 1))


def _in_plane(axes: Axes, n: Any, d: float, colour: str) -> None:
    along = np.array([-n[1], n[0]])
    ends = d * n / (n @ n) + np.outer([-4, 4], along)
    if colour == INK:
        axes.fill([-2, 0, 0, -2], [-2, -2, 2, 2], color=MINUS, alpha=0.13)
    axes.plot(*ends.T, color=colour, linewidth=2)
    shift = 0.9 if colour == INK else -0.9
    foot = d * n / (n @ n) + shift * along / np.hypot(*along)
    arrow = {"arrowstyle": "->", "color": colour}
    axes.annotate("", foot + 0.7 * n / np.hypot(*n), foot, arrowprops=arrow)
    axes.set(xlim=(-2, 2), ylim=(-2, 2), aspect="equal")


def _in_space(axes: Any, n: Any, d: float, colour: str) -> None:
    grid = np.array([[-1.5, -1.5], [1.5, -1.5], [1.5, 1.5], [-1.5, 1.5]])
    if n[1]:
        # The plane through the z axis.
        corners = np.column_stack([grid[:, 0], -grid[:, 0] * n[0] / n[1], grid[:, 1]])
    else:
        corners = np.column_stack([np.full(4, d * n[0]), grid])
    axes.plot_trisurf(*corners.T, triangles=[[0, 1, 2], [0, 2, 3]], color=colour, alpha=0.35)
    start = corners.mean(axis=0)
    axes.quiver(*start, *(1.1 * n / np.linalg.norm(n)), color=colour, linewidth=1.4)
    axes.set(xlim=(-1.6, 1.6), ylim=(-1.6, 1.6), zlim=(-1.6, 1.6), box_aspect=(1, 1, 1))
    axes.view_init(22, -58)
