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
mod triangulation;

use std::sync::Arc;

use candidates::{Candidates, Operand, Within};
use faces::{Arrangement, Face, Planes, Shared};
use labels::Labels;
use occupancy::Occupancy;
use probe::probe;
use segments::{segments, Crossing, Segment, Segments};
use triangulation::Special;

use super::expression::Expression;
use super::lists::list::Sources;
use crate::arith::convert::as_double;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::doubles::Point;
use crate::geometry::edge::LatticeEdge;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::side::Orientation;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::mesh::handle::FaceId;
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
        operands,
        within,
        candidates,
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

/// The orientation in which the faces of each operand stay, by the other one's winding number there.
#[derive(Debug)]
struct Kept {
    of: [[Option<Orientation>; 2]; 2],
    /// The value outside of both operands.
    outside: bool,
}

impl Kept {
    fn of(expression: &Expression) -> Self {
        let mut scratch = Vec::new();
        let mut value = |inside: [bool; 2]| expression.value(|k| inside[k as usize], &mut scratch);
        let mut stays = |operand: usize, other: bool| {
            let [behind, in_front] = [true, false].map(|own| {
                let mut inside = [other; 2];
                inside[operand] = own;
                value(inside)
            });
            (behind != in_front).then(|| Orientation::turned_around(in_front))
        };
        let of = [0, 1].map(|operand| [false, true].map(|other| stays(operand, other)));
        let outside = value([false; 2]);
        Self { of, outside }
    }

    /// Return whether it depends on the other operand what stays of an operand's faces.
    fn is_divided(&self, operand: usize) -> bool {
        self.of[operand][0] != self.of[operand][1]
    }

    /// The orientation in which a face stays.
    ///
    /// # Errors
    /// `Special` where the other operand winds around the place neither once nor not at all.
    fn at(&self, operand: usize, number: i32) -> Result<Option<Orientation>, Special> {
        let number = usize::try_from(number).map_err(|_| Special)?;
        self.of[operand].get(number).copied().ok_or(Special)
    }
}

/// Two meshes, and the faces of them that may meet.
#[derive(Debug)]
struct Scene<'a> {
    operands: [Operand<'a>; 2],
    within: [Within; 2],
    candidates: [Candidates; 2],
    cell: Cell,
    kept: Kept,
    worth: Worth,
}

/// What becomes of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    Gone,
    Whole(Orientation),
    Cut,
}

impl From<Option<Orientation>> for Fate {
    fn from(stays: Option<Orientation>) -> Self {
        stays.map_or(Self::Gone, Self::Whole)
    }
}

impl Scene<'_> {
    fn root(&self) -> Result<Branch, Special> {
        let found = segments(&self.operands, &self.candidates, self.worth)?;
        let shared = self.shared(&found);
        let mut leaf = Deferred {
            corner: i32::from(self.kept.outside),
            worked: true,
            ..Deferred::default()
        };
        for left in for_both(self.worth, |k| self.left(k, &found.of[k], &shared)) {
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

    /// The points and planes of all that crosses.
    fn shared<'b>(&self, found: &'b Segments) -> Shared<'b> {
        let planes = for_both(self.worth, |k| self.planes(k, &found.of[k]));
        let blocks = found.points.chunks(TASK).collect();
        let vertices = each(self.worth, blocks, |block: &[Crossing]| {
            let vertex = |c: &Crossing| self.vertex(c, &planes[1 - c.of][&c.face]);
            block.iter().map(vertex).collect::<Vec<_>>()
        });
        Shared {
            crossings: &found.points,
            vertices: vertices.concat(),
            planes,
        }
    }

    /// The planes of an operand's faces that are cut.
    fn planes(&self, operand: usize, segments: &[Segment]) -> Planes {
        let runs = segments.chunk_by(|a, b| a.face == b.face);
        let faces: Vec<u32> = runs.map(|run| run[0].face).collect();
        let source = self.operands[operand].source;
        let found = each(
            self.worth,
            faces.chunks(TASK).collect(),
            |block: &[u32]| {
                let ids = block.iter().map(|face| self.face(operand, *face));
                ids.map(|id| source.plane(id)).collect::<Vec<_>>()
            },
        );
        faces.iter().copied().zip(found.concat()).collect()
    }

    /// A face by its number among the candidates.
    fn face(&self, operand: usize, candidate: u32) -> FaceId {
        self.candidates[operand].faces[candidate as usize]
    }

    fn vertex(&self, crossing: &Crossing, plane: &Arc<Plane>) -> Arc<Vertex> {
        let places = &self.operands[crossing.of].mesh.vertices;
        let [from, to] = crossing.edge.map(|v| places[v.place()]);
        let vertex = Vertex::on_edge(&LatticeEdge::new(from, to), plane);
        Arc::new(vertex.expect("an edge with ends on both sides of a plane meets it"))
    }

    /// The arrangements in all faces of an operand that are cut.
    fn arrangements<'b>(
        &self,
        operand: usize,
        segments: &'b [Segment],
        shared: &'b Shared,
    ) -> Result<Vec<Arrangement<'b>>, Special> {
        let runs: Vec<&[Segment]> = segments.chunk_by(|a, b| a.face == b.face).collect();
        let mesh = self.operands[operand].mesh;
        let arranged = |segments: &'b [Segment]| {
            let id = self.face(operand, segments[0].face);
            let face = Face {
                operand,
                id,
                corners: mesh.corners(id),
                vertices: mesh.vertices_of(id),
                plane: &shared.planes[operand][&segments[0].face],
                segments,
            };
            Arrangement::new(face, shared)
        };
        let found = each(
            self.worth,
            runs.chunks(TASK).collect(),
            |block: &[&[Segment]]| {
                block
                    .iter()
                    .map(|run| arranged(run))
                    .collect::<Result<Vec<_>, Special>>()
            },
        );
        Ok(found
            .into_iter()
            .collect::<Result<Vec<_>, Special>>()?
            .into_iter()
            .flatten()
            .collect())
    }

    /// What stays of an operand: whole faces, and parts of those that are crossed.
    fn left(
        &self,
        operand: usize,
        crossed: &[Segment],
        shared: &Shared,
    ) -> Result<(Vec<Group>, Vec<PartElement>), Special> {
        let count = self.operands[operand].mesh.faces.len();
        let mut fates = vec![Fate::from(self.kept.at(operand, 0)?); count];
        let mut parts = Vec::new();
        if self.kept.is_divided(operand) {
            let cut = self.arrangements(operand, crossed, shared)?;
            let mut labels = self.labels(operand, &cut)?;
            self.decide(operand, &cut, &mut labels, &mut fates)?;
            parts = self.parts(operand, &cut, &mut labels, shared)?;
        }
        Ok((self.groups(operand, &fates), parts))
    }

    /// Decides the faces of an operand where the other one is.
    fn decide(
        &self,
        operand: usize,
        cut: &[Arrangement],
        labels: &mut Labels,
        fates: &mut [Fate],
    ) -> Result<(), Special> {
        let mesh = self.operands[operand].mesh;
        for id in &self.within[operand].faces {
            poll();
            let number = labels.at(mesh.vertices_of(*id)[0]);
            fates[id.place()] = self.kept.at(operand, number)?.into();
        }
        for arrangement in cut {
            fates[arrangement.face().id.place()] = Fate::Cut;
        }
        Ok(())
    }

    /// The faces of an operand that stay whole.
    fn groups(&self, operand: usize, fates: &[Fate]) -> Vec<Group> {
        let Operand { mesh, source, .. } = self.operands[operand];
        let group = |orientation| Group {
            touching: false,
            source: Arc::clone(source),
            orientation,
            faces: mesh
                .face_ids()
                .filter(|id| fates[id.place()] == Fate::Whole(orientation))
                .collect(),
        };
        let groups = Orientation::BOTH.map(group).into_iter();
        groups.filter(|g| !g.faces.is_empty()).collect()
    }

    /// The other operand's winding numbers around an operand's vertices.
    fn labels(&self, operand: usize, cut: &[Arrangement]) -> Result<Labels<'_>, Special> {
        let mesh = self.operands[operand].mesh;
        let mut labels = Labels::new(self.operands[operand], self.operands[1 - operand]);
        let mut is_cut = vec![false; mesh.faces.len()];
        for arrangement in cut {
            is_cut[arrangement.face().id.place()] = true;
            let [a, b, c] = arrangement.face().vertices;
            let [at_a, at_b, at_c] = arrangement.at_corners();
            labels.join(b, a, at_b - at_a)?;
            labels.join(c, a, at_c - at_a)?;
        }
        for id in self.within[operand]
            .faces
            .iter()
            .filter(|id| !is_cut[id.place()])
        {
            poll();
            labels.join_corners(mesh.vertices_of(*id))?;
        }
        labels.note_beyond();
        Ok(labels)
    }

    /// The parts that stay of an operand's faces that are cut, in the order of a leaf.
    fn parts(
        &self,
        operand: usize,
        cut: &[Arrangement],
        labels: &mut Labels,
        shared: &Shared,
    ) -> Result<Vec<PartElement>, Special> {
        let number = |a: &Arrangement, labels: &mut Labels| {
            labels.at(a.face().vertices[0]) - a.at_corners()[0]
        };
        let mut first: Vec<(&Arrangement, i32)> =
            cut.iter().map(|a| (a, number(a, labels))).collect();
        first.sort_unstable_by_key(|(a, _)| a.face().id);
        let found = each(
            self.worth,
            first.chunks(TASK).collect(),
            |block: &[(&Arrangement, i32)]| {
                let parts = block
                    .iter()
                    .map(|(a, number)| self.parts_of(operand, a, *number, shared));
                parts.collect::<Result<Vec<_>, Special>>()
            },
        );
        let found: Vec<_> = found.into_iter().collect::<Result<_, _>>()?;
        let parts = [0, 1].map(|turned| {
            found
                .iter()
                .flatten()
                .filter_map(move |f| f[turned].clone())
        });
        Ok(parts.into_iter().flatten().collect())
    }

    /// What stays of a face as it is, and what stays turned around, given the number in its first cell.
    fn parts_of(
        &self,
        operand: usize,
        arrangement: &Arrangement,
        first: i32,
        shared: &Shared,
    ) -> Result<[Option<PartElement>; 2], Special> {
        for number in arrangement.numbers() {
            self.kept.at(operand, first + number)?;
        }
        let part = |orientation: Orientation| {
            let holds =
                |number: i32| self.kept.at(operand, first + number) == Ok(Some(orientation));
            let edges = arrangement.outline(holds, &shared.planes[1 - operand]);
            (!edges.is_empty()).then(|| {
                let source = Arc::clone(self.operands[operand].source);
                let part = Part::new(source, arrangement.face().id, self.cell, edges);
                let part = Arc::new(part);
                PartElement { part, orientation }
            })
        };
        Ok(Orientation::BOTH.map(part))
    }
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
    fn touching_and_overlapping_meshes_are_left_to_others() {
        let first = cuboid([0; 3], [4; 3]);
        let touching = [first.clone(), cuboid([4, 1, 1], [8, 3, 3])];
        assert_eq!(counts(&touching, Term::Or), None);
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
