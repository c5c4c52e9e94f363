//! Draws `descent.svg`: the cells that a descent leaves of one ball minus another, in one plane.
//!
//! `cargo run --release --example descent > descent.svg`, inside `core/`.

#[path = "../tests/support/mod.rs"]
mod support;

use bspcsg::geometry::cell::Cell;
use bspcsg::merge::SetOp;
use bspcsg::tree::node::{Branch, DeferredLeaf, Node};
use bspcsg::tree::solid::Solid;
use support::{applied, Shape};

/// The height of the plane z = `HEIGHT`, between lattice coordinates, so that it contains no vertex.
const HEIGHT: f64 = 1_100_000.25;

/// The low corner of the lattice square that is drawn; `SIDE` is the length of its sides.
const LOW: [f64; 2] = [-100_000.0, -100_000.0];
const SIDE: f64 = 2_700_000.0;

/// The width of the drawn square in pixels; `LEGEND` is the height of the legend below it.
const WIDTH: f64 = 640.0;
const LEGEND: f64 = 92.0;

/// The colours of cells, and what each colour means.
const MEANINGS: [(&str, &str); 4] = [
    ("#cfe3f5", "A alone matters: its faces are listed again"),
    ("#f9dcc0", "B alone matters: the same, turned around"),
    ("#9ad0a0", "both matter: a kernel decides which faces stay"),
    ("#ffffff", "neither has surface: one answer everywhere"),
];

fn main() {
    let a = Shape::sphere([1_000_000; 3], 1_000_000.0, 6);
    let b = Shape::sphere([1_650_000, 1_380_000, 1_060_000], 850_000.0, 6);
    let solids = [a.solid(), b.solid()];
    let result = applied(SetOp::Difference, &solids[0], &solids[1]);
    let mut cells = Vec::new();
    collect(result.root(), &solids, &mut cells);
    let mut picture = vec![head()];
    picture.extend(cells.iter().map(|(cell, meaning)| square(cell, *meaning)));
    picture.push(format!("<path d=\"{}\" stroke=\"#1f4e79\"/>", section(&a)));
    picture.push(format!("<path d=\"{}\" stroke=\"#b35a00\"/>", section(&b)));
    picture.push(legend(&cells));
    println!("{}</svg>", picture.join("\n"));
}

/// Collects the leaves of a tree that the plane meets, each with the index of its meaning in `MEANINGS`.
fn collect(root: &Branch, solids: &[Solid; 2], cells: &mut Vec<(Cell, usize)>) {
    let mut open = vec![root.clone()];
    while let Some(branch) = open.pop() {
        if !is_drawn(&branch.cell) {
            continue;
        }
        match &*branch.node {
            Node::Leaf(_) => cells.push((branch.cell, 3)),
            Node::Deferred(leaf) => cells.push((branch.cell, meaning(leaf, solids))),
            Node::Cut(halves) => open.extend(halves.children.iter().map(|c| branch.child(c))),
        }
    }
}

fn is_drawn(cell: &Cell) -> bool {
    let [low, high] = walls(cell);
    low[2] < HEIGHT && HEIGHT < high[2]
}

fn meaning(leaf: &DeferredLeaf, solids: &[Solid; 2]) -> usize {
    if leaf.by_kernel {
        return 2;
    }
    let first = solids[0].sources().iter().next().map(|s| s.id());
    usize::from(leaf.groups.iter().all(|g| Some(g.source.id()) != first))
}

/// The low and the high corner of a cell, half a step outside its lattice points.
fn walls(cell: &Cell) -> [[f64; 3]; 2] {
    [
        cell.low().map(|c| double(c) - 0.5),
        cell.high().map(|c| double(c) + 0.5),
    ]
}

#[allow(clippy::cast_precision_loss, reason = "small numbers")]
fn double(c: i64) -> f64 {
    c as f64
}

/// Converts a point of the plane to pixels, with y pointing up.
fn place([x, y]: [f64; 2]) -> [f64; 2] {
    [
        (x - LOW[0]) * WIDTH / SIDE,
        WIDTH - (y - LOW[1]) * WIDTH / SIDE,
    ]
}

fn square(cell: &Cell, meaning: usize) -> String {
    let [low, high] = walls(cell);
    let ([left, bottom], [right, top]) = (place([low[0], low[1]]), place([high[0], high[1]]));
    format!(
        "<rect x=\"{left:.1}\" y=\"{top:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"{}\"/>",
        right - left,
        bottom - top,
        MEANINGS[meaning].0
    )
}

/// Draws the segments in which the plane cuts the triangles of a surface.
fn section(shape: &Shape) -> String {
    let corner = |v: i64| shape.vertices[usize::try_from(v).expect("an index")].map(double);
    let cut = |face: &[i64; 3]| -> Option<String> {
        let points = face.map(corner);
        let mut ends = (0..3).filter_map(|i| crossing(points[i], points[(i + 1) % 3]));
        let ([x, y], [u, v]) = (place(ends.next()?), place(ends.next()?));
        Some(format!("M{x:.1} {y:.1}L{u:.1} {v:.1}"))
    };
    shape.faces.iter().filter_map(cut).collect()
}

/// Returns the point in which an edge crosses the plane; `None` if it does not.
fn crossing(p: [f64; 3], q: [f64; 3]) -> Option<[f64; 2]> {
    let t = (HEIGHT - p[2]) / (q[2] - p[2]);
    (0.0..1.0)
        .contains(&t)
        .then(|| [0, 1].map(|i| p[i] + t * (q[i] - p[i])))
}

fn head() -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{}\" \
         font-family=\"sans-serif\" font-size=\"13\" fill=\"none\" stroke=\"#556\" \
         stroke-width=\"1\">\n<rect width=\"{WIDTH}\" height=\"{}\" fill=\"#fff\" stroke=\"none\"/>",
        WIDTH + LEGEND,
        WIDTH + LEGEND
    )
}

/// Draws the colours with their meanings, and how many of the drawn cells have each colour.
fn legend(cells: &[(Cell, usize)]) -> String {
    let line = |(i, (colour, text)): (usize, &(&str, &str))| {
        let y = WIDTH + 14.0 + 20.0 * double(i64::try_from(i).expect("small"));
        let count = match cells.iter().filter(|c| c.1 == i).count() {
            0 => String::new(),
            count => format!(" ({count} cells)"),
        };
        format!(
            "<rect x=\"12\" y=\"{y}\" width=\"14\" height=\"14\" fill=\"{colour}\"/>\
             <text x=\"36\" y=\"{}\" fill=\"#222\" stroke=\"none\">{text}{count}</text>",
            y + 12.0
        )
    };
    let lines: Vec<String> = MEANINGS.iter().enumerate().map(line).collect();
    lines.join("\n")
}
