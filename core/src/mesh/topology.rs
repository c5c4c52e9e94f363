//! Half-edges of triangle meshes, paired with their mates: the half-edges that run the other way.

use super::handle::VertexId;
use crate::arith::convert::as_number;
use crate::arith::gcd;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Lattice;
use crate::interrupt::poll;

/// Stands for the mate of a half-edge that has none.
pub const NONE: u32 = u32::MAX;

/// The half-edges of a triangle mesh, paired with their opposites.
///
/// Half-edge 3f + i runs from corner i of face f to the next corner.
#[derive(Debug)]
pub struct Topology {
    mates: Vec<u32>,
    irregular: Vec<VertexId>,
}

impl Topology {
    /// Pairs each half-edge with a half-edge that runs the other way, in the order of the faces.
    pub fn new(faces: &[[VertexId; 3]], vertex_count: usize) -> Self {
        let outgoing = Outgoing::new(faces, vertex_count);
        let mut mates = vec![NONE; 3 * faces.len()];
        let mut irregular = Vec::new();
        for tail in VertexId::all().take(vertex_count) {
            for run in outgoing.of(tail).chunk_by(|a, b| a.head == b.head) {
                poll();
                let head = run[0].head;
                if tail > head {
                    continue;
                }
                if run.len() > 1 {
                    irregular.extend([tail, head]);
                }
                for (half, mate) in run.iter().zip(outgoing.between(head, tail)) {
                    mates[half.number as usize] = mate.number;
                    mates[mate.number as usize] = half.number;
                }
            }
        }
        let mates_of = |half: u32| mates[half as usize];
        let has_several_fans = |vertex: &VertexId| {
            let row = outgoing.of(*vertex);
            let first = row.iter().map(|half| half.number).min();
            row.len() > 3 && first.is_some_and(|first| fan_size(first, mates_of) < row.len())
        };
        let all = VertexId::all().take(vertex_count);
        irregular.extend(all.filter(has_several_fans));
        irregular.sort_unstable();
        irregular.dedup();
        Self { mates, irregular }
    }

    /// For each half-edge, the number of its mate, or [`NONE`].
    pub fn mates(&self) -> &[u32] {
        &self.mates
    }

    /// The vertices on edges of more than two faces, or with several fans of faces, ascending.
    pub fn irregular(&self) -> &[VertexId] {
        &self.irregular
    }

    /// The end vertices of half-edges without a mate, ascending.
    pub fn open_vertices(&self, faces: &[[VertexId; 3]]) -> Vec<VertexId> {
        let ends = |half: usize| <[VertexId; 2]>::from(ends(faces, as_number(half)));
        let mut open: Vec<VertexId> = self.unpaired().flat_map(ends).collect();
        open.sort_unstable();
        open.dedup();
        open
    }

    /// The numbers of the half-edges without a mate, ascending.
    pub fn unpaired(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.mates.len()).filter(|h| self.mates[*h] == NONE)
    }
}

/// Returns the number of half-edges that leave the start vertex of half-edge `start` in the fan of faces
/// connected to it around this vertex; `usize::MAX` if the fan is open.
fn fan_size(start: u32, mate: impl Fn(u32) -> u32) -> usize {
    let mut half = start;
    let mut count = 0;
    loop {
        let before = half - half % 3 + (half + 2) % 3;
        count += 1;
        half = mate(before);
        if half == NONE {
            return usize::MAX;
        }
        if half == start {
            return count;
        }
    }
}

/// The start and the end vertex of a half-edge.
pub fn ends(faces: &[[VertexId; 3]], half: u32) -> (VertexId, VertexId) {
    let face = &faces[half as usize / 3];
    let corner = half as usize % 3;
    (face[corner], face[(corner + 1) % 3])
}

/// A half-edge that leaves a vertex, by its end vertex and its number.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct OutgoingHalfEdge {
    head: VertexId,
    number: u32,
}

/// Half-edges by their start vertex, in compressed rows; each row is sorted by end vertex.
struct Outgoing {
    starts: Vec<u32>,
    halves: Vec<OutgoingHalfEdge>,
}

impl Outgoing {
    fn new(faces: &[[VertexId; 3]], vertex_count: usize) -> Self {
        let mut starts = vec![0u32; vertex_count + 1];
        for vertex in faces.iter().flatten() {
            starts[vertex.index() + 1] += 1;
        }
        for i in 0..vertex_count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut halves = vec![OutgoingHalfEdge::default(); 3 * faces.len()];
        for (number, vertex) in (0u32..).zip(faces.iter().flatten()) {
            poll();
            let slot = &mut next[vertex.index()];
            let head = ends(faces, number).1;
            halves[*slot as usize] = OutgoingHalfEdge { head, number };
            *slot += 1;
        }
        for row in starts.windows(2) {
            poll();
            halves[row[0] as usize..row[1] as usize].sort_unstable();
        }
        Self { starts, halves }
    }

    fn of(&self, vertex: VertexId) -> &[OutgoingHalfEdge] {
        let row = &self.starts[vertex.index()..vertex.index() + 2];
        &self.halves[row[0] as usize..row[1] as usize]
    }

    /// The half-edges from vertex `tail` to vertex `head`.
    fn between(&self, tail: VertexId, head: VertexId) -> &[OutgoingHalfEdge] {
        let row = self.of(tail);
        let first = row.partition_point(|half| half.head < head);
        let past = row[first..].iter().take_while(|half| half.head == head);
        &row[first..first + past.count()]
    }
}

/// The numbers of the half-edges that remain after opposite edges cancel along each line of the lattice.
///
/// None remain for a closed surface with T-junctions: on each line, parts of its edges cancel.
pub fn open_edges(
    vertices: &[Lattice],
    faces: &[[VertexId; 3]],
    unpaired: impl Iterator<Item = usize>,
) -> Vec<u64> {
    let mut edges: Vec<LineEdge> = unpaired
        .filter_map(|half| LineEdge::new(vertices, faces, half))
        .collect();
    edges.sort_by_key(|a| (a.line, a.low, a.half));
    let mut open = Vec::new();
    for run in edges.chunk_by(|a, b| a.line == b.line) {
        poll();
        if !cancels(run) {
            open.extend(run.iter().map(|e| e.half as u64));
        }
    }
    open.sort_unstable();
    open
}

struct LineEdge {
    line: ([i64; 3], [i128; 3]),
    low: i64,
    high: i64,
    sign: i32,
    half: usize,
}

impl LineEdge {
    fn new(vertices: &[Lattice], faces: &[[VertexId; 3]], half: usize) -> Option<Self> {
        let face = &faces[half / 3];
        let a = vertices[face[half % 3].index()];
        let b = vertices[face[(half % 3 + 1) % 3].index()];
        let (direction, axis, sign) = primitive_direction(&a, &b)?;
        let (low, high) = (a[axis].min(b[axis]), a[axis].max(b[axis]));
        let line = (direction, moment(&a, &direction));
        Some(Self {
            line,
            low,
            high,
            sign,
            half,
        })
    }
}

/// The primitive direction from a to b with its first nonzero component made positive, the axis of that
/// component, and 1 or −1 for its original sign; `None` if a and b are equal.
fn primitive_direction(a: &Lattice, b: &Lattice) -> Option<([i64; 3], usize, i32)> {
    let d = each_axis(|i| b[i] - a[i]);
    let axis = d.iter().position(|c| *c != 0)?;
    let g = d.iter().fold(0u64, |g, c| gcd(g, c.unsigned_abs()));
    let g = i64::try_from(g).ok()? * d[axis].signum();
    let sign = if d[axis] > 0 { 1 } else { -1 };
    Some((d.map(|c| c / g), axis, sign))
}

fn moment(a: &Lattice, d: &[i64; 3]) -> [i128; 3] {
    let term = |i: usize, j: usize| {
        i128::from(a[i]) * i128::from(d[j]) - i128::from(a[j]) * i128::from(d[i])
    };
    [term(1, 2), term(2, 0), term(0, 1)]
}

fn cancels(run: &[LineEdge]) -> bool {
    let mut events: Vec<(i64, i32)> = run
        .iter()
        .flat_map(|e| [(e.low, e.sign), (e.high, -e.sign)])
        .collect();
    events.sort_unstable();
    events
        .chunk_by(|a, b| a.0 == b.0)
        .all(|group| group.iter().map(|e| e.1).sum::<i32>() == 0)
}
