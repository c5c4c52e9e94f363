//! Finds the triangles of a mesh in doubles that cross or overlap, exactly.
//!
//! Surfaces may touch: points and edges that two parts of a mesh have in common are no crossings, whether or
//! not both parts have a vertex or an edge there.

use super::broad_phase::triangles_near;
use super::image::Image;
use super::star::is_star_shaped;
use crate::arith::convert::as_number;
use crate::geometry::doubles::meeting::{are_clear, folds_over, has_no_area, meeting_of, Meeting};
use crate::geometry::doubles::slabs::Slabs;
use crate::geometry::doubles::Facing;
use crate::interrupt::{poll, spend};
use crate::merge::pairs::{pairs, BoundedElement, BoxedElement, ElementsInBox};
use crate::mesh::crossing_edges::crossing;
use crate::mesh::faces::Faces;
use crate::mesh::handle::VertexId;
use crate::mesh::tasks::{both, each, each_chunk, WorkSize, CHUNK};
use crate::mesh::terrains::terrains;
use crate::mesh::topology::NONE;

/// The faults that keep a mesh from being embedded: triangles that cross, overlap or have no area.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Pairs of triangles that cross or overlap, the lower number first, in ascending order.
    pub crossings: Vec<[u32; 2]>,
    /// Triangles without area, ascending. They lie in their neighbours' edges and cross nothing.
    pub flat: Vec<u32>,
}

impl Faults {
    /// Returns true if there are no faults.
    pub fn is_empty(&self) -> bool {
        self.crossings.is_empty() && self.flat.is_empty()
    }

    /// Return the number of faults.
    pub fn count(&self) -> usize {
        self.crossings.len() + self.flat.len()
    }
}

/// Returns the faults of the triangles `some`, ascending, among themselves and with all other triangles, and
/// the crossings between other triangles with different party numbers.
///
/// Other triangles with one party number, such as the untouched faces of one input, are not compared.
pub fn faults(faces: &Faces, some: &[u32], party: impl Fn(u32) -> u32 + Sync + Send) -> Faults {
    let candidate = |e: &(u32, u32)| Candidate::of(faces, *e);
    let (mut candidates, (own, flat)) = both(
        WorkSize::pool_if(some.len() > TRIANGLES_PER_TASK),
        || -> Vec<Candidate> {
            let near = triangles_near(faces, some, &party);
            let has_area = near.iter().filter(|e| !has_no_area(&faces.corners(e.1)));
            has_area.map(candidate).collect()
        },
        || {
            let (own, flat) = parties(faces, some);
            (own.iter().map(candidate).collect::<Vec<Candidate>>(), flat)
        },
    );
    let next = candidates.last().map_or(0, |other| other.party + 1);
    candidates.extend(own.into_iter().map(|own| own.after(next)));
    let crossings = Search::among::<Meetings>(&candidates).settled(faces);
    Faults { crossings, flat }
}

/// Divides the triangles of `some` into two lists: the triangles with area, each with a party number, and
/// those without. Triangles with equal party numbers are known not to cross: all of a terrain have one
/// number, any other triangle has its own.
fn parties(faces: &Faces, some: &[u32]) -> (Vec<(u32, u32)>, Vec<u32>) {
    let pieces = terrains(faces, some);
    let alone = as_number(some.len());
    let party = |(at, piece): (u32, u32)| if piece == NONE { at } else { alone + piece };
    let numbered = (0u32..).zip(pieces).map(party).zip(some.iter().copied());
    let has_area = |e: &(u32, u32)| !has_no_area(&faces.corners(e.1));
    let (mut own, flat): (Vec<_>, Vec<_>) = numbered.partition(has_area);
    own.sort_unstable();
    (own, flat.into_iter().map(|e| e.1).collect())
}

/// Returns all faults of a mesh.
pub fn all_faults(faces: &Faces) -> Faults {
    if is_star_shaped(faces) {
        return Faults::default();
    }
    let all: Vec<u32> = (0..as_number(faces.triangles.len())).collect();
    faults(faces, &all, |_| 0)
}

/// Returns the pairs of triangles that share no edge and may have more in common than a corner, because the
/// filter could not exclude it. The lower number comes first; pairs ascend.
///
/// # Cost
/// That of `all_faults`.
pub fn close_pairs(faces: &Faces) -> Vec<[u32; 2]> {
    if is_star_shaped(faces) {
        return Vec::new();
    }
    let all: Vec<u32> = (0..as_number(faces.triangles.len())).collect();
    let (own, _) = parties(faces, &all);
    let candidate = |e: &(u32, u32)| Candidate::of(faces, *e);
    let candidates: Vec<Candidate> = own.iter().map(candidate).collect();
    ascending(Search::among::<ClosePairs>(&candidates).0)
}

/// Returns the pairs of triangles among `pairs` that cross or overlap, in ascending order.
///
/// # Cost
/// One comparison per pair, and a pass over the triangles if some meet along edges.
pub fn crossings_among(faces: &Faces, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut found = Meetings::default();
    for pair in pairs {
        if !pair.iter().any(|t| has_no_area(&faces.corners(*t))) {
            poll();
            let [p, q] = pair.map(|t| Candidate::of(faces, (0, t)));
            found.compare(&p, &q);
        }
    }
    found.settled(faces)
}

fn ascending(mut pairs: Vec<[u32; 2]>) -> Vec<[u32; 2]> {
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The least number of triangles for which a thread gets a task: half a millisecond of work or more.
const TRIANGLES_PER_TASK: usize = 512;

/// The number of pairs that are compared together, on several threads if there are any.
const PAIRS_PER_BATCH: usize = 8 * CHUNK;

/// A triangle that is compared with triangles of other party numbers; triangles with equal party numbers are
/// known not to cross.
struct Candidate {
    party: u32,
    triangle: u32,
    vertices: [VertexId; 3],
    facing: Facing,
}

impl Candidate {
    fn of(faces: &Faces, (party, triangle): (u32, u32)) -> Self {
        Self {
            party,
            triangle,
            vertices: faces.triangles[triangle as usize],
            facing: Facing::of(&faces.corners(triangle)),
        }
    }

    /// Raises the party number of the candidate triangle by `first`; triangles with equal party numbers are
    /// not compared.
    fn after(self, first: u32) -> Self {
        let party = first + self.party;
        Self { party, ..self }
    }

    /// Returns the edge, by its index in `other`, that the two triangles share in opposite directions;
    /// `None` if they share none.
    #[inline]
    fn common_edge(&self, other: &Self) -> Option<usize> {
        let ([a, b, c], [d, e, f]) = (self.vertices, other.vertices);
        let own = |from: VertexId, to: VertexId| {
            from == a && to == b || from == b && to == c || from == c && to == a
        };
        if own(e, d) {
            Some(0)
        } else if own(f, e) {
            Some(1)
        } else {
            own(d, f).then_some(2)
        }
    }
}

/// The result of a search over pairs of triangles that may meet.
trait PairFindings: Default + Send {
    /// Compares a pair, and records the result.
    fn compare(&mut self, p: &Candidate, q: &Candidate);

    /// Adds the results of another search to these results.
    fn with(self, others: Self) -> Self;
}

/// Pairs of triangles that cross, and pairs that meet along edges and may cross.
#[derive(Default)]
struct Meetings {
    crossings: Vec<[u32; 2]>,
    /// Pairs that meet along edges: whether surfaces cross there depends on the triangles on the other side
    /// of these edges.
    doubtful: Vec<([u32; 2], Meeting)>,
}

impl PairFindings for Meetings {
    fn compare(&mut self, p: &Candidate, q: &Candidate) {
        let [p, q] = ordered(p, q);
        let pair = [p.triangle, q.triangle];
        if let Some(edge) = p.common_edge(q) {
            if folds_over(&p.facing, &q.facing, edge) {
                self.crossings.push(pair);
            }
            return;
        }
        match meeting_of(&p.facing, &q.facing) {
            Meeting::Clear => {}
            Meeting::Crossing | Meeting::Overlap => self.crossings.push(pair),
            meeting => self.doubtful.push((pair, meeting)),
        }
    }

    fn with(mut self, others: Self) -> Self {
        self.crossings.extend(others.crossings);
        self.doubtful.extend(others.doubtful);
        self
    }
}

/// Pairs of triangles that may have more than a corner or an edge in common.
#[derive(Default)]
struct ClosePairs(Vec<[u32; 2]>);

impl PairFindings for ClosePairs {
    fn compare(&mut self, p: &Candidate, q: &Candidate) {
        if p.common_edge(q).is_none() && !are_clear(&p.facing, &q.facing) {
            let [p, q] = ordered(p, q);
            self.0.push([p.triangle, q.triangle]);
        }
    }

    fn with(mut self, others: Self) -> Self {
        self.0.extend(others.0);
        self
    }
}

/// Two candidates, the triangle with the lower number first.
fn ordered<'a>(p: &'a Candidate, q: &'a Candidate) -> [&'a Candidate; 2] {
    if p.triangle < q.triangle {
        [p, q]
    } else {
        [q, p]
    }
}

impl Meetings {
    /// Returns all crossings in ascending order, with the doubtful pairs that turn out to cross.
    fn settled(mut self, faces: &Faces) -> Vec<[u32; 2]> {
        self.crossings.extend(crossing(faces, self.doubtful));
        ascending(self.crossings)
    }
}

/// A search for pairs of candidate triangles that may meet.
struct Search<'a> {
    /// The triangles, sorted by party number; triangles with equal party numbers are known not to cross.
    candidates: &'a [Candidate],
    image: Image,
    slabs: Vec<Slabs>,
}

impl<'a> Search<'a> {
    /// Compares the pairs of candidate triangles with different party numbers that may meet; triangles with
    /// equal party numbers are known not to cross.
    fn among<K: PairFindings>(candidates: &'a [Candidate]) -> K {
        let corners = |k: u32| *candidates[k as usize].facing.triangle();
        let Some(image) = Image::of(candidates.len(), corners) else {
            return K::default();
        };
        let origin = corners(0)[0];
        let slabs = |c: &Candidate| Slabs::of(c.facing.triangle(), &origin);
        let search = Self {
            candidates,
            image,
            slabs: candidates.iter().map(slabs).collect(),
        };
        let boxes = (0..as_number(candidates.len())).map(|k| search.boxed(k));
        let parts =
            ElementsInBox::of(boxes.collect(), Image::BITS - 30).divided(TRIANGLES_PER_TASK);
        let found = each(WorkSize::Pool, parts, |part| search.findings_in(part));
        found.into_iter().fold(K::default(), K::with)
    }

    fn boxed(&self, k: u32) -> BoxedElement {
        let (low, high) = self.image.ends(k);
        let party = self.candidates[k as usize].party as usize;
        BoxedElement::new(party, k, [&low, &high], Image::BITS - 30)
    }

    fn bounded(&self, k: u32) -> BoundedElement {
        let (low, high) = self.image.ends(k);
        let Candidate { party, facing, .. } = &self.candidates[k as usize];
        BoundedElement {
            operand: *party as usize,
            low,
            high,
            corners: Some(facing.triangle().map(|p| self.image.place(&p))),
        }
    }

    /// Compares the pairs of candidates that belong to one part of space.
    fn findings_in<K: PairFindings>(&self, part: ElementsInBox) -> K {
        let mut found = K::default();
        let mut waiting = Vec::new();
        pairs(
            part,
            |k| self.bounded(k),
            |i, j| {
                if self.slabs[i as usize].miss(&self.slabs[j as usize]) {
                    return Some(());
                }
                waiting.push([i, j]);
                if waiting.len() == PAIRS_PER_BATCH {
                    self.compare_all(&waiting, &mut found);
                    waiting.clear();
                }
                Some(())
            },
        );
        self.compare_all(&waiting, &mut found);
        found
    }

    /// Compares pairs of candidates that may meet, and adds the results to `found`.
    fn compare_all<K: PairFindings>(&self, pairs: &[[u32; 2]], found: &mut K) {
        let looked = each_chunk(pairs, |_, pairs| {
            spend(pairs.len());
            let mut found = K::default();
            for [i, j] in pairs {
                let candidate = |k: &u32| &self.candidates[*k as usize];
                found.compare(candidate(i), candidate(j));
            }
            found
        });
        let before = std::mem::take(found);
        *found = looked.into_iter().fold(before, K::with);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::doubles::Point;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    /// The faults of two tetrahedra, the second of which is moved up by `up`.
    fn faults_of_two(up: f64) -> Faults {
        let places = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 4.0]];
        let above = places.map(|[x, y, z]| [x + 0.25, y + 0.25, z + up]);
        let second = TETRAHEDRON.map(|t| t.map(|v| v + 4));
        let faces = Faces {
            vertices: &[places, above].concat(),
            triangles: &VertexId::rows([TETRAHEDRON, second].concat()),
        };
        all_faults(&faces)
    }

    #[test]
    fn pairs_that_cross_are_found_and_neighbours_are_not() {
        let found = faults_of_two(2.0);
        assert!(found.flat.is_empty() && !found.crossings.is_empty());
        assert!(found.crossings.iter().all(|[t, u]| *t < 4 && *u >= 4));
        assert!(faults_of_two(9.0).is_empty());
    }

    /// Triangles over a coarse grid, which meet in all possible ways, rotated by an angle.
    fn soup(count: u32, steps: u32, angle: f64) -> (Vec<Point>, Vec<[VertexId; 3]>) {
        let next = |x: &u32| Some(x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
        let mut numbers = std::iter::successors(Some(7), next).map(|x| x >> 8);
        let mut number = |bound: u32| numbers.next().unwrap_or(0) % bound;
        let (sin, cos) = angle.sin_cos();
        let turned = |[x, y, z]: Point| [cos * x - sin * y, sin * x + cos * y, z / 3.0];
        let mut vertices = Vec::new();
        for _ in 0..count {
            let place = [(); 3].map(|()| number(20));
            for _ in 0..3 {
                vertices.push(turned(place.map(|x| f64::from(x + number(steps)))));
            }
        }
        let triangles = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        (vertices, VertexId::rows(triangles))
    }

    /// The crossings found by comparing all pairs of triangles.
    fn among_all_pairs(faces: &Faces) -> Vec<[u32; 2]> {
        let count = as_number(faces.triangles.len());
        let pairs = (0..count).flat_map(|t| (t + 1..count).map(move |u| [t, u]));
        crossings_among(faces, &pairs.collect::<Vec<[u32; 2]>>())
    }

    #[test]
    fn the_search_finds_what_comparing_all_pairs_does() {
        let mut crossings = 0;
        for (count, steps) in [(1, 3), (30, 12), (300, 3), (700, 5), (900, 2), (400, 30)] {
            for angle in [0.0, 0.3, std::f64::consts::FRAC_PI_4] {
                let (vertices, triangles) = soup(count, steps, angle);
                let faces = Faces {
                    vertices: &vertices,
                    triangles: &triangles,
                };
                let found = all_faults(&faces).crossings;
                assert_eq!(found, among_all_pairs(&faces), "{count} {steps} {angle}");
                crossings += found.len();
            }
        }
        assert!(crossings > 10_000, "{crossings}");
    }

    #[test]
    fn triangles_without_area_are_faults_of_their_own() {
        let vertices = [[0.0; 3], [2.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let faces = Faces {
            vertices: &vertices,
            triangles: &VertexId::rows([[0, 1, 2], [2, 1, 0]]),
        };
        assert_eq!(all_faults(&faces).flat, [0, 1]);
    }

    /// The vertices of a tetrahedron with a face in the plane z = 0, of an edge in that face, and apexes
    /// above and below the face.
    const PLACES: [Point; 12] = [
        [-9.0, -9.0, 0.0],
        [0.0, 18.0, 0.0],
        [9.0, -9.0, 0.0],
        [0.0, 0.0, -9.0],
        [-1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 3.0, 1.0],
        [0.0, 2.0, 2.0],
        [0.0, -2.0, 2.0],
        [0.0, -3.0, 1.0],
        [0.0, 3.0, -1.0],
        [0.0, -3.0, -1.0],
    ];

    /// The number of crossings of a tetrahedron with wedges at the edge from vertex 4 to 5, each given by
    /// its two other vertices; the same for any order of the triangles.
    fn crossings_with(wedges: &[[u32; 2]]) -> usize {
        let tetrahedron = |v: [u32; 4]| TETRAHEDRON.map(|t| t.map(|k| v[k as usize]));
        let wedge = |[a, b]: &[u32; 2]| tetrahedron([4, 5, *a, *b]);
        let mut triangles: Vec<[u32; 3]> = tetrahedron([0, 1, 2, 3]).to_vec();
        triangles.extend(wedges.iter().flat_map(wedge));
        let mut counts = (0..triangles.len()).map(|_| {
            triangles.rotate_left(1);
            let faces = Faces {
                vertices: &PLACES,
                triangles: &VertexId::rows(triangles.clone()),
            };
            all_faults(&faces).crossings.len()
        });
        let first = counts.next().unwrap_or(0);
        assert!(counts.all(|count| count == first), "{wedges:?}");
        first
    }

    // Found: where vertices were joined by place, as STL readers do, `Mesh.certificate` reported
    // crossings at edges of four triangles that only touch.
    #[test]
    fn wedges_that_share_an_edge_touch_what_it_lies_in() {
        assert_eq!(crossings_with(&[[6, 7]]), 0);
        assert_eq!(crossings_with(&[[6, 7], [8, 9]]), 0);
    }

    #[test]
    fn wedges_that_share_an_edge_cross_what_one_of_them_passes() {
        assert!(crossings_with(&[[6, 10]]) > 0);
        assert!(crossings_with(&[[7, 8], [9, 11]]) > 0);
    }
}
