//! Exact vertex identity: one number for each point, whatever it was made from.

use std::cmp::Ordering;
use std::collections::hash_map::Entry;
use std::hash::BuildHasher;
use std::sync::Arc;

use rustc_hash::{FxBuildHasher, FxHashMap as HashMap};

use super::triangulate::Planar;
use crate::arith::Int;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::vertex::Vertex;

/// Numbered points; equal points have equal numbers.
#[derive(Debug, Default)]
pub struct VertexTable {
    points: Vec<Arc<Vertex>>,
    /// By fingerprint the last point that has it.
    last: HashMap<u64, u32>,
    /// For each point the one before it that has the same fingerprint, or [`NONE`].
    previous: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl VertexTable {
    /// The number of a point, found by fingerprint and confirmed exactly.
    pub fn number(&mut self, vertex: &Arc<Vertex>) -> u32 {
        self.enter(vertex, || Arc::clone(vertex))
    }

    /// The number of a lattice point.
    pub fn number_at(&mut self, place: Lattice) -> u32 {
        self.enter(&Vertex::lattice(place), || Arc::new(Vertex::lattice(place)))
    }

    fn enter(&mut self, vertex: &Vertex, shared: impl FnOnce() -> Arc<Vertex>) -> u32 {
        let next = self.points.len() as u32;
        let (previous, points) = (&self.previous, &self.points);
        match self.last.entry(fingerprint(vertex)) {
            Entry::Vacant(entry) => {
                entry.insert(next);
                self.previous.push(NONE);
            }
            Entry::Occupied(mut entry) => {
                let known = among(points, previous, *entry.get(), vertex);
                if let Some(id) = known {
                    return id;
                }
                self.previous.push(entry.insert(next));
            }
        }
        let place = lattice_place(vertex);
        let point = place.map_or_else(shared, |p| Arc::new(Vertex::lattice(p)));
        self.points.push(point);
        next
    }

    /// The number of a point that is in the table.
    pub fn find(&self, vertex: &Vertex) -> Option<u32> {
        let last = self.last.get(&fingerprint(vertex))?;
        among(&self.points, &self.previous, *last, vertex)
    }

    /// The point with this number.
    pub fn point(&self, id: u32) -> &Arc<Vertex> {
        &self.points[id as usize]
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// How many points there are.
    pub fn len(&self) -> usize {
        self.points.len()
    }
}

/// The lattice point that a constructed one is, if it is: questions about these are cheap.
fn lattice_place(vertex: &Vertex) -> Option<Lattice> {
    if vertex.as_lattice().is_some() {
        return None;
    }
    let place = vertex.approx().map(|c| c.round() as i64);
    (vertex.may_be(&place) && vertex.same(&Vertex::lattice(place))).then_some(place)
}

/// A fingerprint that equal points share; unequal points differ but for chance 2^-64.
fn fingerprint(vertex: &Vertex) -> u64 {
    FxBuildHasher.hash_one(vertex.key())
}

/// The point that is this vertex, among those with one fingerprint.
fn among(points: &[Arc<Vertex>], previous: &[u32], last: u32, vertex: &Vertex) -> Option<u32> {
    let before = |id: &u32| Some(previous[*id as usize]).filter(|p| *p != NONE);
    std::iter::successors(Some(last), before).find(|id| points[*id as usize].same(vertex))
}

/// The table's points as seen along the main axis of a plane's normal, from its plus side.
#[derive(Debug)]
pub struct Projection<'a> {
    table: &'a VertexTable,
    u: usize,
    v: usize,
}

impl<'a> Projection<'a> {
    /// The view onto a plane.
    pub fn onto(plane: &Plane, table: &'a VertexTable) -> Self {
        let axis = plane.main_axis();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = if plane.normal()[axis] < 0 {
            (v, u)
        } else {
            (u, v)
        };
        Self { table, u, v }
    }
}

impl Projection<'_> {
    /// A lattice point in the view.
    pub fn flat(&self, p: &Lattice) -> [f64; 2] {
        [p[self.u] as f64, p[self.v] as f64]
    }

    /// Whether a point lies strictly between two others, on their line.
    pub fn is_between(&self, a: u32, point: u32, b: u32) -> bool {
        point != a
            && point != b
            && self.orient(a, point, b) == 0
            && self.compare(a, point) == self.compare(point, b)
    }
}

impl Projection<'_> {
    /// Whether two segments cross inside both.
    pub fn crosses(&self, a: [u32; 2], b: [u32; 2]) -> bool {
        a.iter().all(|p| !b.contains(p))
            && self.orient(a[0], a[1], b[0]) * self.orient(a[0], a[1], b[1]) < 0
            && self.orient(b[0], b[1], a[0]) * self.orient(b[0], b[1], a[1]) < 0
    }
}

impl Planar for Projection<'_> {
    fn compare(&self, a: u32, b: u32) -> Ordering {
        if a == b {
            return Ordering::Equal;
        }
        let (p, q) = (self.table.point(a), self.table.point(b));
        p.compare(q, self.u).then_with(|| p.compare(q, self.v))
    }

    fn orient(&self, a: u32, b: u32, c: u32) -> i32 {
        let points = [a, b, c].map(|id| &**self.table.point(id));
        orient(points, self.u, self.v)
    }

    fn approx(&self, a: u32) -> [f64; 2] {
        let p = self.table.point(a).approx();
        [p[self.u], p[self.v]]
    }
}

/// Sign of the turn a → b → c in the (u, v) projection: +1 left, 0 straight, -1 right.
fn orient(points: [&Vertex; 3], u: usize, v: usize) -> i32 {
    if let [Some(a), Some(b), Some(c)] = points.map(Vertex::as_lattice) {
        let d = |p: &[i64; 3], q: &[i64; 3], i: usize| i128::from(q[i] - p[i]);
        let cross = d(a, b, u) * d(a, c, v) - d(a, b, v) * d(a, c, u);
        return cross.signum() as i32;
    }
    rough_orient(&points, u, v).unwrap_or_else(|| exact_orient(&points, u, v))
}

/// The sign where doubles decide it: coordinates are within two units in the last place.
fn rough_orient(points: &[&Vertex; 3], u: usize, v: usize) -> Option<i32> {
    let [a, b, c] = points.map(Vertex::approx);
    let (bu, bv) = (b[u] - a[u], b[v] - a[v]);
    let (cu, cv) = (c[u] - a[u], c[v] - a[v]);
    let largest = [a, b, c]
        .iter()
        .map(|p| p[u].abs().max(p[v].abs()))
        .fold(0.0, f64::max);
    let doubt = 8.0 * f64::EPSILON * largest;
    let size = bu.abs() + bv.abs() + cu.abs() + cv.abs();
    let bound = 2.0 * doubt * (size + 2.0 * doubt)
        + 4.0 * f64::EPSILON * (bu * cv).abs().max((bv * cu).abs());
    let cross = bu * cv - bv * cu;
    (cross.abs() > bound).then_some(if cross > 0.0 { 1 } else { -1 })
}

fn exact_orient(points: &[&Vertex; 3], u: usize, v: usize) -> i32 {
    let [a, b, c] = points.map(Vertex::coordinates);
    let minor = |p: &Int<6>, q: &Int<6>, r: &Int<6>, s: &Int<6>| -> Int<12> {
        let left: Int<12> = p.mul(q);
        let right: Int<12> = r.mul(s);
        left - right
    };
    let by_x: Int<18> = minor(&b.x[v], &c.w, &c.x[v], &b.w).mul(&a.x[u]);
    let by_y: Int<18> = minor(&b.x[u], &c.w, &c.x[u], &b.w).mul(&a.x[v]);
    let by_w: Int<18> = minor(&b.x[u], &c.x[v], &c.x[u], &b.x[v]).mul(&a.w);
    (by_x - by_y + by_w).signum()
}

/// The signs of the coordinate differences b − a.
pub fn direction(a: &Vertex, b: &Vertex) -> [i32; 3] {
    [0, 1, 2].map(|axis| b.compare(a, axis) as i32)
}
