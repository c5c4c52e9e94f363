//! Irregular vertices: shared by several fans of faces, or on an edge of more than two faces.
//!
//! The link of a vertex has a directed edge for each face around it: from the corner after the vertex to the
//! corner before it. The faces make one fan if the link is one cycle.

use super::handle::VertexId;
use super::tasks::each_chunk;
use crate::arith::convert::as_number;
use crate::interrupt::poll;

/// The largest number of edges in a [`ShortLink`]; around most vertices of ordinary meshes there are six.
const MAX_SHORT_LINK_EDGES: usize = 8;

/// The link of a vertex (an edge for each face around it, from the corner after the vertex to the corner
/// before it) as labels: first of the edges' start points, then of their end points; zero after the last
/// edge.
///
/// The label of a vertex is the low fifteen bits of its number under a set top bit.
type ShortLink = [u16; 2 * MAX_SHORT_LINK_EDGES];

/// The vertices of a closed surface whose link (the edges opposite to the vertex in its faces) is not one
/// cycle, in ascending order.
pub fn irregular(faces: &[[VertexId; 3]], vertex_count: usize) -> Vec<VertexId> {
    let doubtful = vertices_with_doubtful_links(faces, vertex_count, |vertex| Some(vertex.index()));
    let vertices = doubtful.into_iter().map(VertexId).collect();
    without_cycle(&VertexSubset::new(vertices, vertex_count), faces)
}

/// The given vertices of a closed surface whose link (the edges opposite to the vertex in its faces) is not
/// one cycle, in ascending order.
///
/// `vertices` must ascend. Costs one pass over the faces, and memory for the links of these vertices only.
pub fn irregular_among(
    vertices: Vec<VertexId>,
    faces: &[[VertexId; 3]],
    vertex_count: usize,
) -> Vec<VertexId> {
    if vertices.is_empty() {
        return Vec::new();
    }
    let subset = VertexSubset::new(vertices, vertex_count);
    let doubtful = vertices_with_doubtful_links(faces, subset.vertices.len(), |vertex| {
        subset.index_of(vertex)
    });
    let vertices = doubtful.into_iter().map(|at| subset.vertices[at as usize]);
    without_cycle(&VertexSubset::new(vertices.collect(), vertex_count), faces)
}

/// A set of vertices of a mesh, with the index of each in the set.
struct VertexSubset {
    /// The vertices of the set, ascending.
    vertices: Vec<VertexId>,
    /// A bit for each vertex of the mesh, set if the vertex is in the set.
    words: Vec<u64>,
    /// For each word, the number of vertices of the set before the word's first bit.
    before: Vec<u32>,
}

impl VertexSubset {
    fn new(vertices: Vec<VertexId>, vertex_count: usize) -> Self {
        let mut words = vec![0u64; vertex_count.div_ceil(64)];
        for vertex in &vertices {
            words[vertex.index() / 64] |= 1 << (vertex.index() % 64);
        }
        let sum = |sum: &mut u32, word: &u64| {
            let before = *sum;
            *sum += word.count_ones();
            Some(before)
        };
        let before = words.iter().scan(0, sum).collect();
        Self {
            vertices,
            words,
            before,
        }
    }

    #[inline]
    fn has(&self, vertex: VertexId) -> bool {
        self.words[vertex.index() / 64] >> (vertex.index() % 64) & 1 == 1
    }

    #[inline]
    fn index_of(&self, vertex: VertexId) -> Option<usize> {
        let word = vertex.index() / 64;
        let lower = self.words[word] & ((1 << (vertex.index() % 64)) - 1);
        let index = || self.before[word] as usize + lower.count_ones() as usize;
        self.has(vertex).then(index)
    }
}

/// The vertices of a subset whose link (the edges opposite to the vertex in its faces) is not one cycle,
/// ascending; sorts the face corners at these vertices.
fn without_cycle(subset: &VertexSubset, faces: &[[VertexId; 3]]) -> Vec<VertexId> {
    if subset.vertices.is_empty() {
        return Vec::new();
    }
    let at_asked = |_, faces: &[[VertexId; 3]]| {
        let corners = faces
            .iter()
            .flat_map(|&[a, b, c]| [[a, b, c], [b, c, a], [c, a, b]]);
        corners.filter(|c| subset.has(c[0])).collect::<Vec<_>>()
    };
    let mut corners = each_chunk(faces, at_asked).concat();
    corners.sort_unstable();
    let links = corners.chunk_by(|a, b| a[0] == b[0]);
    links
        .filter(|link| !is_cycle(link))
        .map(|link| link[0][0])
        .collect()
}

/// The indices of vertices whose [`ShortLink`] does not prove that the edges opposite to the vertex in its
/// faces are one cycle.
///
/// `index` maps the vertices to examine to `0..count`, and all others to `None`.
fn vertices_with_doubtful_links(
    faces: &[[VertexId; 3]],
    count: usize,
    index: impl Fn(VertexId) -> Option<usize>,
) -> Vec<u32> {
    let mut links: Vec<ShortLink> = vec![[0; 2 * MAX_SHORT_LINK_EDGES]; count];
    let mut counts = vec![0u8; count];
    for &[a, b, c] in faces {
        poll();
        for (vertex, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
            let Some(index) = index(vertex) else {
                continue;
            };
            let count = &mut counts[index];
            let at = usize::from(*count);
            if at < MAX_SHORT_LINK_EDGES {
                let link = &mut links[index];
                link[at] = label(from);
                link[MAX_SHORT_LINK_EDGES + at] = label(to);
            }
            *count = count.saturating_add(1);
        }
    }
    let doubtful = |first: usize, links: &[ShortLink]| {
        let rows = (as_number(first)..).zip(links.iter().zip(&counts[first..]));
        let doubt = |(index, (link, count)): (u32, (&ShortLink, &u8))| {
            (*count > 0 && !is_short_cycle(link, usize::from(*count))).then_some(index)
        };
        rows.filter_map(doubt).collect::<Vec<u32>>()
    };
    each_chunk(&links, doubtful).concat()
}

#[allow(clippy::cast_possible_truncation, reason = "fifteen bits are a label")]
fn label(vertex: VertexId) -> u16 {
    vertex.0 as u16 | 1 << 15
}

/// Return whether the edges of a short link certainly form one cycle; the labels of the start points must be
/// the labels of the end points in another order.
///
/// The walk goes from label to label. If it first returns after `count` steps, it visited `count` different
/// labels. All are labels of start points, since the walk stays at zero once it leaves these. So the labels
/// of the start points differ, and with them the vertices: no two share a label.
fn is_short_cycle(link: &ShortLink, count: usize) -> bool {
    if count > MAX_SHORT_LINK_EDGES {
        return false;
    }
    let mut label = link[MAX_SHORT_LINK_EDGES];
    for _ in 1..count {
        if label == link[0] {
            return false;
        }
        label = label_after(link, label);
    }
    label == link[0]
}

/// The label of the end of the edge that starts at `label`; if several edges start there, the bitwise or of
/// the labels of their ends.
fn label_after(link: &ShortLink, label: u16) -> u16 {
    (0..MAX_SHORT_LINK_EDGES).fold(0, |found, i| {
        let mask = if link[i] == label { u16::MAX } else { 0 };
        found | (link[MAX_SHORT_LINK_EDGES + i] & mask)
    })
}

/// Return whether the link of a vertex (the edges opposite to the vertex in its faces) is one cycle. Each row
/// has the vertex and the start and end of an edge; rows are sorted, and there is at least one.
fn is_cycle(link: &[[VertexId; 3]]) -> bool {
    if link.windows(2).any(|pair| pair[0][1] == pair[1][1]) {
        return false;
    }
    let [_, first, mut corner] = link[0];
    for _ in 1..link.len() {
        match link.binary_search_by_key(&corner, |edge| edge[1]) {
            Ok(at) if corner != first => corner = link[at][2],
            _ => return false,
        }
    }
    corner == first
}

#[cfg(test)]
mod tests {
    use super::{irregular, irregular_among, VertexId};
    use crate::arith::convert::as_number;
    use crate::mesh::topology::Topology;
    use proptest::prelude::*;

    /// Tetrahedra on a small number of vertices: closed, and often irregular.
    fn tetrahedra() -> impl Strategy<Value = Vec<[VertexId; 3]>> {
        let corners = prop::sample::subsequence((0u32..12).collect::<Vec<_>>(), 4);
        let corners = (corners, 0u32..3, any::<bool>());
        prop::collection::vec(corners, 1..6).prop_map(|all| {
            let tetrahedron = |(c, high, turned): &(Vec<u32>, u32, bool)| {
                // Vertex numbers that are far apart share their lower bits.
                let [a, b, c, d] = [0, 1, 2, 3].map(|i| c[i] + (high << 15) * (as_number(i) % 2));
                let faces = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
                let faces = faces.map(|[a, b, c]| if *turned { [a, c, b] } else { [a, b, c] });
                faces.map(|f| f.map(VertexId))
            };
            all.iter().flat_map(tetrahedron).collect()
        })
    }

    /// A double cone over a ring, with vertex numbers that are far apart.
    fn double_cone(ring: u32, first: u32, step: u32) -> Vec<[VertexId; 3]> {
        let around = |i: u32| first + (i % ring) * step;
        let faces = |i| [[0, around(i), around(i + 1)], [1, around(i + 1), around(i)]];
        (0..ring).flat_map(faces).map(|f| f.map(VertexId)).collect()
    }

    proptest! {
        #[test]
        fn irregular_vertices_are_those_of_the_paired_surface(faces in tetrahedra()) {
            let count = 1 << 18;
            let topology = Topology::new(&faces, count);
            prop_assert_eq!(irregular(&faces, count), topology.irregular());
        }

        #[test]
        fn some_vertices_are_looked_at_as_all(faces in tetrahedra(), third in 0u32..3) {
            let count = 1 << 18;
            let is_asked = |v: &VertexId| v.0 % 3 == third;
            let asked: Vec<VertexId> = VertexId::all().take(count).filter(is_asked).collect();
            let expected: Vec<VertexId> = irregular(&faces, count).into_iter().filter(is_asked).collect();
            prop_assert_eq!(irregular_among(asked, &faces, count), expected);
        }
    }

    #[test]
    fn fans_of_any_size_are_regular() {
        for ring in [3, 8, 9, 300] {
            for step in [1, 1 << 15] {
                let faces = double_cone(ring, 2, step);
                assert!(irregular(&faces, 2 + (ring * step) as usize).is_empty());
            }
        }
    }

    #[test]
    fn cones_that_share_their_apexes_are_not() {
        for ring in [4, 5, 20] {
            let mut faces = double_cone(ring, 2, 1);
            faces.extend(double_cone(ring, 2 + ring, 1));
            assert_eq!(
                irregular(&faces, 2 + 2 * ring as usize),
                [0, 1].map(VertexId)
            );
        }
    }
}
