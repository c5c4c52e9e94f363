//! No T-junctions: edges that do not pair are subdivided along their lines until they do.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;

use super::planes::PlaneGroup;
use super::triangulate::Planar;
use super::vertices::{Projection, VertexTable};
use crate::geometry::line::LineKey;
use crate::geometry::outline::OutlineEdge;

/// Numbered points by the line they lie on.
pub type LinePoints = HashMap<LineKey, Vec<u32>>;

/// A directed edge between numbered points, on a line.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Start.
    pub from: u32,
    /// End.
    pub to: u32,
    /// The line it lies on.
    pub line: LineKey,
}

/// For each edge the points inside it at which it must be subdivided, from start to end.
///
/// Opposite edges with equal ends pair and stay. The others still form a closed chain, for a
/// boundary has no boundary: subdivided at each other's ends, line by line, they pair too.
///
/// # Source
/// Design review F6.
pub fn subdivisions(edges: &[Edge], touching: &LinePoints, table: &VertexTable) -> Vec<Vec<u32>> {
    let mut inner = vec![Vec::new(); edges.len()];
    let mut open = unpaired(edges, touching);
    open.sort_by_key(|i| (edges[*i].line, *i));
    for run in open.chunk_by(|a, b| edges[*a].line == edges[*b].line) {
        let extra = touching.get(&edges[run[0]].line).map_or(&[][..], |t| t);
        subdivide_line(run, edges, extra, table, &mut inner);
    }
    inner
}

/// An edge with its box in a projection.
struct Boxed<'a> {
    edge: &'a Edge,
    outline: &'a OutlineEdge,
    low: [f64; 2],
    high: [f64; 2],
}

/// Adds the points at which a polygon touches or crosses itself inside edges, by line.
///
/// Such an edge must have the point as a vertex, on both its sides, or the polygon cannot be
/// triangulated. Edges of one polygon cross where three or more lines meet and the wedges between
/// them are in and out by turns.
pub fn find_touching(
    edges: &[Edge],
    group: &PlaneGroup,
    table: &mut VertexTable,
    touching: &mut LinePoints,
) {
    let view = Projection::onto(&group.plane, table);
    let mut boxed: Vec<Boxed> = edges
        .iter()
        .zip(&group.edges)
        .map(|(edge, outline)| Boxed::new(edge, outline, &view))
        .collect();
    boxed.sort_by(|a, b| a.low[0].total_cmp(&b.low[0]));
    let mut crossings = Vec::new();
    for (i, a) in boxed.iter().enumerate() {
        let near = boxed[i + 1..].iter().take_while(|b| b.low[0] <= a.high[0]);
        for b in near.filter(|b| b.low[1] <= a.high[1] && a.low[1] <= b.high[1]) {
            for (edge, point) in [(a.edge, b.edge.from), (b.edge, a.edge.from)] {
                if view.is_between(edge.from, point, edge.to) {
                    touching.entry(edge.line).or_default().push(point);
                }
            }
            if view.crosses([a.edge.from, a.edge.to], [b.edge.from, b.edge.to]) {
                crossings.push((a.outline, b.outline));
            }
        }
    }
    for (a, b) in crossings {
        let cut = Arc::new(b.carrier.plane(&group.plane));
        if let Some(vertex) = a.carrier.meet(&group.plane, &cut) {
            let point = table.number(&Arc::new(vertex));
            touching.entry(a.line).or_default().push(point);
            touching.entry(b.line).or_default().push(point);
        }
    }
}

impl<'a> Boxed<'a> {
    /// The box is widened by the rounding of its ends.
    fn new(edge: &'a Edge, outline: &'a OutlineEdge, view: &Projection) -> Self {
        let (a, b) = (view.approx(edge.from), view.approx(edge.to));
        let slack = [0, 1].map(|i| (a[i].abs() + b[i].abs()) * 8.0 * f64::EPSILON);
        Self {
            edge,
            outline,
            low: [0, 1].map(|i| a[i].min(b[i]) - slack[i]),
            high: [0, 1].map(|i| a[i].max(b[i]) + slack[i]),
        }
    }
}

/// The edges left after opposite ones with equal ends cancel, and all on lines with touching points.
fn unpaired(edges: &[Edge], touching: &LinePoints) -> Vec<usize> {
    let mut waiting: HashMap<(u32, u32), Vec<usize>> =
        HashMap::with_capacity_and_hasher(edges.len(), rustc_hash::FxBuildHasher);
    let mut paired = vec![false; edges.len()];
    for (i, edge) in edges.iter().enumerate() {
        let twin = waiting.get_mut(&(edge.to, edge.from)).and_then(Vec::pop);
        if let Some(j) = twin {
            paired[i] = true;
            paired[j] = true;
        } else {
            waiting.entry((edge.from, edge.to)).or_default().push(i);
        }
    }
    (0..edges.len())
        .filter(|i| !paired[*i] || touching.contains_key(&edges[*i].line))
        .collect()
}

fn subdivide_line(
    run: &[usize],
    edges: &[Edge],
    extra: &[u32],
    table: &VertexTable,
    inner: &mut [Vec<u32>],
) {
    let axis = edges[run[0]].line.axis();
    let mut points: Vec<u32> = run
        .iter()
        .flat_map(|i| [edges[*i].from, edges[*i].to])
        .chain(extra.iter().copied())
        .collect();
    points.sort_unstable();
    points.dedup();
    points.sort_by(|a, b| table.point(*a).compare(table.point(*b), axis));
    let rank: HashMap<u32, usize> = points.iter().enumerate().map(|(r, p)| (*p, r)).collect();
    for i in run {
        let (from, to) = (rank[&edges[*i].from], rank[&edges[*i].to]);
        inner[*i] = if from < to {
            points[from + 1..to].to_vec()
        } else {
            points[to + 1..from].iter().rev().copied().collect()
        };
    }
}
