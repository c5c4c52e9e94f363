//! Makes a rounded mesh embedded: finds and mends the crossings that rounding made.

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use super::broad_phase::triangles_near;
use super::crossings::{all_faults, faults, Faults};
use super::mend::{Mending, Precision};
use super::snapping::crossed;
use crate::arith::convert::as_number;
use crate::geometry::doubles::Point;
use crate::geometry::vertex::Vertex;
use crate::mesh::chain::is_closed;
use crate::mesh::faces::{edges, Faces};
use crate::mesh::grid::{snap_point, Pitch};
use crate::mesh::handle::VertexId;
use crate::mesh::snap::snap_all;
use crate::mesh::triangles::first_equal_vertices;

/// The largest number of rounds: each round mends the faults found, and the next round compares the changed
/// triangles with others.
const MAX_ROUNDS: usize = 4;

/// The largest number of crossing pairs per triangle for which a moved mesh is mended. If touching surfaces
/// were made to cross, they cross along curves, in fewer pairs than there are triangles. If more pairs cross,
/// whole surfaces coincide, and no change as small as the rounding separates them.
const MAX_CROSSINGS_PER_TRIANGLE: usize = 1;

/// A triangle mesh, closed by index, whose vertices were rounded.
#[derive(Clone, Debug)]
pub struct Rounded {
    /// The vertices.
    pub vertices: Vec<Point>,
    /// The triangles; a removed one has one corner three times.
    pub triangles: Vec<[VertexId; 3]>,
}

/// The result of removing the crossings that rounding made.
#[derive(Clone, Debug, Default)]
pub struct Settled {
    /// The number of triangles that were compared with all triangles near them.
    pub compared: usize,
    /// The triangles that were changed, ascending, including removed ones.
    pub mended: Vec<u32>,
    /// Vertices moved to their exact lattice points, ascending.
    pub moved: Vec<VertexId>,
    /// The crossings and flat triangles that could not be mended.
    pub left: Faults,
    /// Faults that surfaces have on the lattice, too; these are not mended.
    pub own: Faults,
}

/// Mends the faults `found` of the ascending triangles `changed`, as far as possible.
///
/// `exact` gives the lattice point of a vertex if the vertex's doubles differ from it; with all vertices at
/// their lattice points, surfaces do not cross. `given` is true for vertices of inputs. Triangles with equal
/// numbers `party` are known not to cross.
pub fn settle(
    mesh: &mut Rounded,
    mut changed: Vec<u32>,
    mut found: Faults,
    precision: Precision,
    exact: impl Fn(VertexId) -> Option<Point>,
    given: impl Fn(VertexId) -> bool,
    party: impl Fn(u32) -> u32,
) -> Settled {
    let mut settled = Settled::default();
    while !found.is_empty() {
        let moved = mesh.move_corners(&found, &exact);
        if moved.is_empty() {
            break;
        }
        let touched = mesh.stars(&moved);
        changed = merged(&changed, &touched);
        settled.moved = merged(&settled.moved, &moved);
        found = mesh.faults_after(&found, &changed, &touched, &party);
    }
    for _ in 0..MAX_ROUNDS {
        if found.is_empty() {
            break;
        }
        let touched = mesh.mend(&found, precision, &given);
        if touched.is_empty() {
            break;
        }
        settled.mended = merged(&settled.mended, &touched);
        changed = merged(&changed, &touched);
        changed.retain(|t| !mesh.is_removed(*t));
        found = mesh.faults_after(&found, &changed, &touched, &party);
    }
    settled.compared = changed.len();
    settled.left = found;
    settled
}

/// Rounds a mesh, closed by index, to single precision, and mends the crossings that this makes.
pub fn settle_in_single(mesh: &mut Rounded) -> Settled {
    let single = Precision::Single;
    let mut moved = vec![false; mesh.vertices.len()];
    for (place, moved) in mesh.vertices.iter_mut().zip(&mut moved) {
        let rounded = place.map(|x| single.round(x));
        *moved = differ(&rounded, place);
        *place = rounded;
    }
    let is_changed = |t: &u32| mesh.triangles[*t as usize].iter().any(|v| moved[v.index()]);
    let changed: Vec<u32> = (0..as_number(mesh.triangles.len()))
        .filter(is_changed)
        .collect();
    let found = mesh.faults(&changed, |_| 0);
    settle(mesh, changed, found, single, |_| None, |_| false, |_| 0)
}

/// Mends crossings made by moving the vertices of a mesh, whose old positions are `before`. If crossings are
/// left, first rounds the corners of faulty triangles to the lattice and tries again.
///
/// A mesh that crossed itself in its old position stays as it is (`own`), and so does a mesh of which the
/// map laid whole surfaces on each other (`left`). A mesh that is not closed by index is welded first, as on
/// import; it stays as it is if welding does not close it.
pub fn settle_moved(mesh: &mut Rounded, before: &[Point], pitch: Pitch) -> Settled {
    if !is_closed(&mesh.triangles) && !mesh.weld(pitch) {
        return Settled::default();
    }
    let mut found = all_faults(&mesh.faces());
    found.flat.retain(|t| !mesh.is_removed(*t));
    if found.crossings.is_empty() {
        return Settled::default();
    }
    let earlier = Faces {
        vertices: before,
        triangles: &mesh.triangles,
    };
    if crossed(&earlier, &found) {
        let own = found;
        return Settled {
            own,
            ..Settled::default()
        };
    }
    if found.crossings.len() > MAX_CROSSINGS_PER_TRIANGLE * mesh.triangles.len() {
        let left = found;
        return Settled {
            left,
            ..Settled::default()
        };
    }
    let moved = mesh.clone();
    let settled = mesh.settle_all(found.clone(), |_| None);
    if settled.left.is_empty() {
        return settled;
    }
    let mut other = moved;
    let again = other.settle_from_lattice(found, pitch);
    if again.left.count() >= settled.left.count() {
        return settled;
    }
    *mesh = other;
    again
}

impl Rounded {
    /// Welds the vertices at each lattice point, and removes triangles with a repeated corner; returns
    /// whether the remaining triangles are closed by index.
    fn weld(&mut self, pitch: Pitch) -> bool {
        let Ok(places) = snap_all(&self.vertices, pitch) else {
            return false;
        };
        let image = first_equal_vertices(&places);
        let joined = |t: &[VertexId; 3]| match t.map(|v| image[v.index()]) {
            [a, b, c] if a == b || b == c || c == a => [a; 3],
            apart => apart,
        };
        self.triangles = self.triangles.iter().map(joined).collect();
        let left = self.triangles.iter().filter(|t| t[0] != t[1]);
        is_closed(&left.copied().collect::<Vec<[VertexId; 3]>>())
    }

    /// Mends the faults `found` among all triangles.
    fn settle_all(&mut self, found: Faults, exact: impl Fn(VertexId) -> Option<Point>) -> Settled {
        let all = (0..as_number(self.triangles.len())).collect();
        let double = Precision::Double;
        settle(self, all, found, double, exact, |_| false, |_| 0)
    }

    /// Moves the corners of faulty triangles to lattice points, then mends the faults among all triangles.
    fn settle_from_lattice(&mut self, found: Faults, pitch: Pitch) -> Settled {
        let given = self.vertices.clone();
        let on_lattice = |v: VertexId| {
            let place = snap_point(pitch, given.get(v.index())?).ok()?;
            Some(pitch.position(&Vertex::lattice(place)))
        };
        self.settle_all(found, on_lattice)
    }

    /// The mesh with all its triangles.
    pub fn faces(&self) -> Faces<'_> {
        Faces {
            vertices: &self.vertices,
            triangles: &self.triangles,
        }
    }

    /// Returns the faults of the triangles `changed`, ascending, and crossings between triangles of
    /// different parties.
    pub fn faults(&self, changed: &[u32], party: impl Fn(u32) -> u32 + Sync + Send) -> Faults {
        if changed.is_empty() && self.is_of_one(&party) {
            return Faults::default();
        }
        faults(&self.faces(), changed, &party)
    }

    /// Returns the faults among the triangles `changed`, given the faults `found` before the triangles
    /// `touched` were altered: compares only the altered triangles and their neighbours.
    fn faults_after(
        &self,
        found: &Faults,
        changed: &[u32],
        touched: &[u32],
        party: impl Fn(u32) -> u32,
    ) -> Faults {
        // Whether surfaces cross at an edge depends on the neighbour there.
        let anew = merged(touched, &self.mates(touched));
        let is_anew = |t: &u32| anew.binary_search(t).is_ok();
        let is_changed = |t: &u32| changed.binary_search(t).is_ok();
        let is_wanted =
            |[t, u]: &[u32; 2]| is_changed(t) || is_changed(u) || party(*t) != party(*u);
        let mut faults = faults(&self.faces(), &anew, |_| 0);
        faults.crossings.retain(is_wanted);
        faults.flat.retain(is_changed);
        let same = found
            .crossings
            .iter()
            .filter(|pair| !pair.iter().any(is_anew));
        let same_flat = found.flat.iter().filter(|t| !is_anew(t));
        Faults {
            crossings: merged(&faults.crossings, &same.copied().collect::<Vec<[u32; 2]>>()),
            flat: merged(&faults.flat, &same_flat.copied().collect::<Vec<u32>>()),
        }
    }

    /// Returns the triangles that share an edge with one of the triangles `some`.
    fn mates(&self, some: &[u32]) -> Vec<u32> {
        let corners = some.iter().map(|t| self.triangles[*t as usize]);
        let wanted: HashSet<[VertexId; 2]> = corners.flat_map(edges).map(|[a, b]| [b, a]).collect();
        let mut is_end = vec![false; self.vertices.len()];
        for v in wanted.iter().flatten() {
            is_end[v.index()] = true;
        }
        let has =
            |edge: &[VertexId; 2]| edge.iter().all(|v| is_end[v.index()]) && wanted.contains(edge);
        let numbered = (0u32..).zip(&self.triangles);
        let mates = numbered.filter(|(_, corners)| edges(**corners).iter().any(has));
        mates
            .map(|(t, _)| t)
            .filter(|t| !self.is_removed(*t))
            .collect()
    }

    /// Returns true if all triangles have the same party number, so that they are known not to cross.
    fn is_of_one(&self, party: impl Fn(u32) -> u32) -> bool {
        (1..as_number(self.triangles.len())).all(|t| party(t) == party(0))
    }

    /// Returns true if a triangle was removed.
    pub fn is_removed(&self, triangle: u32) -> bool {
        let [a, b, _] = self.triangles[triangle as usize];
        a == b
    }

    /// Moves the corners of faulty triangles to their exact positions; returns the vertices that moved.
    fn move_corners(
        &mut self,
        found: &Faults,
        exact: impl Fn(VertexId) -> Option<Point>,
    ) -> Vec<VertexId> {
        let mut corners: Vec<VertexId> = members(found)
            .flat_map(|t| self.triangles[t as usize])
            .collect();
        corners.sort_unstable();
        corners.dedup();
        corners.retain(|&v| {
            let place = exact(v).filter(|p| differ(p, &self.vertices[v.index()]));
            if let Some(place) = place {
                self.vertices[v.index()] = place;
            }
            place.is_some()
        });
        corners
    }

    /// Returns the triangles around the given vertices, ascending.
    fn stars(&self, vertices: &[VertexId]) -> Vec<u32> {
        let wanted: HashSet<VertexId> = vertices.iter().copied().collect();
        let has = |t: &u32| {
            self.triangles[*t as usize]
                .iter()
                .any(|v| wanted.contains(v))
        };
        let all = 0..as_number(self.triangles.len());
        all.filter(has).filter(|t| !self.is_removed(*t)).collect()
    }

    /// Mends the part of the mesh around faults; returns the changed triangles, ascending.
    fn mend(
        &mut self,
        found: &Faults,
        precision: Precision,
        given: impl Fn(VertexId) -> bool,
    ) -> Vec<u32> {
        let corners = members(found).flat_map(|t| self.triangles[t as usize]);
        let core = self.stars(&corners.collect::<Vec<VertexId>>());
        let near = triangles_near(&self.faces(), &core, |_| 0);
        let some = merged(&core, &near.into_iter().map(|o| o.1).collect::<Vec<u32>>());
        let part = SubMesh::of(self, &some);
        let local = |t: &u32| as_number(some.binary_search(t).unwrap_or(0));
        let faults = Faults {
            crossings: found
                .crossings
                .iter()
                .map(|p| p.map(|t| local(&t)))
                .collect(),
            flat: found.flat.iter().map(local).collect(),
        };
        let vertices = part.globals.iter().map(|v| self.vertices[v.index()]);
        let marks = [
            part.is_cut_off(self),
            part.globals.iter().map(|v| given(*v)).collect(),
        ];
        let triangles = part.triangles.clone();
        let mut mending = Mending::new(vertices.collect(), triangles, marks, precision, &faults);
        mending.run();
        self.take_back(&mending, &part, &some)
    }

    /// Copies a mended part back into the mesh; returns the changed triangles.
    fn take_back(&mut self, mending: &Mending, part: &SubMesh, some: &[u32]) -> Vec<u32> {
        let mut globals = part.globals.clone();
        let first = self.vertices.len() - globals.len();
        for (v, place) in mending.vertices.iter().enumerate() {
            if let Some(global) = globals.get(v) {
                self.vertices[global.index()] = *place;
            } else {
                globals.push(VertexId::of(first + v));
                self.vertices.push(*place);
            }
        }
        let mut touched = Vec::new();
        for ((t, new), old) in some.iter().zip(&mending.triangles).zip(&part.triangles) {
            let moved = |v: &VertexId| mending.is_moved(*v);
            if new.as_ref() != Some(old) || old.iter().any(moved) {
                touched.push(*t);
            }
            self.triangles[*t as usize] = match new {
                Some(corners) => corners.map(|v| globals[v.index()]),
                None => [globals[old[0].index()]; 3],
            };
        }
        touched
    }
}

/// A part of a mesh, with its own numbering of vertices.
struct SubMesh {
    /// For each vertex of the part its number in the whole mesh.
    globals: Vec<VertexId>,
    triangles: Vec<[VertexId; 3]>,
}

impl SubMesh {
    fn of(mesh: &Rounded, some: &[u32]) -> Self {
        let mut numbers: HashMap<VertexId, VertexId> = HashMap::default();
        let mut globals = Vec::new();
        let triangles = some.iter().map(|t| {
            mesh.triangles[*t as usize].map(|v| {
                *numbers.entry(v).or_insert_with(|| {
                    globals.push(v);
                    VertexId::of(globals.len() - 1)
                })
            })
        });
        let triangles = triangles.collect();
        Self { globals, triangles }
    }

    /// Returns for each vertex whether a triangle around it is outside the part.
    fn is_cut_off(&self, mesh: &Rounded) -> Vec<bool> {
        let mut missing: HashMap<VertexId, usize> = HashMap::default();
        for v in self.triangles.iter().flatten() {
            *missing.entry(self.globals[v.index()]).or_default() += 1;
        }
        let mut whole = missing.clone();
        for count in whole.values_mut() {
            *count = 0;
        }
        let left = mesh.triangles.iter().filter(|t| t[0] != t[1]);
        for v in left.flatten() {
            if let Some(count) = whole.get_mut(v) {
                *count += 1;
            }
        }
        self.globals
            .iter()
            .map(|v| whole[v] != missing[v])
            .collect()
    }
}

#[allow(
    clippy::float_cmp,
    reason = "a place is another as soon as one bit differs"
)]
fn differ(p: &Point, q: &Point) -> bool {
    p != q
}

fn members(found: &Faults) -> impl Iterator<Item = u32> + '_ {
    let pairs = found.crossings.iter().flatten();
    pairs.chain(&found.flat).copied()
}

/// Merges two ascending lists, without repetitions.
fn merged<T: Copy + Ord>(a: &[T], b: &[T]) -> Vec<T> {
    let mut all = [a, b].concat();
    all.sort_unstable();
    all.dedup();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tetrahedra in a row, each of which overlaps the next.
    fn row(count: u32) -> Rounded {
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let places = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
        let at = |k: u32| places.map(|[x, y, z]| [x + 3.5 * f64::from(k), y, z]);
        let triangles = (0..count).flat_map(|k| faces.map(|t| t.map(|v| v + 4 * k)));
        Rounded {
            vertices: (0..count).flat_map(at).collect(),
            triangles: VertexId::rows(triangles),
        }
    }

    #[test]
    fn what_was_touched_is_compared_anew_and_gives_what_all_would() {
        let party = |t: u32| t / 8;
        for some in [vec![], (4..12).collect(), (0..24).collect::<Vec<u32>>()] {
            for vertex in 0..24 {
                for by in [-0.75, 0.75, 9.0] {
                    let mut mesh = row(6);
                    let before = mesh.faults(&some, party);
                    assert!(!before.is_empty());
                    mesh.vertices[vertex as usize][0] += by;
                    let touched = mesh.stars(&[VertexId(vertex)]);
                    let changed = merged(&some, &touched);
                    let after = mesh.faults_after(&before, &changed, &touched, party);
                    assert_eq!(after, mesh.faults(&changed, party), "{vertex} {by}");
                }
            }
        }
    }

    /// A tip that lies above a face, but that rounding put a little below it.
    #[test]
    fn a_corner_goes_to_its_exact_place_if_rounding_makes_surfaces_cross() {
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let both = [faces, faces.map(|t| t.map(|v| v + 4))].concat();
        let floor = [[0.0; 3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, -4.0]];
        let tip = [
            [1.0, 1.0, -0.01],
            [3.0, 1.0, 3.0],
            [1.0, 3.0, 3.0],
            [-1.0, -1.0, 3.0],
        ];
        let mut mesh = Rounded {
            vertices: [floor, tip].concat(),
            triangles: VertexId::rows(both),
        };
        let exact = |v: VertexId| (v == VertexId(4)).then_some([1.0, 1.0, 0.5]);
        let changed: Vec<u32> = (4..8).collect();
        let party = |t| t / 4;
        let found = mesh.faults(&changed, party);
        let double = Precision::Double;
        let settled = settle(&mut mesh, changed, found, double, exact, |_| false, party);
        assert_eq!(settled.moved, [VertexId(4)]);
        assert!(settled.left.is_empty() && settled.mended.is_empty());
        assert!(mesh.vertices[4][2] > 0.0);
    }

    /// A tip that touches a face of another tetrahedron if its height is 1.
    fn touching(tip: Point) -> Rounded {
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let floor = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0], [0.0; 3]];
        let above = [tip, [3.0, 1.0, 3.0], [1.0, 3.0, 3.0], [-1.0, -1.0, 3.0]];
        Rounded {
            vertices: [floor, above].concat(),
            triangles: VertexId::rows([faces, faces.map(|t| t.map(|v| v + 4))].concat()),
        }
    }

    #[test]
    fn what_moving_vertices_makes_cross_is_mended() {
        let before = touching([1.0, 1.0, 1.0]);
        let below = 1.0f64.next_down();
        let mut moved = touching([1.0, 1.0, below]);
        assert!(!all_faults(&moved.faces()).is_empty());
        let settled = settle_moved(&mut moved, &before.vertices, Pitch::DEFAULT);
        assert!(!settled.mended.is_empty() && settled.left.is_empty());
        assert!(all_faults(&moved.faces()).is_empty());
        assert_eq!(moved.triangles, before.triangles);
    }

    /// The same mesh, in which triangles share no vertices.
    fn unwelded(mesh: &Rounded) -> Rounded {
        let corners = mesh.triangles.iter().flatten();
        let rows = (0..as_number(mesh.triangles.len())).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        Rounded {
            vertices: corners.map(|v| mesh.vertices[v.index()]).collect(),
            triangles: VertexId::rows(rows),
        }
    }

    #[test]
    fn what_the_map_has_laid_on_each_other_is_told_and_left_alone() {
        let mut before = row(6);
        let mut moved = row(6);
        for v in 0..24 {
            let k = f64::from(as_number(v / 4));
            before.vertices[v][0] += k;
            moved.vertices[v][0] -= 3.5 * k;
        }
        assert!(all_faults(&before.faces()).is_empty());
        let triangles = moved.triangles.clone();
        let settled = settle_moved(&mut moved, &before.vertices, Pitch::DEFAULT);
        assert!(settled.left.crossings.len() > triangles.len() && settled.mended.is_empty());
        assert_eq!(moved.triangles, triangles);
    }

    #[test]
    fn what_is_closed_by_places_is_welded_and_mended() {
        let before = unwelded(&touching([1.0, 1.0, 1.0]));
        let mut moved = unwelded(&touching([1.0, 1.0, 1.0f64.next_down()]));
        let settled = settle_moved(&mut moved, &before.vertices, Pitch::DEFAULT);
        assert!(!settled.mended.is_empty() && settled.left.is_empty());
        assert!(is_closed(&moved.triangles) && all_faults(&moved.faces()).is_empty());
    }

    #[test]
    fn a_triangle_that_welding_leaves_no_area_is_removed_and_no_fault() {
        let mut before = unwelded(&touching([1.0, 1.0, 1.0]));
        let mut moved = unwelded(&touching([1.0, 1.0, 1.0f64.next_down()]));
        for mesh in [&mut before, &mut moved] {
            let again = [mesh.vertices[0], mesh.vertices[0], mesh.vertices[1]];
            mesh.vertices.extend(again);
            mesh.triangles.push([24, 25, 26].map(VertexId));
        }
        let settled = settle_moved(&mut moved, &before.vertices, Pitch::DEFAULT);
        assert!(!settled.mended.is_empty() && settled.left.is_empty());
        assert!(moved.is_removed(8) && !moved.is_removed(7));
    }

    #[test]
    fn what_crossed_before_it_was_moved_is_left_alone() {
        let before = touching([1.0, 1.0, 0.5]);
        let mut moved = touching([1.0, 1.0, 0.500_000_1]);
        let settled = settle_moved(&mut moved, &before.vertices, Pitch::DEFAULT);
        assert!(settled.mended.is_empty() && settled.left.is_empty());
        assert_eq!(settled.own, all_faults(&moved.faces()));
        assert!(!settled.own.is_empty());
    }
}
