//! Exact vertex identity: one number for each point, whatever it was made from.

use std::cmp::Ordering;
use std::hash::BuildHasher;
use std::sync::Arc;

use rustc_hash::{FxBuildHasher, FxHashMap as HashMap};

use super::angles;
use super::triangulate::Planar;
use crate::arith::convert::{as_double, as_number, as_whole};
use crate::arith::{Filtered, Int, Sign};
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::vertex::{Vertex, NEAR};

/// Numbered points; equal points have equal numbers.
#[derive(Debug, Default)]
pub struct VertexTable {
    points: Vec<Arc<Vertex>>,
    /// The points in doubles, each coordinate within three units in the last place.
    places: Vec<[f64; 3]>,
    /// By fingerprint the last point that has it.
    last: HashMap<u64, u32>,
    /// For each point the one before it that has the same fingerprint, or [`NONE`].
    previous: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl VertexTable {
    /// The number of a point, found by its place in doubles and confirmed exactly.
    pub fn number(&mut self, vertex: &Arc<Vertex>) -> u32 {
        let place = vertex.approx();
        self.find_at(vertex, &place).unwrap_or_else(|| {
            let lattice = lattice_place(vertex, &place);
            let lattice = lattice.map(|p| Arc::new(Vertex::lattice(p)));
            self.add(lattice.unwrap_or_else(|| Arc::clone(vertex)))
        })
    }

    /// The number of a lattice point.
    pub fn number_at(&mut self, place: Lattice) -> u32 {
        let vertex = Vertex::lattice(place);
        let place = vertex.approx();
        let known = self.find_at(&vertex, &place);
        known.unwrap_or_else(|| self.add(Arc::new(vertex)))
    }

    /// The number of a point that is in the table.
    pub fn find(&self, vertex: &Vertex) -> Option<u32> {
        self.find_at(vertex, &vertex.approx())
    }

    fn find_at(&self, vertex: &Vertex, place: &[f64; 3]) -> Option<u32> {
        let [low, high] = [Blur::lowest(place), Blur::highest(place)];
        if low == high {
            return self.among(low.fingerprint(), vertex);
        }
        let corner = |i: usize| Blur::mixed(&low, &high, i);
        (0..8).find_map(|i| self.among(corner(i).fingerprint(), vertex))
    }

    fn add(&mut self, vertex: Arc<Vertex>) -> u32 {
        let place = vertex.approx();
        let next = as_number(self.points.len());
        let before = self.last.insert(Blur::of(&place).fingerprint(), next);
        self.previous.push(before.unwrap_or(NONE));
        self.points.push(vertex);
        self.places.push(place);
        next
    }

    /// The point that is this vertex, among those with one fingerprint.
    fn among(&self, fingerprint: u64, vertex: &Vertex) -> Option<u32> {
        let before = |id: &u32| Some(self.previous[*id as usize]).filter(|p| *p != NONE);
        let last = self.last.get(&fingerprint).copied();
        std::iter::successors(last, before).find(|id| self.point(*id).same(vertex))
    }

    /// The point with this number.
    pub fn point(&self, id: u32) -> &Arc<Vertex> {
        &self.points[id as usize]
    }

    /// The point with this number in doubles.
    fn place(&self, id: u32) -> &[f64; 3] {
        &self.places[id as usize]
    }

    /// Return whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Return the number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }
}

/// The lattice point that a constructed one is, if it is: questions about these are cheap.
fn lattice_place(vertex: &Vertex, place: &[f64; 3]) -> Option<Lattice> {
    if vertex.as_lattice().is_some() {
        return None;
    }
    let nearest = place.map(|c| as_whole(c.round()));
    let near = |i: usize| (place[i] - as_double(nearest[i])).abs() <= place[i].abs() * NEAR;
    ((0..3).all(near) && vertex.is_at(&nearest)).then_some(nearest)
}

/// A place in doubles with all but some forty leading bits rounded away.
///
/// The digits of a double above zero are ordered as it is, so that two doubles of one coordinate
/// differ by less than [`Blur::DOUBT`] in them; nearly always they round alike.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Blur([u64; 3]);

impl Blur {
    /// The number of bits that are rounded away.
    const BITS: u32 = 12;

    /// Six units in the last place, twice that beside a power of two; the next power of two.
    const DOUBT: u64 = 16;

    const HALF: u64 = 1 << (Self::BITS - 1);

    fn of(place: &[f64; 3]) -> Self {
        Self(place.map(|c| (digits(c) + Self::HALF) >> Self::BITS))
    }

    /// Those of the smallest doubles in magnitude that may stand for the same point.
    fn lowest(place: &[f64; 3]) -> Self {
        Self(place.map(|c| (digits(c) + Self::HALF - Self::DOUBT) >> Self::BITS))
    }

    /// Those of the largest such doubles.
    fn highest(place: &[f64; 3]) -> Self {
        Self(place.map(|c| (digits(c) + Self::HALF + Self::DOUBT) >> Self::BITS))
    }

    /// Each coordinate from one of two, as the bits of a number tell.
    fn mixed(low: &Self, high: &Self, bits: usize) -> Self {
        let pick = |i: usize| {
            if bits >> i & 1 == 0 {
                low.0[i]
            } else {
                high.0[i]
            }
        };
        Self([0, 1, 2].map(pick))
    }

    fn fingerprint(&self) -> u64 {
        FxBuildHasher.hash_one(self)
    }
}

/// The bits of a finite double, zero without a sign.
fn digits(c: f64) -> u64 {
    (c + 0.0).to_bits()
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
        [as_double(p[self.u]), as_double(p[self.v])]
    }

    /// Return whether a point lies strictly between two others, on their line.
    pub fn is_between(&self, a: u32, point: u32, b: u32) -> bool {
        point != a
            && point != b
            && self.orient(a, point, b) == Sign::Zero
            && self.compare(a, point) == self.compare(point, b)
    }
}

impl Projection<'_> {
    /// Return whether two segments cross inside both.
    pub fn crosses(&self, a: [u32; 2], b: [u32; 2]) -> bool {
        a.iter().all(|p| !b.contains(p))
            && self.orient(a[0], a[1], b[0]) * self.orient(a[0], a[1], b[1]) == Sign::Negative
            && self.orient(b[0], b[1], a[0]) * self.orient(b[0], b[1], a[1]) == Sign::Negative
    }
}

impl Planar for Projection<'_> {
    fn compare(&self, a: u32, b: u32) -> Ordering {
        if a == b {
            return Ordering::Equal;
        }
        let by = |axis| self.compare_by(a, b, axis);
        by(self.u).then_with(|| by(self.v))
    }

    fn orient(&self, a: u32, b: u32, c: u32) -> Sign {
        self.rough_orient([a, b, c])
            .or_exact(|| self.exact_orient([a, b, c]))
    }

    fn opposite_angles(&self, [a, b]: [u32; 2], [c, d]: [u32; 2]) -> Ordering {
        let quad = [a, b, c, d];
        angles::rough(quad.map(|p| self.approx(p))).or_exact(|| {
            let points = quad.map(|p| &**self.table.point(p));
            angles::exact(points, [self.u, self.v])
        })
    }

    fn approx(&self, a: u32) -> [f64; 2] {
        let p = self.table.place(a);
        [p[self.u], p[self.v]]
    }
}

impl Projection<'_> {
    fn compare_by(&self, a: u32, b: u32, axis: usize) -> Ordering {
        let (p, q) = (self.table.place(a)[axis], self.table.place(b)[axis]);
        if (p - q).abs() > (p.abs() + q.abs()) * NEAR {
            return p.total_cmp(&q);
        }
        self.table.point(a).compare(self.table.point(b), axis)
    }

    /// The sign of a turn where doubles decide it: coordinates are within three units in the last
    /// place.
    fn rough_orient(&self, points: [u32; 3]) -> Filtered<Sign> {
        let [a, b, c] = points.map(|p| self.approx(p));
        let (bu, bv) = (b[0] - a[0], b[1] - a[1]);
        let (cu, cv) = (c[0] - a[0], c[1] - a[1]);
        let larger = |p: [f64; 2]| p[0].abs().max(p[1].abs());
        let doubt = NEAR * larger(a).max(larger(b)).max(larger(c));
        let size = bu.abs() + bv.abs() + cu.abs() + cv.abs();
        let bound = 2.0 * doubt * (size + 2.0 * doubt)
            + 4.0 * f64::EPSILON * (bu * cv).abs().max((bv * cu).abs());
        let cross = bu * cv - bv * cu;
        Filtered::when(cross.abs() > bound, Sign::of(cross))
    }

    /// Sign of the turn a → b → c in the view.
    fn exact_orient(&self, points: [u32; 3]) -> Sign {
        let points = points.map(|id| &**self.table.point(id));
        if let [Some(a), Some(b), Some(c)] = points.map(Vertex::as_lattice) {
            let d = |p: &[i64; 3], q: &[i64; 3], i: usize| i128::from(q[i] - p[i]);
            let cross = d(a, b, self.u) * d(a, c, self.v) - d(a, b, self.v) * d(a, c, self.u);
            return Sign::of(cross);
        }
        wide_orient(&points, self.u, self.v)
    }
}

fn wide_orient(points: &[&Vertex; 3], u: usize, v: usize) -> Sign {
    let [a, b, c] = points.map(Vertex::coordinates);
    let minor = |p: &Int<6>, q: &Int<6>, r: &Int<6>, s: &Int<6>| -> Int<12> {
        let left: Int<12> = p.mul(q);
        let right: Int<12> = r.mul(s);
        left - right
    };
    let by_x: Int<18> = minor(&b.x[v], &c.w, &c.x[v], &b.w).mul(&a.x[u]);
    let by_y: Int<18> = minor(&b.x[u], &c.w, &c.x[u], &b.w).mul(&a.x[v]);
    let by_w: Int<18> = minor(&b.x[u], &c.x[v], &c.x[u], &b.x[v]).mul(&a.w);
    (by_x - by_y + by_w).sign()
}

/// The signs of the coordinate differences b − a.
pub fn direction(a: &Vertex, b: &Vertex) -> [Sign; 3] {
    [0, 1, 2].map(|axis| Sign::from_order(b.compare(a, axis)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_has_one_number_however_it_is_made() {
        let mut table = VertexTable::default();
        let wall = |axis: usize, at: i64| Arc::new(Plane::axis_cut(axis, at));
        // Where three planes meet, and the same as a lattice point.
        let met = Vertex::meet(&wall(0, 6), &wall(1, 4), &wall(2, 2)).expect("a corner");
        let first = table.number(&Arc::new(met));
        assert_eq!(table.number_at([3, 2, 1]), first);
        assert_ne!(table.number_at([3, 2, 2]), first);
        assert_eq!(
            (table.len(), table.find(&Vertex::lattice([0; 3]))),
            (2, None)
        );
    }

    #[test]
    fn between_and_across_are_exact_in_the_view_from_above() {
        let mut table = VertexTable::default();
        let [a, b, c, d] = [[0, 0, 0], [9, 9, 0], [3, 3, 0], [9, 0, 0]].map(|p| table.number_at(p));
        let e = table.number_at([0, 9, 0]);
        let floor = Plane::through(&[0, 0, 0], &[1, 0, 0], &[0, 1, 0]).expect("a plane");
        let view = Projection::onto(&floor, &table);
        assert!(view.is_between(a, c, b) && !view.is_between(a, d, b));
        assert!(view.crosses([a, b], [d, e]) && !view.crosses([a, c], [d, e]));
    }
}
