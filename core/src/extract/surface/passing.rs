//! Finds segments in which walls of a surface pass through one another.
//!
//! Around an edge of a solid, walls bound wedges of the inside alternately with wedges of the outside. A
//! surface is well connected there if each pair (two walls that go over into each other) bounds one wedge of
//! the inside. A polygon that was joined across the edge, or a fold whose vertices are not those of the other
//! walls, may connect walls that do not belong together. Then other walls lie between the two, on the side of
//! the inside.

use std::sync::Arc;

use smallvec::SmallVec;

use super::Surface;
use crate::extract::joining::chords::EdgeContact;
use crate::geometry::points;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::mesh::handle::FaceId;
use crate::mesh::topology::{Topology, NONE};

/// Two walls of a surface that go over into each other at a segment: the two triangles at an edge, or one
/// triangle that contains the segment.
#[derive(Clone, Copy, Debug)]
pub struct WallPair {
    /// A triangle at the segment.
    pub wall: u32,
    /// The triangle across the edge that contains the segment, and its corner that is not on this edge.
    pub mate: Option<Mate>,
}

/// The triangle on the other side of an edge.
#[derive(Clone, Copy, Debug)]
pub struct Mate {
    /// The triangle.
    pub wall: u32,
    /// The index of the triangle's corner that is not on the edge.
    pub apex: usize,
}

impl WallPair {
    /// The pair of a triangle at one of its edges, or inside it.
    pub fn at(wall: u32, edge: Option<usize>, topology: &Topology) -> Self {
        let mate = edge.and_then(|edge| {
            let half = topology.mates()[3 * wall as usize + edge];
            (half != NONE).then(|| Mate {
                wall: FaceId::of_half_edge(half).0,
                apex: (half as usize + 2) % 3,
            })
        });
        Self { wall, mate }
    }

    /// The triangles of the pair.
    pub fn walls(&self) -> impl Iterator<Item = u32> {
        std::iter::once(self.wall).chain(self.mate.map(|mate| mate.wall))
    }

    /// Returns true if a wall that ends at the pair's segment lies between the two walls of the pair, on
    /// the side of the inside; `point` is in the wall, but not on the segment's line.
    pub fn has_inside(&self, point: &Vertex, surface: &Surface) -> bool {
        let is_below = |wall: u32| surface.side(wall, point) == Side::Minus;
        let Some(mate) = self.mate else {
            return is_below(self.wall);
        };
        let [first, second] = [self.wall, mate.wall];
        let apex = &surface.corners(second)[mate.apex];
        match surface.side(first, apex) {
            Side::Minus => is_below(first) && is_below(second),
            Side::On => is_below(first),
            Side::Plus => is_below(first) || is_below(second),
        }
    }
}

/// Returns the contacts of pairs of walls that pass through one another, among pairs of triangles of a reduced
/// solid's surface.
pub fn passing(surface: &Surface, pairs: &[[u32; 2]]) -> Vec<EdgeContact> {
    let mut meetings = pairs.iter().filter_map(|pair| Meeting::of(surface, *pair));
    let Some(first) = meetings.next() else {
        return Vec::new();
    };
    let topology = Topology::new(surface.triangles(), surface.vertex_count());
    let all = std::iter::once(first).chain(meetings);
    all.flat_map(|meeting| meeting.contacts(surface, &topology))
        .collect()
}

/// Returns true if two triangles of a pair have a segment in common, or may have an area in common.
pub fn share_more_than_points(surface: &Surface, pairs: &[[u32; 2]]) -> bool {
    let are_coplanar = |[t, u]: &[u32; 2]| surface.sides(*t, *u) == [Side::On; 3];
    let mut pairs = pairs.iter();
    pairs.any(|pair| are_coplanar(pair) || Meeting::of(surface, *pair).is_some())
}

/// Returns the contacts at which all walls of two pairs are divided; a corner of `hull` or a point between
/// its corners is on each point of the segment that the pairs share.
pub fn contacts_of(
    surface: &Surface,
    pairs: [WallPair; 2],
    hull: &SmallVec<[Arc<Vertex>; 3]>,
) -> Vec<EdgeContact> {
    let walls: SmallVec<[u32; 4]> = pairs.iter().flat_map(WallPair::walls).collect();
    let contact = |wall: &u32| {
        let plane = surface.plane(*wall);
        let crosses = |other: &&u32| surface.plane(**other).coincides(&plane).is_none();
        let across = surface.face(*walls.iter().find(crosses)?);
        Some(EdgeContact {
            hull: hull.clone(),
            beside: [across; 2],
            face: surface.face(*wall),
        })
    };
    walls.iter().filter_map(contact).collect()
}

/// Two triangles of different planes that share a segment, each with the sides of the other's plane on which
/// its corners lie.
struct Meeting {
    triangles: [u32; 2],
    sides: [[Side; 3]; 2],
}

impl Meeting {
    /// Returns how two triangles meet if they share a segment, but lie in different planes.
    fn of(surface: &Surface, [t, u]: [u32; 2]) -> Option<Self> {
        poll();
        let sides = [surface.sides(u, t), surface.sides(t, u)];
        let corners = [t, u].map(|triangle| surface.corners(triangle));
        share_segment(&corners, sides).then_some(Self {
            triangles: [t, u],
            sides,
        })
    }

    fn contacts(&self, surface: &Surface, topology: &Topology) -> Vec<EdgeContact> {
        let pair = |i: usize| WallPair::at(self.triangles[i], edge_on(self.sides[i]), topology);
        let pairs = [pair(0), pair(1)];
        let is_joined = pairs[0]
            .mate
            .is_some_and(|mate| mate.wall == self.triangles[1]);
        let passes = |i: usize| {
            let corners = surface.corners(self.triangles[1 - i]);
            let mut beside = corners.iter().zip(self.sides[1 - i]);
            beside.any(|(p, side)| side != Side::On && pairs[i].has_inside(p, surface))
        };
        if is_joined || !(passes(0) || passes(1)) {
            return Vec::new();
        }
        let hull = surface.corners(self.triangles[0]).map(Arc::new);
        contacts_of(surface, pairs, &hull.into_iter().collect())
    }
}

/// Returns true if two triangles of different planes share a segment; `sides` are the sides of the other's
/// plane on which the corners of each lie, `Plus` where the other's corners are counterclockwise.
///
/// Both triangles meet the common line of their planes in intervals. Along the line, in one direction of it,
/// the first triangle's interval begins where its border rises to the plus side, and the second's ends there.
/// Two of the borders' edges are ordered along the line by the orientation of their four ends.
fn share_segment(corners: &[[Vertex; 3]; 2], sides: [[Side; 3]; 2]) -> bool {
    let [Some(first), Some(second)] = sides.map(line_ends) else {
        return false;
    };
    let order = |[a, b]: [usize; 2], [c, d]: [usize; 2]| {
        let [p, q] = [a, b].map(|i| &corners[0][i]);
        let [r, s] = [c, d].map(|i| &corners[1][i]);
        points::side([p, q, r], s)
    };
    order(first.rising, second.rising) == Side::Plus
        && order(first.falling, second.falling) == Side::Minus
}

/// The two ends of a triangle's intersection with a plane, each as an edge of the triangle: the indices of
/// the edge's corners, the one nearer to the minus side first.
struct LineEnds {
    /// The edge at which the triangle's border, followed counterclockwise, rises to the plus side.
    rising: [usize; 2],
    falling: [usize; 2],
}

/// Returns the ends of a triangle's intersection with a plane, given the sides of its corners; `None` if the
/// intersection is not a segment.
fn line_ends(sides: [Side; 3]) -> Option<LineEnds> {
    let count = |side: Side| sides.iter().filter(|s| **s == side).count();
    let is_segment = match count(Side::On) {
        0 | 1 => count(Side::Plus) > 0 && count(Side::Minus) > 0,
        on => on == 2,
    };
    let far = if count(Side::Plus) > 0 {
        Side::Plus
    } else {
        Side::Minus
    };
    let next = |i: usize| (i + 1) % 3;
    let enters = (0..3).find(|i| sides[*i] != far && sides[next(*i)] == far);
    let leaves = (0..3).find(|i| sides[*i] == far && sides[next(*i)] != far);
    let (enters, leaves) = enters.zip(leaves).filter(|_| is_segment)?;
    let [rising, falling] = if far == Side::Plus {
        [enters, leaves]
    } else {
        [leaves, enters]
    };
    Some(LineEnds {
        rising: [rising, next(rising)],
        falling: [next(falling), falling],
    })
}

/// The edge of a triangle that lies in a plane, given the sides of the triangle's corners.
fn edge_on(sides: [Side; 3]) -> Option<usize> {
    (0..3).find(|i| sides[*i] == Side::On && sides[(i + 1) % 3] == Side::On)
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;

    use proptest::prelude::*;

    use super::*;
    use crate::arith::Sign;
    use crate::extract::mesh::Mesh;
    use crate::extract::rounding::round::mesh;
    use crate::geometry::plane::{normal, Lattice};
    use crate::merge::expression::Term;
    use crate::merge::scenes::{made_of, prism};

    fn dot(n: [i128; 3], p: &Lattice) -> i128 {
        (0..3).map(|i| n[i] * i128::from(p[i])).sum()
    }

    /// The ends of a triangle's intersection with the plane of another, as fractions along the common line.
    fn interval(own: &[Lattice; 3], other: &[Lattice; 3]) -> Option<[(i128, i128); 2]> {
        let [m, n] = [own, other].map(|[a, b, c]| normal(a, b, c));
        let along = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| m[j] * n[k] - m[k] * n[j]);
        let height = own.map(|p| dot(n, &p) - dot(n, &other[0]));
        let cut = |i: usize, j: usize| {
            let (a, b) = (height[i], height[j]);
            let place = dot(along, &own[i]) * b - dot(along, &own[j]) * a;
            (a * b <= 0 && a != b).then(|| (place * (b - a).signum(), (b - a).abs()))
        };
        let mut cuts: Vec<_> = [(0, 1), (1, 2), (2, 0)]
            .into_iter()
            .filter_map(|(i, j)| cut(i, j))
            .collect();
        cuts.sort_by(order);
        Some([*cuts.first()?, *cuts.last()?])
    }

    fn order(p: &(i128, i128), q: &(i128, i128)) -> Ordering {
        (p.0 * q.1).cmp(&(q.0 * p.1))
    }

    /// Returns true if both intervals on the common line overlap in more than a point.
    fn overlap(p: &[Lattice; 3], q: &[Lattice; 3]) -> bool {
        // The line of `q` and `p` runs in the other direction.
        let turned = |[low, high]: [(i128, i128); 2]| [(-high.0, high.1), (-low.0, low.1)];
        let (Some([a, b]), Some([c, d])) = (interval(p, q), interval(q, p).map(turned)) else {
            return false;
        };
        let [low, high] = [
            if order(&a, &c).is_gt() { a } else { c },
            if order(&b, &d).is_lt() { b } else { d },
        ];
        order(&low, &high).is_lt()
    }

    fn triangle() -> impl Strategy<Value = [Lattice; 3]> {
        let point = || [0..=3i64, 0..=3i64, 0..=2i64];
        [point(), point(), point()]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(8000))]
        #[test]
        fn triangles_share_a_segment_if_their_intervals_overlap(p in triangle(), q in triangle()) {
            let [m, n] = [&p, &q].map(|[a, b, c]| normal(a, b, c));
            let parallel = (0..3).all(|i| m[i] * n[(i + 1) % 3] == m[(i + 1) % 3] * n[i]);
            if parallel { return Ok(()) }
            let side = |n, base: Lattice, a: Lattice| Side::from_sign(Sign::of(dot(n, &a) - dot(n, &base)));
            let sides = [p.map(|a| side(n, q[0], a)), q.map(|a| side(m, p[0], a))];
            let corners = [p, q].map(|t| t.map(Vertex::lattice));
            prop_assert_eq!(share_segment(&corners, sides), overlap(&p, &q));
        }
    }

    /// The mesh of the symmetric difference of prisms over triangles of which an edge passes through (0, 0).
    fn fan(count: usize) -> Mesh {
        let ends = [[9, 0], [7, 5], [3, 8], [-2, 9], [-6, 7]];
        let wedge = |[x, y]: &[i64; 2]| prism(&[[-x, -y, 0], [*x, *y, 0], [-20 * y, 20 * x, 0]], 4);
        let wedges = ends[..count].iter().map(wedge);
        let all = wedges.reduce(|all, next| made_of(&[all, next], Term::Xor));
        mesh(&all.expect("wedges")).expect("bounded")
    }

    #[test]
    fn planes_that_pass_through_one_edge_are_divided_there() {
        for count in 2..=5 {
            let mesh = fan(count);
            let codes: Vec<String> = mesh.findings.iter().map(|f| f.code.to_string()).collect();
            assert_eq!(codes, ["edge_contact"], "{count}");
            // With an even number of planes, opposite walls face opposite ways and are not one polygon.
            assert_eq!(
                mesh.patches.contacts().is_empty(),
                count % 2 == 0,
                "{count}"
            );
        }
    }
}
