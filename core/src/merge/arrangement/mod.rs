//! The arrangement of two meshes in general position: each face is cut once, by all that crosses it.
//!
//! The stages, each in a file of its own: faces that may meet (`probe`, `occupancy`, `candidates`), pairs
//! of them whose boxes meet (`boxes`), the segments in which they cross (`contact`, `segments`), the cells
//! into which segments divide a face (`triangulation`, `faces`), winding numbers (`labels`), and the leaf
//! that lists what stays. Whatever is not in general position is left to the descent.

mod boxes;
mod candidates;
mod contact;
mod faces;
mod labels;
mod occupancy;
mod probe;
mod segments;
mod surfaces;
mod triangulation;

use std::sync::Arc;

use smallvec::SmallVec;

use candidates::{Operand, Within};
use faces::{above, Arrangement, Cell as FaceCell, Face, Planes, Shared};
use labels::Labels;
use occupancy::Occupancy;
use probe::probe;
use segments::{contacts, Contacts, Cover, Edge, Point as CommonPoint, Segment};
use surfaces::Surfaces;
use triangulation::Special;

use super::expression::Expression;
use super::lists::list::Sources;
use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::doubles::Point;
use crate::geometry::edge::LatticeEdge;
use crate::geometry::plane::{normal, Lattice, Plane};
use crate::geometry::side::Orientation;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::mesh::handle::{FaceId, VertexId};
use crate::mesh::tasks::{both, each, Worth};
use crate::tree::node::{Branch, Deferred, Group, Node, Part, PartElement};
use crate::tree::solid::Solid;

/// Faces in one box that are worth waking a pool: they take some milliseconds.
pub const POOL: usize = 4096;

/// Work that is handed to other threads at once.
const TASK: usize = 32;

/// What two operands leave, and how many faces were compared.
#[derive(Debug)]
pub struct Arranged {
    /// The root of the result.
    pub root: Branch,
    /// The faces in the box that the operands have in common.
    pub compared: usize,
}

/// The value of an expression over two meshes as they were given; `None` if the operands are something
/// else, or lie apart, or touch, or overlap themselves where they meet.
pub fn arranged(expression: &Expression, solids: &[Solid], sources: &Sources) -> Option<Arranged> {
    let operands = operands(expression, solids, sources)?;
    let window = window(operands.each_ref().map(|o| o.bounds))?;
    let faces: usize = operands.iter().map(|o| o.mesh.faces.len()).sum();
    let worth = Worth::pool_if(faces >= POOL);
    let within = for_both(worth, |k| operands[k].within(&window));
    probe(&operands, &within).ok()?;
    let compared = within.iter().map(|w| w.faces.len()).sum();
    let occupied = for_both(worth, |k| {
        let triangle = |i: usize| operands[k].triangle(within[k].faces[i]);
        Occupancy::of(&window, &within[k].boxes, triangle, compared)
    });
    let candidates = for_both(worth, |k| {
        operands[k].candidates(&within[k], &occupied[1 - k], &window[0])
    });
    let scene = Scene {
        surfaces: Surfaces {
            operands,
            second: as_number(candidates[0].faces.len()),
            candidates,
        },
        within,
        cell: solids[0].root().cell.join(&solids[1].root().cell),
        kept: Kept::of(expression),
        worth,
    };
    let root = scene.root().ok()?;
    Some(Arranged { root, compared })
}

/// A value for each operand, made at the same time where that pays.
fn for_both<T: Send>(worth: Worth, value: impl Fn(usize) -> T + Sync) -> [T; 2] {
    both(worth, || value(0), || value(1)).into()
}

/// The operands, if they are two different meshes as they were given.
fn operands<'a>(
    expression: &Expression,
    solids: &'a [Solid],
    sources: &Sources,
) -> Option<[Operand<'a>; 2]> {
    let [first, second] = solids else {
        return None;
    };
    let operand = |solid: &'a Solid| {
        let source = solid.whole_mesh().filter(|_| !solid.root().complement)?;
        Operand::new(sources.slot(source), source)
    };
    let operands = [operand(first)?, operand(second)?];
    let are_in_order = operands[0].slot < operands[1].slot;
    (are_in_order && expression.operands() == [0, 1]).then_some(operands)
}

/// The box that two boxes have in common.
fn window([[low, high], [others_low, others_high]]: [[Lattice; 2]; 2]) -> Option<[Point; 2]> {
    let low = each_axis(|i| low[i].max(others_low[i]));
    let high = each_axis(|i| high[i].min(others_high[i]));
    let meet = (0..3).all(|i| low[i] <= high[i]);
    meet.then(|| [low, high].map(|corner| corner.map(as_double)))
}

/// The orientation in which the faces of each operand stay, by the other one's winding numbers in front
/// of them and behind.
#[derive(Debug)]
struct Kept {
    of: [[[Option<Orientation>; 2]; 2]; 2],
    /// The value outside of both operands.
    outside: bool,
}

impl Kept {
    fn of(expression: &Expression) -> Self {
        let mut scratch = Vec::new();
        let mut value = |inside: [bool; 2]| expression.value(|k| inside[k as usize], &mut scratch);
        let mut stays = |operand: usize, in_front: bool, behind: bool| {
            let mut at = |own: bool, other: bool| {
                let mut inside = [other; 2];
                inside[operand] = own;
                value(inside)
            };
            let (in_front, behind) = (at(false, in_front), at(true, behind));
            (behind != in_front).then(|| Orientation::turned_around(in_front))
        };
        let of = [0, 1].map(|operand| {
            [false, true].map(|front| [false, true].map(|behind| stays(operand, front, behind)))
        });
        let outside = value([false; 2]);
        Self { of, outside }
    }

    /// Return whether it depends on the other operand what stays of an operand's faces.
    fn is_divided(&self, operand: usize) -> bool {
        let first = self.of[operand][0][0];
        self.of[operand].as_flattened().iter().any(|k| *k != first)
    }

    /// The orientation in which a face stays, by the other operand's numbers in front of it and behind.
    ///
    /// # Errors
    /// `Special` where the other operand winds around the place neither once nor not at all.
    fn at(
        &self,
        operand: usize,
        [in_front, behind]: [i32; 2],
    ) -> Result<Option<Orientation>, Special> {
        let [in_front, behind] = [in_front, behind].map(usize::try_from);
        let by_front = self.of[operand].get(in_front.map_err(|_| Special)?);
        let stays = by_front.and_then(|b| b.get(behind.ok()?));
        stays.copied().ok_or(Special)
    }

    /// The same for a cell of a face.
    fn of_cell(
        &self,
        operand: usize,
        cell: &FaceCell,
        first: i32,
    ) -> Result<Option<Orientation>, Special> {
        let in_front = first + cell.in_front;
        let stays = self.at(operand, [in_front, in_front + cell.behind])?;
        Ok(stays.filter(|_| !cell.is_others))
    }
}

/// Two meshes, and the faces of them that may meet.
#[derive(Debug)]
struct Scene<'a> {
    surfaces: Surfaces<'a>,
    within: [Within; 2],
    cell: Cell,
    kept: Kept,
    worth: Worth,
}

/// What becomes of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Gone,
    /// It stays as it is; true if it touches others.
    Whole(Orientation, bool),
    Cut,
}

impl Fate {
    fn of(stays: Option<Orientation>, touches: bool) -> Self {
        stays.map_or(Self::Gone, |orientation| Self::Whole(orientation, touches))
    }
}

/// What stays of a face that was arranged: all of it one way, or a part each way.
enum Left {
    Whole(Option<Orientation>),
    Parts([Option<PartElement>; 2]),
}

impl Scene<'_> {
    fn root(&self) -> Result<Branch, Special> {
        let found = contacts(&self.surfaces, self.worth)?;
        let shared = self.shared(&found);
        let mut leaf = Deferred {
            corner: i32::from(self.kept.outside),
            worked: true,
            ..Deferred::default()
        };
        for left in for_both(self.worth, |k| self.left(k, &found, &shared)) {
            let (groups, parts) = left?;
            leaf.groups.extend(groups);
            leaf.parts.extend(parts);
        }
        if leaf.is_empty() {
            return Ok(Branch::uniform(self.cell, leaf.corner));
        }
        Ok(Branch {
            cell: self.cell,
            outside: leaf.corner,
            complement: false,
            node: Arc::new(Node::Deferred(leaf)),
        })
    }

    /// The points and planes of all that meets.
    fn shared<'b>(&'b self, found: &'b Contacts) -> Shared<'b> {
        let planes = self.planes(found);
        let blocks = found.points.chunks(TASK).collect();
        let vertices = each(self.worth, blocks, |block: &[CommonPoint]| {
            let vertex = |point: &CommonPoint| Arc::new(self.vertex(point, &planes));
            block.iter().map(vertex).collect::<Vec<_>>()
        });
        Shared {
            surfaces: &self.surfaces,
            points: &found.points,
            vertices: vertices.concat(),
            planes,
        }
    }

    /// The planes of the faces that meet others.
    fn planes(&self, found: &Contacts) -> Planes {
        let faces = self.arranged_faces(found);
        let planes = each(
            self.worth,
            faces.chunks(TASK).collect(),
            |block: &[u32]| {
                let planes = block
                    .iter()
                    .map(|f| self.surfaces.operand(*f).source.plane(self.surfaces.id(*f)));
                planes.collect::<Vec<_>>()
            },
        );
        faces.into_iter().zip(planes.concat()).collect()
    }

    /// The faces that meet others, but for those that only touch others in points and have a corner that
    /// does not; ascending.
    fn arranged_faces(&self, found: &Contacts) -> Vec<u32> {
        let segments = found
            .segments
            .chunk_by(|a, b| a.face == b.face)
            .map(|run| run[0].face);
        let covered = found.covers.iter().map(|c| c.face);
        let mut faces: Vec<u32> = segments.chain(covered).collect();
        for k in [0, 1] {
            let mut touching = found.touching[k].clone();
            touching.sort_unstable();
            let touches = |v: &VertexId| touching.binary_search(v).is_ok();
            let of_operand = found
                .touched
                .iter()
                .filter(|f| self.surfaces.operand_of(**f) == k);
            faces.extend(of_operand.filter(|f| self.surfaces.vertices(**f).iter().all(touches)));
        }
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    fn vertex(&self, point: &CommonPoint, planes: &Planes) -> Vertex {
        let edge = |(operand, ends): &Edge| {
            let places = &self.surfaces.operands[*operand].mesh.vertices;
            let [from, to] = ends.map(|v| places[v.place()]);
            LatticeEdge::new(from, to)
        };
        match point {
            CommonPoint::Corner(place) => Vertex::lattice(*place),
            CommonPoint::Through(through, face) => Vertex::on_edge(&edge(through), &planes[face])
                .expect("an edge with ends on both sides of a plane meets it"),
            CommonPoint::Edges([first, second]) => crossing(&edge(first), &edge(second)),
        }
    }

    /// The arrangements in all faces of an operand that meet the other one.
    fn arrangements<'b>(
        &self,
        operand: usize,
        found: &'b Contacts,
        shared: &'b Shared,
    ) -> Result<Vec<Arrangement<'b>>, Special> {
        let mut faces: Vec<u32> = shared.planes.keys().copied().collect();
        faces.retain(|f| self.surfaces.operand_of(*f) == operand);
        faces.sort_unstable();
        let arranged = |number: u32| {
            let face = Face {
                number,
                operand,
                corners: self.surfaces.corners(number),
                vertices: self.surfaces.vertices(number),
                plane: &shared.planes[&number],
                segments: run(&found.segments, number, |s: &Segment| s.face),
                covers: run(&found.covers, number, |c: &Cover| c.face),
            };
            Arrangement::new(face, shared)
        };
        let found = each(
            self.worth,
            faces.chunks(TASK).collect(),
            |block: &[u32]| {
                let block = block.iter().map(|number| arranged(*number));
                block.collect::<Result<Vec<_>, Special>>()
            },
        );
        let found: Result<Vec<Vec<_>>, Special> = found.into_iter().collect();
        Ok(found?.into_iter().flatten().collect())
    }

    /// What stays of an operand: whole faces, and parts of those that are divided.
    fn left(
        &self,
        operand: usize,
        found: &Contacts,
        shared: &Shared,
    ) -> Result<(Vec<Group>, Vec<PartElement>), Special> {
        let count = self.surfaces.operands[operand].mesh.faces.len();
        let mut fates = vec![Fate::of(self.kept.at(operand, [0; 2])?, false); count];
        let mut parts = Vec::new();
        if self.kept.is_divided(operand) {
            let mut arranged = self.arrangements(operand, found, shared)?;
            let mut labels = self.labels(operand, &arranged, &found.touching[operand])?;
            let firsts = arranged.iter_mut().map(|a| first_number(a, &mut labels));
            let firsts = firsts.collect::<Result<Vec<i32>, Special>>()?;
            self.decide(operand, &arranged, &mut labels, found, &mut fates)?;
            parts = self.parts(operand, arranged, firsts, &mut fates)?;
        }
        Ok((self.groups(operand, &fates), parts))
    }

    /// Decides the faces of an operand where the other one is, but for those that were arranged.
    fn decide(
        &self,
        operand: usize,
        arranged: &[Arrangement],
        labels: &mut Labels,
        found: &Contacts,
        fates: &mut [Fate],
    ) -> Result<(), Special> {
        let mesh = self.surfaces.operands[operand].mesh;
        for arrangement in arranged {
            fates[self.surfaces.id(arrangement.face.number).place()] = Fate::Cut;
        }
        for id in &self.within[operand].faces {
            poll();
            if fates[id.place()] != Fate::Cut {
                let corners = mesh.vertices_of(*id);
                let free = corners.into_iter().find(|v| !labels.is_touching(*v));
                let number = labels.at(free.ok_or(Special)?);
                fates[id.place()] = Fate::of(self.kept.at(operand, [number; 2])?, false);
            }
        }
        for face in found
            .touched
            .iter()
            .filter(|f| self.surfaces.operand_of(**f) == operand)
        {
            if let Fate::Whole(_, touches) = &mut fates[self.surfaces.id(*face).place()] {
                *touches = true;
            }
        }
        Ok(())
    }

    /// The faces of an operand that stay whole.
    fn groups(&self, operand: usize, fates: &[Fate]) -> Vec<Group> {
        let Operand { mesh, source, .. } = self.surfaces.operands[operand];
        let group = |(touching, orientation)| Group {
            touching,
            source: Arc::clone(source),
            orientation,
            faces: Vec::new(),
        };
        let kinds = [false, true].map(|touching| Orientation::BOTH.map(|o| (touching, o)));
        let mut groups = kinds
            .as_flattened()
            .iter()
            .copied()
            .map(group)
            .collect::<Vec<_>>();
        for (id, fate) in mesh.face_ids().zip(fates) {
            if let Fate::Whole(orientation, touching) = fate {
                let kind = 2 * usize::from(*touching) + usize::from(orientation.is_opposite());
                groups[kind].faces.push(id);
            }
        }
        groups.retain(|g| !g.faces.is_empty());
        groups
    }

    /// The other operand's winding numbers around an operand's vertices.
    fn labels(
        &self,
        operand: usize,
        arranged: &[Arrangement],
        touching: &[VertexId],
    ) -> Result<Labels<'_>, Special> {
        let operands = &self.surfaces.operands;
        let mesh = operands[operand].mesh;
        let mut labels = Labels::new(operands[operand], operands[1 - operand], touching);
        let mut is_arranged = vec![false; mesh.faces.len()];
        for arrangement in arranged {
            is_arranged[self.surfaces.id(arrangement.face.number).place()] = true;
            let corners = (0..).zip(arrangement.face.vertices);
            let mut free = corners
                .filter(|(_, v)| !labels.is_touching(*v))
                .collect::<SmallVec<[_; 3]>>()
                .into_iter();
            if let Some((i, first)) = free.next() {
                for (k, vertex) in free {
                    let more = arrangement.at_corner(k) - arrangement.at_corner(i);
                    labels.join(vertex, first, more)?;
                }
            }
        }
        let others = self.within[operand].faces.iter();
        for id in others.filter(|id| !is_arranged[id.place()]) {
            poll();
            labels.join_corners(mesh.vertices_of(*id))?;
        }
        labels.note_beyond();
        Ok(labels)
    }

    /// The parts that stay of an operand's faces that were arranged, in the order of a leaf.
    fn parts(
        &self,
        operand: usize,
        mut arranged: Vec<Arrangement>,
        firsts: Vec<i32>,
        fates: &mut [Fate],
    ) -> Result<Vec<PartElement>, Special> {
        let numbered = arranged.iter_mut().zip(firsts);
        let mut all: Vec<(FaceId, &mut Arrangement, i32)> = numbered
            .map(|(a, first)| (self.surfaces.id(a.face.number), a, first))
            .collect();
        all.sort_unstable_by_key(|(id, ..)| *id);
        let ids: Vec<FaceId> = all.iter().map(|(id, ..)| *id).collect();
        let blocks = all.chunks_mut(TASK).collect();
        let found = each(
            self.worth,
            blocks,
            |block: &mut [(FaceId, &mut Arrangement, i32)]| {
                let left = block
                    .iter_mut()
                    .map(|(_, a, first)| self.left_of(operand, a, *first));
                left.collect::<Result<Vec<_>, Special>>()
            },
        );
        let found: Vec<Vec<Left>> = found.into_iter().collect::<Result<_, _>>()?;
        let mut parts = [Vec::new(), Vec::new()];
        for (id, left) in ids.into_iter().zip(found.into_iter().flatten()) {
            match left {
                Left::Whole(stays) => fates[id.place()] = Fate::of(stays, true),
                Left::Parts(of_face) => {
                    for (all, part) in parts.iter_mut().zip(of_face) {
                        all.extend(part);
                    }
                }
            }
        }
        Ok(parts.concat())
    }

    /// What stays of a face, given the number in front of its first cell.
    fn left_of(
        &self,
        operand: usize,
        arrangement: &mut Arrangement,
        first: i32,
    ) -> Result<Left, Special> {
        let stays = |cell: &FaceCell| self.kept.of_cell(operand, cell, first);
        let all = arrangement
            .cells
            .iter()
            .map(stays)
            .collect::<Result<Vec<_>, Special>>()?;
        if all.iter().all(|s| *s == all[0]) {
            return Ok(Left::Whole(all[0]));
        }
        let id = self.surfaces.id(arrangement.face.number);
        let mut part = |orientation: Orientation| {
            let edges = arrangement.outline(|cell| stays(cell) == Ok(Some(orientation)));
            (!edges.is_empty()).then(|| {
                let source = Arc::clone(self.surfaces.operands[operand].source);
                let part = Arc::new(Part::new(source, id, self.cell, edges));
                PartElement { part, orientation }
            })
        };
        Ok(Left::Parts(Orientation::BOTH.map(&mut part)))
    }
}

/// Those of some sorted rows that are of a face.
fn run<T>(rows: &[T], face: u32, of: impl Fn(&T) -> u32) -> &[T] {
    let first = rows.partition_point(|row| of(row) < face);
    let count = rows[first..]
        .iter()
        .take_while(|row| of(row) == face)
        .count();
    &rows[first..first + count]
}

/// The point in which two edges cross.
fn crossing(first: &LatticeEdge, second: &LatticeEdge) -> Vertex {
    let ((a, b), (c, d)) = (first.ends(), second.ends());
    let place = each_axis(|i| a[i] + d[i] - c[i]);
    let normal = normal(a, b, &place);
    let axis = (0..3).max_by_key(|i| normal[*i].abs()).unwrap_or(0);
    let plane = Arc::new(Plane::beside_edge(c, d, axis));
    Vertex::on_edge(first, &plane).expect("edges that cross have different directions")
}

/// The other operand's number in front of the first cell of a face.
fn first_number(arrangement: &mut Arrangement, labels: &mut Labels) -> Result<i32, Special> {
    let mut corners = (0..).zip(arrangement.face.vertices);
    if let Some((i, vertex)) = corners.find(|(_, v)| !labels.is_touching(*v)) {
        return Ok(labels.at(vertex) - arrangement.at_corner(i));
    }
    let (cell, doubled) = arrangement.probe().ok_or(Special)?;
    let plane = arrangement.face.plane;
    let point = above(plane, doubled).ok_or(Special)?;
    Ok(labels.in_front(plane, &point, doubled) - arrangement.cells[cell].in_front)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{both as expression_of_both, cuboid, cuboids, tetrahedra};

    fn sources(solids: &[Solid; 2]) -> Sources {
        Sources::new(solids.iter().flat_map(|s| s.sources().iter()).collect())
    }

    /// The number of whole faces and of parts that an arrangement leaves.
    fn counts(solids: &[Solid; 2], term: fn(Vec<u32>) -> Term) -> Option<[usize; 2]> {
        let found = arranged(&expression_of_both(term), solids, &sources(solids))?;
        Some(match &*found.root.node {
            Node::Deferred(leaf) => [leaf.len() - leaf.parts.len(), leaf.parts.len()],
            _ => [0; 2],
        })
    }

    #[test]
    fn only_faces_that_cross_are_divided() {
        let solids = tetrahedra();
        assert_eq!(counts(&solids, Term::And), Some([0, 4]));
        assert_eq!(counts(&solids, Term::Or), Some([4, 4]));
    }

    #[test]
    fn faces_in_one_plane_are_divided_by_each_other() {
        let touching = [cuboid([0; 3], [4; 3]), cuboid([4, 1, 1], [8, 3, 3])];
        assert_eq!(counts(&touching, Term::Or), Some([20, 2]));
        assert_eq!(counts(&touching, Term::And), Some([0; 2]));
    }

    #[test]
    fn overlapping_meshes_are_left_to_others() {
        let first = cuboid([0; 3], [4; 3]);
        let twice = cuboids([[[-9, 1, 1], [9, 3, 3]], [[-9, 2, 2], [9, 5, 5]]]);
        assert_eq!(counts(&[first.clone(), twice], Term::Or), None);
        let apart = [first, cuboid([5; 3], [8; 3])];
        assert_eq!(counts(&apart, Term::Or), None);
    }

    #[test]
    fn a_mesh_inside_another_has_numbers_without_crossings() {
        let solids = [cuboid([0; 3], [9; 3]), cuboid([3, 4, 3], [5, 6, 7])];
        assert_eq!(counts(&solids, Term::And), Some([12, 0]));
        assert_eq!(counts(&solids, Term::Or), Some([12, 0]));
        assert_eq!(counts(&solids, Term::Xor), Some([24, 0]));
    }
}
