//! Irregular vertices: several fans of faces, or more than two faces of an edge, share them.
//!
//! The link of a vertex has a directed edge for each face around it: from the corner after the
//! vertex to the one before it. The faces make one fan if the link is one cycle.

use super::handle::VertexId;
use super::tasks::each_chunk;
use crate::arith::convert::as_number;
use crate::interrupt::poll;

/// Edges that a [`Short`] link holds; around most vertices of most meshes there are six.
const ROOM: usize = 8;

/// The starts, then the ends of a link's edges; zero where there is none.
///
/// Fifteen bits of each corner stand for it, under a set top bit.
type Short = [u16; 2 * ROOM];

/// The vertices of a closed surface whose link is not one cycle, sorted.
pub fn irregular(faces: &[[VertexId; 3]], vertex_count: usize) -> Vec<VertexId> {
    irregular_among(&doubtful(faces, vertex_count), faces, vertex_count)
}

/// Those of some vertices of a closed surface whose link is not one cycle, sorted.
///
/// One pass over the faces, and a sort of the corners at these vertices.
pub fn irregular_among(
    vertices: &[VertexId],
    faces: &[[VertexId; 3]],
    vertex_count: usize,
) -> Vec<VertexId> {
    let mut wanted = vec![0u64; vertex_count.div_ceil(64)];
    for vertex in vertices {
        wanted[vertex.place() / 64] |= 1 << (vertex.place() % 64);
    }
    let is_wanted = |v: VertexId| wanted[v.place() / 64] >> (v.place() % 64) & 1 == 1;
    let at_wanted = |_, faces: &[[VertexId; 3]]| {
        let corners = faces
            .iter()
            .flat_map(|&[a, b, c]| [[a, b, c], [b, c, a], [c, a, b]]);
        corners.filter(|c| is_wanted(c[0])).collect::<Vec<_>>()
    };
    if vertices.is_empty() {
        return Vec::new();
    }
    let mut corners = each_chunk(faces, at_wanted).concat();
    corners.sort_unstable();
    let links = corners.chunk_by(|a, b| a[0] == b[0]);
    links
        .filter(|link| !is_cycle(link))
        .map(|link| link[0][0])
        .collect()
}

/// Vertices whose short link does not show that they are regular.
fn doubtful(faces: &[[VertexId; 3]], vertex_count: usize) -> Vec<VertexId> {
    let mut links: Vec<Short> = vec![[0; 2 * ROOM]; vertex_count];
    let mut counts = vec![0u8; vertex_count];
    for &[a, b, c] in faces {
        poll();
        for (vertex, from, to) in [(a, b, c), (b, c, a), (c, a, b)] {
            let count = &mut counts[vertex.place()];
            let at = usize::from(*count);
            if at < ROOM {
                let link = &mut links[vertex.place()];
                link[at] = label(from);
                link[ROOM + at] = label(to);
            }
            *count = count.saturating_add(1);
        }
    }
    let doubtful = |first: usize, links: &[Short]| {
        let rows = (as_number(first)..)
            .map(VertexId)
            .zip(links.iter().zip(&counts[first..]));
        let doubt = |(vertex, (link, count)): (VertexId, (&Short, &u8))| {
            (*count > 0 && !is_short_cycle(link, usize::from(*count))).then_some(vertex)
        };
        rows.filter_map(doubt).collect::<Vec<VertexId>>()
    };
    each_chunk(&links, doubtful).concat()
}

#[allow(clippy::cast_possible_truncation, reason = "fifteen bits are a label")]
fn label(vertex: VertexId) -> u16 {
    vertex.0 as u16 | 1 << 15
}

/// Return whether a link is surely one cycle; its starts must be its ends in another order.
///
/// The walk below maps label to label. If it first returns after `count` steps, it saw as many
/// labels, all different; no label is seen that no start has, since the walk stays at zero from
/// there on. So the starts' labels differ, and with them the corners: nothing was confused.
fn is_short_cycle(link: &Short, count: usize) -> bool {
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

/// Says if the link of a vertex is one cycle; its corners are sorted, and there are some.
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

    /// Tetrahedra on few vertices: closed, and often irregular.
    fn tetrahedra() -> impl Strategy<Value = Vec<[VertexId; 3]>> {
        let corners = prop::sample::subsequence((0u32..12).collect::<Vec<_>>(), 4);
        let corners = (corners, 0u32..3, any::<bool>());
        prop::collection::vec(corners, 1..6).prop_map(|all| {
            let tetrahedron = |(c, high, turned): &(Vec<u32>, u32, bool)| {
                // Far numbers share their lower bits.
                let [a, b, c, d] = [0, 1, 2, 3].map(|i| c[i] + (high << 15) * (as_number(i) % 2));
                let faces = [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
                let faces = faces.map(|[a, b, c]| if *turned { [a, c, b] } else { [a, b, c] });
                faces.map(|f| f.map(VertexId))
            };
            all.iter().flat_map(tetrahedron).collect()
        })
    }

    /// A double cone over a ring, its vertices far apart in number.
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
            prop_assert_eq!(irregular_among(&asked, &faces, count), expected);
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
