//! Exact vertex identity: each point has one number, however it is constructed.

use std::hash::BuildHasher;
use std::sync::Arc;

use rustc_hash::{FxBuildHasher, FxHashMap as HashMap};

use crate::arith::convert::{as_double, as_number, as_whole};
use crate::geometry::doubles::folded;
use crate::geometry::plane::Lattice;
use crate::geometry::vertex::{Vertex, MAX_COORDINATE_ERROR};

/// A table of exact points that numbers them from 0; equal points have equal numbers.
#[derive(Debug, Default)]
pub struct VertexTable {
    points: Vec<Arc<Vertex>>,
    /// The points in doubles, each coordinate within three units in the last place.
    positions: Vec<[f64; 3]>,
    /// The number of the last point with each fingerprint of a [`RoundedPoint`].
    last: HashMap<u64, u32>,
    /// For each point, the number of the previous point with the same fingerprint, or [`NONE`].
    previous: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl VertexTable {
    /// The number of a point, added if it is new: found by its rounded doubles and confirmed exactly.
    pub fn number_of(&mut self, vertex: &Arc<Vertex>) -> u32 {
        let position = vertex.approx();
        self.find_at(vertex, &position).unwrap_or_else(|| {
            let lattice = nearest_lattice_point(vertex, &position);
            let lattice = lattice.map(|p| Arc::new(Vertex::lattice(p)));
            self.add(lattice.unwrap_or_else(|| Arc::clone(vertex)))
        })
    }

    /// The number of a lattice point, which is added if it is new.
    pub fn number_at(&mut self, position: Lattice) -> u32 {
        let vertex = Vertex::lattice(position);
        let position = vertex.approx();
        let known = self.find_at(&vertex, &position);
        known.unwrap_or_else(|| self.add(Arc::new(vertex)))
    }

    /// The number of a point, or `None` if it is not in the table.
    pub fn find(&self, vertex: &Vertex) -> Option<u32> {
        self.find_at(vertex, &vertex.approx())
    }

    fn find_at(&self, vertex: &Vertex, position: &[f64; 3]) -> Option<u32> {
        let [low, high] = [
            RoundedPoint::lower_end(position),
            RoundedPoint::upper_end(position),
        ];
        if low == high {
            return self.find_among(low.fingerprint(), vertex);
        }
        let corner = |i: usize| RoundedPoint::combined(&low, &high, i);
        (0..8).find_map(|i| self.find_among(corner(i).fingerprint(), vertex))
    }

    fn add(&mut self, vertex: Arc<Vertex>) -> u32 {
        let position = vertex.approx();
        let next = as_number(self.points.len());
        let before = self
            .last
            .insert(RoundedPoint::of(&position).fingerprint(), next);
        self.previous.push(before.unwrap_or(NONE));
        self.points.push(vertex);
        self.positions.push(position);
        next
    }

    /// The number of the point that equals a vertex, among the points with one fingerprint; `None` if none
    /// does.
    fn find_among(&self, fingerprint: u64, vertex: &Vertex) -> Option<u32> {
        let before = |id: &u32| Some(self.previous[*id as usize]).filter(|p| *p != NONE);
        let last = self.last.get(&fingerprint).copied();
        std::iter::successors(last, before).find(|id| self.point(*id).equals(vertex))
    }

    /// The exact point with this number.
    pub fn point(&self, id: u32) -> &Arc<Vertex> {
        &self.points[id as usize]
    }

    /// The coordinates of the point with this number, in doubles.
    pub fn position(&self, id: u32) -> &[f64; 3] {
        &self.positions[id as usize]
    }

    /// Return whether the table has no points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Return the number of points in the table.
    pub fn len(&self) -> usize {
        self.points.len()
    }
}

/// The lattice point that a constructed vertex equals; `None` if it equals none or is stored as a lattice
/// point.
fn nearest_lattice_point(vertex: &Vertex, position: &[f64; 3]) -> Option<Lattice> {
    if vertex.as_lattice().is_some() {
        return None;
    }
    let nearest = position.map(|c| as_whole(c.round()));
    let near = |i: usize| {
        (position[i] - as_double(nearest[i])).abs() <= position[i].abs() * MAX_COORDINATE_ERROR
    };
    ((0..3).all(near) && vertex.is_at(&nearest)).then_some(nearest)
}

/// A point in doubles, each coordinate rounded to about forty leading bits.
///
/// The bits of positive doubles have the order of their values. So the bits of two doubles that approximate
/// one coordinate differ by less than [`RoundedPoint::DOUBT`], and nearly always round to the same ones.
#[derive(Clone, Copy, PartialEq, Eq)]
struct RoundedPoint([u64; 3]);

impl RoundedPoint {
    /// The number of low bits of each double that are rounded away.
    const BITS: u32 = 12;

    /// The largest difference, in units in the last place, of two doubles for one coordinate: six, or twelve
    /// next to a power of two, rounded up to a power of two.
    const DOUBT: u64 = 16;

    const HALF: u64 = 1 << (Self::BITS - 1);

    fn of(position: &[f64; 3]) -> Self {
        Self(position.map(|c| (bits_of(c) + Self::HALF) >> Self::BITS))
    }

    /// The rounded point of the doubles of least magnitude that may approximate the same point.
    fn lower_end(position: &[f64; 3]) -> Self {
        Self(position.map(|c| (bits_of(c) + Self::HALF - Self::DOUBT) >> Self::BITS))
    }

    /// The rounded point of the doubles of greatest magnitude that may approximate the same point.
    fn upper_end(position: &[f64; 3]) -> Self {
        Self(position.map(|c| (bits_of(c) + Self::HALF + Self::DOUBT) >> Self::BITS))
    }

    /// The rounded point that takes coordinate i from `high` if bit i of `bits` is set, else from `low`.
    fn combined(low: &Self, high: &Self, bits: usize) -> Self {
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
        FxBuildHasher.hash_one(self.0.map(folded))
    }
}

/// The bits of a finite double, with −0 as +0.
fn bits_of(c: f64) -> u64 {
    (c + 0.0).to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane::Plane;

    #[test]
    fn a_point_has_one_number_however_it_is_made() {
        let mut table = VertexTable::default();
        let wall = |axis: usize, at: i64| Arc::new(Plane::axis_cut(axis, at));
        // A meet of three planes, and the same point as a lattice point.
        let met = Vertex::meet(&wall(0, 6), &wall(1, 4), &wall(2, 2)).expect("a corner");
        let first = table.number_of(&Arc::new(met));
        assert_eq!(table.number_at([3, 2, 1]), first);
        assert_ne!(table.number_at([3, 2, 2]), first);
        assert_eq!(
            (table.len(), table.find(&Vertex::lattice([0; 3]))),
            (2, None)
        );
    }
}
