//! Finds the winding numbers of one operand in front of the faces of another, or of its own faces.
//!
//! The winding number is the same at all corners of an undivided face, and for divided faces the differences
//! are known. So one counted number determines the numbers at all connected vertices.

use std::cmp::Ordering;

use rustc_hash::FxHashMap as HashMap;
use smallvec::SmallVec;

use super::candidates::Operand;
use super::faces::{count_in_face, Arrangement};
use super::windings::Windings;
use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::Triangle;
use crate::interrupt::poll;
use crate::merge::division::Probe;
use crate::merge::profile::Declined;
use crate::mesh::handle::{FaceId, VertexId};

/// The known winding numbers of one operand at the vertices of a mesh. Vertices are in one class (disjoint
/// set) if the differences between their winding numbers are known.
#[derive(Debug)]
pub(super) struct Labels<'a> {
    of: Operand<'a>,
    /// The index of the operand whose winding numbers are stored.
    around: usize,
    windings: Windings<'a>,
    parents: Vec<u32>,
    /// For each vertex, the winding number at the vertex minus the number at its parent in the disjoint-set
    /// forest.
    above: Vec<i32>,
    /// For each vertex that is the root of a class, the winding number at it, if known.
    known: Vec<Option<i32>>,
    /// For each vertex, whether it lies on another face; empty if none does.
    touching: &'a [bool],
}

impl<'a> Labels<'a> {
    /// Makes labels without a known number, for winding numbers of `operand`, whose index is `around`, at the
    /// vertices of the mesh `of`; `touching` says which of these lie on other faces of `operand`.
    pub(super) fn new(
        of: Operand<'a>,
        (around, operand): (usize, Operand<'a>),
        touching: &'a [bool],
    ) -> Self {
        let vertices = of.mesh.vertices.len();
        Self {
            of,
            around,
            windings: Windings::of(operand),
            parents: (0..as_number(vertices)).collect(),
            above: vec![0; vertices],
            known: vec![None; vertices],
            touching,
        }
    }

    /// Returns the index of the operand whose winding numbers are stored.
    pub(super) fn around(&self) -> usize {
        self.around
    }

    /// Returns the root of a vertex's class, and the winding number at the vertex minus the number at the
    /// root.
    fn root(&mut self, vertex: VertexId) -> (usize, i32) {
        let (mut at, mut sum) = (vertex.index(), 0);
        loop {
            let parent = self.parents[at] as usize;
            if parent == at {
                return (at, sum);
            }
            // Path halving: every second vertex gets its grandparent as parent. At a root `above` is zero.
            self.above[at] += self.above[parent];
            self.parents[at] = self.parents[parent];
            sum += self.above[at];
            at = self.parents[at] as usize;
        }
    }

    /// Records that the winding number at vertex `a` minus the number at vertex `b` is `more`.
    ///
    /// # Errors
    /// `Overlap` on a contradiction: the operand whose winding numbers are stored overlaps itself.
    pub(super) fn join(&mut self, a: VertexId, b: VertexId, more: i32) -> Result<(), Declined> {
        let (of_a, of_b) = (self.root(a), self.root(b));
        self.join_roots(of_a, of_b, more).map(|_| ())
    }

    /// Records that the winding number is equal at all corners of a face that do not lie on other faces.
    ///
    /// # Errors
    /// As for [`Self::join`].
    pub(super) fn join_corners(&mut self, corners: [VertexId; 3]) -> Result<(), Declined> {
        if corners.iter().any(|v| self.is_touching(*v)) {
            let free: SmallVec<[VertexId; 3]> = corners
                .into_iter()
                .filter(|v| !self.is_touching(*v))
                .collect();
            return free
                .windows(2)
                .try_for_each(|pair| self.join(pair[0], pair[1], 0));
        }
        let [a, b, c] = corners.map(|v| self.root(v));
        let joined = self.join_roots(a, b, 0)?;
        // The old root of c may be the root that just got a parent.
        let c = if c.0 == a.0 || c.0 == b.0 {
            self.root(corners[2])
        } else {
            c
        };
        self.join_roots(joined, c, 0).map(|_| ())
    }

    /// Returns true if a vertex lies on another face, where the winding number is undefined.
    pub(super) fn is_touching(&self, vertex: VertexId) -> bool {
        self.touching.get(vertex.index()).is_some_and(|t| *t)
    }

    /// Records the differences between the winding numbers at the corners of a divided face.
    ///
    /// # Errors
    /// As for [`Self::join`].
    pub(super) fn join_cells(&mut self, face: &Arrangement) -> Result<(), Declined> {
        let corners = [0, 1, 2].map(|i| (face.face.vertices[i], face.at_corner(self.around, i)));
        let free = corners.into_iter().filter(|(v, _)| !self.is_touching(*v));
        let free: SmallVec<[_; 3]> = free.collect();
        free.windows(2)
            .try_for_each(|pair| self.join(pair[1].0, pair[0].0, pair[1].1 - pair[0].1))
    }

    /// Returns the winding number in front of the first cell of a divided face.
    ///
    /// # Errors
    /// `Thin` if all corners lie on other faces, and all cells are too thin to count the number at a point
    /// inside.
    pub(super) fn number_in_front(&mut self, face: &mut Arrangement) -> Result<i32, Declined> {
        let mut corners = (0..).zip(face.face.vertices);
        match corners.find(|(_, v)| !self.is_touching(*v)) {
            Some((i, vertex)) => Ok(self.number_at(vertex) - face.at_corner(self.around, i)),
            None => self.count_in_front(face),
        }
    }

    /// Returns the winding number in front of the first cell of a divided face, counted along a ray.
    fn count_in_front(&mut self, face: &mut Arrangement) -> Result<i32, Declined> {
        let plane = face.face.plane;
        let count = |probe: &Probe| self.windings.winding_number_in_front(plane, probe);
        let (cell, number) = face.count_in_cell(count).ok_or(Declined::Thin)?;
        Ok(number - face.in_front(self.around, cell))
    }

    /// Returns the winding number at the corners of an undivided face; `None` if all corners lie on other
    /// faces.
    pub(super) fn number_at_corners(&mut self, corners: [VertexId; 3]) -> Option<i32> {
        let free = corners.into_iter().find(|v| !self.is_touching(*v));
        free.map(|vertex| self.number_at(vertex))
    }

    /// Joins the classes of two vertices, each given by the root of its class and its winding number minus
    /// the root's; `more` is the first vertex's number minus the second's. Returns the new root, and the
    /// first vertex's number minus this root's.
    fn join_roots(
        &mut self,
        (a, above_a): (usize, i32),
        (b, above_b): (usize, i32),
        more: i32,
    ) -> Result<(usize, i32), Declined> {
        // The number at the root of a minus the number at the root of b.
        let between = above_b + more - above_a;
        match a.cmp(&b) {
            Ordering::Equal if between != 0 => Err(Declined::Overlap(self.around)),
            Ordering::Equal => Ok((a, above_a)),
            Ordering::Greater => {
                self.parents[a] = as_number(b);
                self.above[a] = between;
                Ok((b, above_b + more))
            }
            Ordering::Less => {
                self.parents[b] = as_number(a);
                self.above[b] = -between;
                Ok((a, above_a))
            }
        }
    }

    /// Records that the winding number is zero at vertices outside the other operand's box.
    pub(super) fn record_zero_outside(&mut self) {
        for (vertex, point) in VertexId::all().zip(&self.of.mesh.vertices) {
            poll();
            if self.windings.is_outside_bounds(point) && !self.is_touching(vertex) {
                let (root, above) = self.root(vertex);
                self.known[root].get_or_insert(-above);
            }
        }
    }

    /// Returns the winding number at a vertex; counts it if the number of no vertex of its class is known.
    pub(super) fn number_at(&mut self, vertex: VertexId) -> i32 {
        let (root, above) = self.root(vertex);
        if let Some(known) = self.known[root] {
            return known + above;
        }
        let number = self
            .windings
            .winding_number_at(&self.of.mesh.vertices[vertex.index()]);
        self.known[root] = Some(number - above);
        number
    }

    /// Counts the winding number in front of the widest face of each class of vertices.
    ///
    /// # Errors
    /// `Thin` if the widest face of a class is too thin for this.
    pub(super) fn count_at_widest_faces<'b>(
        &mut self,
        arranged: &mut [Arrangement],
        others: impl Iterator<Item = &'b FaceId>,
    ) -> Result<(), Declined> {
        let mut widest: HashMap<usize, (f64, WidestFace)> = HashMap::default();
        let divided = arranged.iter().map(|a| a.face.vertices);
        let divided = divided
            .enumerate()
            .map(|(i, v)| (WidestFace::Divided(i), v));
        let mesh = self.of.mesh;
        let whole = others.map(|id| (WidestFace::Whole(*id), mesh.vertices_of(*id)));
        for (face, corners) in whole.chain(divided) {
            poll();
            if let Some(free) = corners.into_iter().find(|v| !self.is_touching(*v)) {
                let width = width(&corners.map(|v| mesh.vertices[v.index()].map(as_double)));
                let (root, _) = self.root(free);
                let known = widest.entry(root).or_insert((width, face));
                if width > known.0 {
                    *known = (width, face);
                }
            }
        }
        for (root, (_, face)) in widest {
            let (corner, number) = match face {
                WidestFace::Whole(id) => (mesh.vertices_of(id), self.number_in_front_of_whole(id)?),
                WidestFace::Divided(i) => (
                    arranged[i].face.vertices,
                    self.count_in_front(&mut arranged[i])?,
                ),
            };
            let free = (0..3).find(|i| !self.is_touching(corner[*i])).unwrap_or(0);
            let more = match face {
                WidestFace::Whole(_) => 0,
                WidestFace::Divided(i) => arranged[i].at_corner(self.around, free),
            };
            let (_, above) = self.root(corner[free]);
            self.known[root] = Some(number + more - above);
        }
        Ok(())
    }

    /// Returns the winding number in front of an undivided face, counted along a ray.
    fn number_in_front_of_whole(&mut self, face: FaceId) -> Result<i32, Declined> {
        let plane = self.of.source.plane(face);
        let count = |probe: &Probe| self.windings.winding_number_in_front(&plane, probe);
        count_in_face(&self.of.mesh.corners(face), &plane, count).ok_or(Declined::Thin)
    }
}

/// The widest face of a class of vertices: an undivided face, or the index of a divided one.
#[derive(Clone, Copy)]
enum WidestFace {
    Whole(FaceId),
    Divided(usize),
}

/// Returns about four times the square of a triangle's area.
fn width([a, b, c]: &Triangle) -> f64 {
    let (u, v) = (each_axis(|i| b[i] - a[i]), each_axis(|i| c[i] - a[i]));
    let minor = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
    [minor(0, 1), minor(1, 2), minor(2, 0)]
        .map(|m| m * m)
        .iter()
        .sum()
}
