//! No T-junctions: edges that do not pair are subdivided along their lines until they do.

use std::collections::HashMap;

use super::vertices::VertexTable;
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
pub fn subdivisions(edges: &[Edge], table: &VertexTable) -> Vec<Vec<u32>> {
    let mut inner = vec![Vec::new(); edges.len()];
    let mut open = unpaired(edges);
    open.sort_by_key(|i| (edges[*i].line, *i));
    for run in open.chunk_by(|a, b| edges[*a].line == edges[*b].line) {
        subdivide_line(run, edges, table, &mut inner);
    }
    inner
}

/// The edges left after opposite ones with equal ends cancel.
fn unpaired(edges: &[Edge]) -> Vec<usize> {
    let mut waiting: HashMap<(u32, u32), Vec<usize>> = HashMap::with_capacity(edges.len());
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
    (0..edges.len()).filter(|i| !paired[*i]).collect()
}

fn subdivide_line(run: &[usize], edges: &[Edge], table: &VertexTable, inner: &mut [Vec<u32>]) {
    let axis = edges[run[0]].line.axis();
    let mut points: Vec<u32> = run
        .iter()
        .flat_map(|i| [edges[*i].from, edges[*i].to])
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
