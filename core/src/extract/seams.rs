//! No T-junctions: edges that do not pair are subdivided along their lines until they do.

use rustc_hash::FxHashMap as HashMap;

use super::triangulate::Planar;
use super::vertices::{Projection, VertexTable};
use crate::geometry::line::LineKey;

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
pub fn subdivisions(
    edges: &[Edge],
    touching: &HashMap<LineKey, Vec<u32>>,
    table: &VertexTable,
) -> Vec<Vec<u32>> {
    let mut inner = vec![Vec::new(); edges.len()];
    let mut open = unpaired(edges, touching);
    open.sort_by_key(|i| (edges[*i].line, *i));
    for run in open.chunk_by(|a, b| edges[*a].line == edges[*b].line) {
        let extra = touching.get(&edges[run[0]].line).map_or(&[][..], |t| t);
        subdivide_line(run, edges, extra, table, &mut inner);
    }
    inner
}

/// Adds the points of one polygon that lie inside edges of the same polygon, by line.
///
/// Such an edge must have the point as a vertex, on both its sides, or the polygon cannot be
/// triangulated.
pub fn find_touching(edges: &[Edge], view: &Projection, touching: &mut HashMap<LineKey, Vec<u32>>) {
    let mut points: Vec<(f64, f64, u32)> = edges
        .iter()
        .map(|e| {
            let [x, y] = view.approx(e.from);
            (x, y, e.from)
        })
        .collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    points.dedup_by_key(|p| p.2);
    for edge in edges {
        let (a, b) = (view.approx(edge.from), view.approx(edge.to));
        let slack = [0, 1].map(|i| (a[i].abs() + b[i].abs()) * 8.0 * f64::EPSILON);
        let low = [0, 1].map(|i| a[i].min(b[i]) - slack[i]);
        let high = [0, 1].map(|i| a[i].max(b[i]) + slack[i]);
        let start = points.partition_point(|p| p.0 < low[0]);
        let near = points[start..].iter().take_while(|p| p.0 <= high[0]);
        for point in near
            .filter(|p| p.1 >= low[1] && p.1 <= high[1])
            .map(|p| p.2)
        {
            if view.is_between(edge.from, point, edge.to) {
                touching.entry(edge.line).or_default().push(point);
            }
        }
    }
}

/// The edges left after opposite ones with equal ends cancel, and all on lines with touching points.
fn unpaired(edges: &[Edge], touching: &HashMap<LineKey, Vec<u32>>) -> Vec<usize> {
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
