"""How partition trees grow: fragments against facets, with the bounds, on logarithmic axes."""

import math
import sys
from pathlib import Path

from PIL import Image, ImageDraw

import bspcsg as b
from bspcsg.bsp import analysis

out = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
out.mkdir(parents=True, exist_ok=True)

balls = [b.sphere(1, segments=count) for count in (16, 32, 64, 128)]
table = analysis.growth_table((50, 100, 200, 400, 800, 1600), (16, 32, 64, 128), balls, trials=3)
print(table)

width, height, margin = 640, 460, 50
low, high = 10, 100_000
plot = Image.new("RGB", (width, height), "white")
draw = ImageDraw.Draw(plot)


def place(n: float, fragments: float) -> tuple[float, float]:
    """Return the pixel of a point of the plot."""
    decades = math.log10(high / low)
    x = margin + (width - 2 * margin) * math.log10(n / low) / decades
    return x, height - margin - (height - 2 * margin) * math.log10(fragments / low) / decades


for decade in range(1, 6):
    value = 10**decade
    draw.line([place(value, low), place(value, high)], "#dddddd")
    draw.line([place(low, value), place(high, value)], "#dddddd")
    draw.text((place(value, low)[0] - 10, height - margin + 8), f"{value}", "black")
    draw.text((8, place(low, value)[1] - 5), f"{value}", "black")
names = {
    "disjoint segments": ("#2e7d32", "segments, random order; bound n + 2 n ln n"),
    "ruled grid": ("#b3404d", "ruled grid in space; bound n^2"),
    "surface": ("#5e81ac", "surfaces, axis cuts on top; n"),
}
for row, (scene, (colour, words)) in enumerate(names.items()):
    growth = [one for one in table if one.scene == scene]
    draw.line([place(one.n, one.bound) for one in growth], colour, 1)
    draw.line([place(one.n, one.fragments) for one in growth], colour, 3)
    for one in growth:
        x, y = place(one.n, one.fragments)
        draw.ellipse((x - 3, y - 3, x + 3, y + 3), colour)
    draw.text((margin + 12, margin + 6 + 16 * row), words, colour)
draw.text((width / 2 - 30, height - 20), "facets", "black")
draw.text((margin, 20), "fragments (thick) and bounds (thin)", "black")
plot.save(out / "growth.png")
