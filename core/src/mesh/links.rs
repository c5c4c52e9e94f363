//! Where several fans of faces, or more than two faces of an edge, share a vertex.
//!
//! The link of a vertex has a directed edge for each face around it: from the corner after the
//! vertex to the one before it. The faces make one fan if the link is one cycle.

use super::tasks::each_chunk;
use crate::arith::convert::as_number;
use crate::interrupt::poll;

/// Edges that a [`Short`] link holds; around most vertices of most meshes there are six.
const ROOM: usize = 8;

/// The starts, then the ends of a link's edges; zero where there is none.
///
/// Fifteen bits of each corner stand for it, under a set top bit.
type Short = [u16; 2 * ROOM];

/// "Not looked at."
const NONE: u32 = u32::MAX;

/// The vertices of a closed surface whose link is not one cycle, sorted.
pub fn irregular(faces: &[[u32; 3]], vertex_count: usize) -> Vec<u32> {
    let doubtful = doubtful(faces, vertex_count);
    if doubtful.is_empty() {
        return doubtful;
    }
    Links::around(&doubtful, faces, vertex_count).not_cycles()
}

/// Vertices whose short link does not show that they are regular.
fn doubtful(faces: &[[u32; 3]], vertex_count: usize) -> Vec<u32> {
    let mut links: Vec<Short> = vec![[0; 2 * ROOM]; vertex_count];
    let mut counts = vec![0u8; vertex_count];
    for &[a, b, c] in faces {
        poll();
        for (vertex, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
            let count = &mut counts[vertex as usize];
            let at = usize::from(*count);
            if at < ROOM {
                let link = &mut links[vertex as usize];
                link[at] = label(from);
                link[ROOM + at] = label(to);
            }
            *count = count.saturating_add(1);
        }
    }
    let doubtful = |first: usize, links: &[Short]| {
        let rows = (as_number(first)..).zip(links.iter().zip(&counts[first..]));
        let doubt = |(vertex, (link, count)): (u32, (&Short, &u8))| {
            (*count > 0 && !is_cycle(link, usize::from(*count))).then_some(vertex)
        };
        rows.filter_map(doubt).collect::<Vec<u32>>()
    };
    each_chunk(&links, doubtful).concat()
}

#[allow(clippy::cast_possible_truncation, reason = "fifteen bits are a label")]
fn label(vertex: u32) -> u16 {
    vertex as u16 | 1 << 15
}

/// Whether a link is surely one cycle; its starts must be its ends in another order.
///
/// The walk below maps label to label. If it first returns after `count` steps, it saw as many
/// labels, all different; no label is seen that no start has, since the walk stays at zero from
/// there on. So the starts' labels differ, and with them the corners: nothing was confused.
fn is_cycle(link: &Short, count: usize) -> bool {
    if count > ROOM {
        return false;
    }
    let mut label = link[ROOM];
    for _ in 1..count {
        if label == link[0] {
            return false;
        }
        label = after(link, label);
    }
    label == link[0]
}

/// The label after another; those after all edges with that label, mixed, if several have it.
fn after(link: &Short, label: u16) -> u16 {
    (0..ROOM).fold(0, |found, i| {
        let mask = if link[i] == label { u16::MAX } else { 0 };
        found | (link[ROOM + i] & mask)
    })
}

/// The links of some vertices, in compressed rows.
struct Links<'a> {
    vertices: &'a [u32],
    starts: Vec<u32>,
    edges: Vec<[u32; 2]>,
}

impl<'a> Links<'a> {
    fn around(vertices: &'a [u32], faces: &[[u32; 3]], vertex_count: usize) -> Self {
        let mut row = vec![NONE; vertex_count];
        for (i, vertex) in (0u32..).zip(vertices) {
            row[*vertex as usize] = i;
        }
        let corners = || {
            faces.iter().flat_map(|&[a, b, c]| {
                [(a, [b, c]), (b, [c, a]), (c, [a, b])]
                    .map(|(vertex, edge)| (row[vertex as usize], edge))
            })
        };
        let mut starts = vec![0u32; vertices.len() + 1];
        for (row, _) in corners().filter(|c| c.0 != NONE) {
            starts[row as usize + 1] += 1;
        }
        for i in 0..vertices.len() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut edges = vec![[0; 2]; starts[vertices.len()] as usize];
        for (row, edge) in corners().filter(|c| c.0 != NONE) {
            poll();
            let slot = &mut next[row as usize];
            edges[*slot as usize] = edge;
            *slot += 1;
        }
        Self {
            vertices,
            starts,
            edges,
        }
    }

    fn not_cycles(mut self) -> Vec<u32> {
        let mut found = Vec::new();
        for (i, vertex) in self.vertices.iter().enumerate() {
            let row = self.starts[i] as usize..self.starts[i + 1] as usize;
            let link = &mut self.edges[row];
            link.sort_unstable();
            if !is_sorted_cycle(link) {
                found.push(*vertex);
            }
        }
        found
    }
}

/// Whether a link, sorted and not empty, is one cycle.
fn is_sorted_cycle(link: &[[u32; 2]]) -> bool {
    if link.windows(2).any(|pair| pair[0][0] == pair[1][0]) {
        return false;
    }
    let first = link[0][0];
    let mut corner = link[0][1];
    for _ in 1..link.len() {
        match link.binary_search_by_key(&corner, |edge| edge[0]) {
            Ok(at) if corner != first => corner = link[at][1],
            _ => return false,
        }
    }
    corner == first
}

#[cfg(test)]
mod tests {
    use super::irregular;
    use crate::arith::convert::as_number;
    use crate::mesh::topology::Topology;
    use proptest::prelude::*;

    /// Tetrahedra on few vertices: closed, and often irregular.
    fn tetrahedra() -> impl Strategy<Value = Vec<[u32; 3]>> {
        let corners = prop::sample::subsequence((0u32..12).collect::<Vec<_>>(), 4);
        let corners = (corners, 0u32..3, any::<bool>());
        prop::collection::vec(corners, 1..6).prop_map(|all| {
            let tetrahedron = |(c, high, turned): &(Vec<u32>, u32, bool)| {
                // Far numbers share their lower bits.
                let [a, b, c, d] = [0, 1, 2, 3].map(|i| c[i] + (high << 15) * (as_number(i) % 2));
                let faces = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
                faces.map(|[a, b, c]| if *turned { [a, c, b] } else { [a, b, c] })
            };
            all.iter().flat_map(tetrahedron).collect()
        })
    }

    /// A double cone over a ring, its vertices far apart in number.
    fn double_cone(ring: u32, first: u32, step: u32) -> Vec<[u32; 3]> {
        let around = |i: u32| first + (i % ring) * step;
        let faces = |i| [[0, around(i), around(i + 1)], [1, around(i + 1), around(i)]];
        (0..ring).flat_map(faces).collect()
    }

    proptest! {
        #[test]
        fn irregular_vertices_are_those_of_the_paired_surface(faces in tetrahedra()) {
            let count = 1 << 18;
            let topology = Topology::new(&faces, count);
            prop_assert_eq!(irregular(&faces, count), topology.irregular());
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
            assert_eq!(irregular(&faces, 2 + 2 * ring as usize), [0, 1]);
        }
    }
}
