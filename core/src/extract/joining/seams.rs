//! Removes T-junctions: subdivides edges without an opposite along their lines until they have one.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;

use super::group::PlaneGroup;
use crate::extract::triangulate::Planar;
use crate::extract::vertices::Projection;
use crate::geometry::line::LineKey;
use crate::geometry::vertices::VertexTable;
use crate::interrupt::poll;

/// Numbers of points, by the line that contains them.
pub type LinePoints = HashMap<LineKey, Vec<u32>>;

/// Numbers of the points inside edges, in order from start to end, by the number of the edge.
pub type InnerPoints = HashMap<usize, Vec<u32>>;

/// A directed edge between numbered points.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// The number of the point at which the edge starts.
    pub from: u32,
    /// The number of the point at which the edge ends.
    pub to: u32,
}

/// Returns the points at which edges must be subdivided, for each edge that has such points.
///
/// Opposite edges with the same ends form pairs and are not subdivided. All other edges on a line cover each
/// of its points equally often in both directions, because a closed surface has no border. If each is divided
/// at the ends of the others, they form pairs, too.
pub fn subdivisions(
    edges: &[Edge],
    mut line: impl FnMut(usize) -> LineKey,
    touching: &LinePoints,
    table: &VertexTable,
) -> InnerPoints {
    let mut inner = InnerPoints::default();
    let mut open: Vec<(LineKey, usize)> = unpaired(edges, &mut line, touching, table);
    open.sort_unstable();
    for run in open.chunk_by(|a, b| a.0 == b.0) {
        poll();
        let extra = touching.get(&run[0].0).map_or(&[][..], |t| t);
        subdivide_line(run, edges, extra, table, &mut inner);
    }
    inner
}

/// An edge of a polygon with its bounding box in a projection.
struct Boxed<'a> {
    edge: &'a Edge,
    /// The number of the edge in the outline.
    number: usize,
    low: [f64; 2],
    high: [f64; 2],
}

/// Finds the points at which a polygon touches or crosses itself inside edges, and adds them to `touching`.
///
/// An edge with such a point inside must have it as a vertex, or the polygon cannot be triangulated. Edges
/// of one polygon cross where three or more lines meet and the wedges between them are alternately in and
/// out.
pub fn find_touching(
    edges: &[Edge],
    group: &mut PlaneGroup,
    table: &mut VertexTable,
    touching: &mut LinePoints,
) {
    if edges.len() <= 3 {
        return;
    }
    let view = Projection::onto(&group.plane, table);
    let mut boxed: Vec<Boxed> = edges
        .iter()
        .enumerate()
        .map(|(number, edge)| Boxed::new(edge, number, &view))
        .collect();
    boxed.sort_by(|a, b| a.low[0].total_cmp(&b.low[0]));
    let (mut touches, mut crossings) = (Vec::new(), Vec::new());
    for (i, a) in boxed.iter().enumerate() {
        poll();
        let near = boxed[i + 1..].iter().take_while(|b| b.low[0] <= a.high[0]);
        for b in near.filter(|b| b.low[1] <= a.high[1] && a.low[1] <= b.high[1]) {
            poll();
            for (near, point) in [(a, b.edge.from), (b, a.edge.from)] {
                let between = || view.is_between(near.edge.from, point, near.edge.to);
                if near.may_hold(view.approx(point)) && between() {
                    touches.push((near.number, point));
                }
            }
            if view.crosses([a.edge.from, a.edge.to], [b.edge.from, b.edge.to]) {
                crossings.push((a.number, b.number));
            }
        }
    }
    for (a, b) in crossings {
        poll();
        let (first, second) = (&group.edges()[a].carrier, &group.edges()[b].carrier);
        let cut = Arc::new(second.plane(&group.plane));
        if let Some(vertex) = first.meet(&group.plane, &cut) {
            let point = table.number_of(&Arc::new(vertex));
            touches.extend([(a, point), (b, point)]);
        }
    }
    for (edge, point) in touches {
        poll();
        touching.entry(group.lines()[edge]).or_default().push(point);
    }
}

impl<'a> Boxed<'a> {
    /// Makes the box of an edge, widened by the rounding of the edge's ends.
    fn new(edge: &'a Edge, number: usize, view: &Projection) -> Self {
        let (a, b) = (view.approx(edge.from), view.approx(edge.to));
        let slack = [0, 1].map(|i| (a[i].abs() + b[i].abs()) * 8.0 * f64::EPSILON);
        Self {
            edge,
            number,
            low: [0, 1].map(|i| a[i].min(b[i]) - slack[i]),
            high: [0, 1].map(|i| a[i].max(b[i]) + slack[i]),
        }
    }

    /// Returns false only if a rounded point lies outside the box, so that the exact point is not on the
    /// edge.
    fn may_hold(&self, p: [f64; 2]) -> bool {
        (0..2).all(|i| self.low[i] <= p[i] && p[i] <= self.high[i])
    }
}

/// Returns the edges without an opposite, and all edges on lines with touching points, each with its line.
fn unpaired(
    edges: &[Edge],
    line: &mut impl FnMut(usize) -> LineKey,
    touching: &LinePoints,
    table: &VertexTable,
) -> Vec<(LineKey, usize)> {
    let paired = paired(edges, table.len());
    let keyed = (0..edges.len()).filter_map(|i| {
        if paired[i] && touching.is_empty() {
            return None;
        }
        let line = line(i);
        (!paired[i] || touching.contains_key(&line)).then_some((line, i))
    });
    keyed.collect()
}

/// Returns for each edge whether it is paired with an opposite edge of equal ends.
fn paired(edges: &[Edge], points: usize) -> Vec<bool> {
    let mut paired = vec![false; edges.len()];
    let mut waiting: Vec<u32> = Vec::new();
    let (starts, mut order) = by_lower_end(edges, points);
    for bounds in starts.windows(2) {
        poll();
        let around = &mut order[bounds[0] as usize..bounds[1] as usize];
        let higher = |i: &u32| edges[*i as usize].from.max(edges[*i as usize].to);
        around.sort_unstable_by_key(|i| (higher(i), *i));
        for same in around.chunk_by(|a, b| higher(a) == higher(b)) {
            waiting.clear();
            for i in same {
                let opposite = |j: &mut u32| edges[*j as usize].from == edges[*i as usize].to;
                if let Some(j) = waiting.pop_if(opposite) {
                    paired[*i as usize] = true;
                    paired[j as usize] = true;
                } else {
                    waiting.push(*i);
                }
            }
        }
    }
    paired
}

/// Sorts edges by the lower point number of their ends; returns where each number starts, and the order.
fn by_lower_end(edges: &[Edge], points: usize) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; points + 1];
    for edge in edges {
        poll();
        starts[edge.from.min(edge.to) as usize] += 1;
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut order = vec![0u32; edges.len()];
    for (i, edge) in (0u32..).zip(edges) {
        let start = &mut starts[edge.from.min(edge.to) as usize];
        *start -= 1;
        order[*start as usize] = i;
    }
    (starts, order)
}

fn subdivide_line(
    run: &[(LineKey, usize)],
    edges: &[Edge],
    extra: &[u32],
    table: &VertexTable,
    inner: &mut InnerPoints,
) {
    let axis = run[0].0.axis();
    let mut points: Vec<u32> = run
        .iter()
        .flat_map(|(_, i)| [edges[*i].from, edges[*i].to])
        .chain(extra.iter().copied())
        .collect();
    points.sort_unstable();
    points.dedup();
    points.sort_by(|a, b| table.point(*a).compare(table.point(*b), axis));
    let rank: HashMap<u32, usize> = points.iter().enumerate().map(|(r, p)| (*p, r)).collect();
    for (_, i) in run {
        let (from, to) = (rank[&edges[*i].from], rank[&edges[*i].to]);
        let between: Vec<u32> = if from < to {
            points[from + 1..to].to_vec()
        } else {
            points[to + 1..from].iter().rev().copied().collect()
        };
        if !between.is_empty() {
            inner.insert(*i, between);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_edge_is_divided_where_the_short_ones_across_meet() {
        let mut table = VertexTable::default();
        let places = [[0, 0, 0], [8, 0, 0], [4, 0, 0], [0, 8, 0]];
        let [a, b, middle, c] = places.map(|p| table.number_at(p));
        let edge = |from: u32, to: u32| Edge { from, to };
        let edges = [
            edge(a, b),
            edge(b, middle),
            edge(middle, a),
            edge(a, c),
            edge(c, a),
        ];
        let at = |id: u32| *table.point(id).as_lattice().expect("a lattice point");
        let line = |i: usize| LineKey::of_edge(&at(edges[i].from), &at(edges[i].to));
        let inner = subdivisions(&edges, line, &LinePoints::default(), &table);
        assert_eq!(inner.into_iter().collect::<Vec<_>>(), [(0, vec![middle])]);
    }
}
