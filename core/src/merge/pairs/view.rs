//! Slopes of elements as seen from a corner that many of them share.
//!
//! The triangles of a fan overlap in every box and in every projection. Seen from the common corner (the
//! apex), each triangle is a line, and these lines follow each other around it.

use rustc_hash::FxHashMap;

use super::direction::{frame, largest_coordinate, unit, Span, SLACK};
use super::SweptElement;
use crate::arith::convert::as_double;
use crate::geometry::doubles::vector::{difference, dot};

/// An operand's elements (triangles or parts of faces) count as a fan if at least one in this many has a
/// corner at the apex.
const FAN_IF_ONE_IN: usize = 4;

/// A point counts as ahead only if its depth along the viewing direction is more than this share of the
/// largest coordinate.
const MIN_DEPTH_AHEAD: f64 = 1e-6;

/// A point counts as ahead only if the absolute value of its slope is less than this.
const MAX_SLOPE_AHEAD: f64 = 16.0;

/// A bound on the error of slopes of points ahead: coordinates and depths are off by less than `SLACK` times
/// the largest coordinate.
pub const SLOPE_ERROR: f64 = (1.0 + MAX_SLOPE_AHEAD) * SLACK / MIN_DEPTH_AHEAD;

/// An eye point, a viewing direction, and a direction across it in which slopes are measured.
#[derive(Clone, Copy, Debug)]
pub struct View {
    eye: [f64; 3],
    ahead: [f64; 3],
    across: [f64; 3],
    /// The largest absolute coordinate of all elements (triangles or parts of faces).
    size: f64,
}

/// Returns views from the apex of the first operand's elements (triangles or parts of faces), and from the
/// apex of all other elements, as far as they are fans.
///
/// An apex that elements of two operands share inside the cell gives no view, because no slope separates
/// these elements.
pub fn views(elements: &[&SweptElement]) -> Vec<View> {
    let own = elements.first().map_or(0, |e| e.operand);
    let (first, others): (Vec<&SweptElement>, Vec<&SweptElement>) =
        elements.iter().partition(|e| e.operand == own);
    let apexes = [&first, &others].into_iter().filter_map(|e| apex(e));
    let mut eyes: Vec<[f64; 3]> = apexes.collect();
    eyes.dedup_by_key(|eye| bits(eye));
    let size = largest_coordinate(elements);
    let from = |eye: &[f64; 3]| {
        let ahead = middle(elements, eye)?;
        let [_, u, v] = frame(&ahead);
        let view = |across: [f64; 3]| View {
            eye: *eye,
            ahead,
            across,
            size,
        };
        Some([view(unit(&u)?), view(unit(&v)?)])
    };
    let alone = eyes.iter().filter(|eye| !is_shared(elements, eye));
    alone.filter_map(from).flatten().collect()
}

/// Returns the corner that the most elements (triangles or parts of faces) share, if they are a fan;
/// otherwise `None`.
fn apex(elements: &[&SweptElement]) -> Option<[f64; 3]> {
    let mut counts: FxHashMap<[u64; 3], usize> = FxHashMap::default();
    for corner in elements.iter().filter_map(|e| e.corners.as_ref()).flatten() {
        *counts.entry(bits(corner)).or_default() += 1;
    }
    let (most, count) = counts
        .into_iter()
        .max_by_key(|(bits, count)| (*count, *bits))?;
    (count * FAN_IF_ONE_IN >= elements.len()).then(|| most.map(f64::from_bits))
}

/// Returns the bits of a point's coordinates, equal for equal points: coordinates are whole numbers, and zero
/// always has the same sign.
fn bits(point: &[f64; 3]) -> [u64; 3] {
    point.map(f64::to_bits)
}

/// Returns true if elements (triangles or parts of faces) of different operands share a corner inside the
/// cell.
pub fn share_corner(elements: &[SweptElement]) -> bool {
    let mut owners: FxHashMap<[u64; 3], usize> = FxHashMap::default();
    elements.iter().any(|e| {
        let mut within = e.corners.iter().flatten().filter(|p| e.is_at(p));
        within.any(|p| *owners.entry(bits(p)).or_insert(e.operand) != e.operand)
    })
}

/// Returns true if elements (triangles or parts of faces) of different operands share the corner `point`
/// inside the cell.
fn is_shared(elements: &[&SweptElement], point: &[f64; 3]) -> bool {
    let touches = |e: &&&SweptElement| e.is_at(point) && e.has(point);
    let mut operands = elements.iter().filter(touches).map(|e| e.operand);
    let first = operands.next();
    operands.any(|operand| Some(operand) != first)
}

impl SweptElement {
    /// Returns true if a point lies in the box of this triangle inside the cell.
    fn is_at(&self, point: &[f64; 3]) -> bool {
        let within = |i: usize| as_double(self.low[i])..=as_double(self.high[i]);
        (0..3).all(|i| within(i).contains(&point[i]))
    }

    /// Returns true if a point is one of the triangle's corners.
    fn has(&self, point: &[f64; 3]) -> bool {
        let corners = self.corners.iter().flatten();
        corners.map(bits).any(|corner| corner == bits(point))
    }
}

/// Returns the mean direction in which triangles with a corner at `eye` extend; `None` if there is no such
/// direction.
fn middle(elements: &[&SweptElement], eye: &[f64; 3]) -> Option<[f64; 3]> {
    let mut sum = [0.0f64; 3];
    let around = elements.iter().filter(|e| e.has(eye));
    for p in around.filter_map(|e| e.corners.as_ref()).flatten() {
        if let Some(toward) = unit(&difference(p, eye)) {
            (0..3).for_each(|i| sum[i] += toward[i]);
        }
    }
    unit(&sum)
}

impl View {
    /// Returns true if two views have the same eye point.
    pub fn shares_eye(&self, other: &Self) -> bool {
        bits(&self.eye) == bits(&other.eye)
    }

    /// Returns the slopes of a triangle's corners; a corner at the eye gets the slope of another corner.
    /// `None` if a corner is neither at the eye nor ahead.
    pub fn coordinates(&self, corners: &[[f64; 3]; 3]) -> Option<[f64; 3]> {
        let at_eye = |p: &[f64; 3]| bits(p) == bits(&self.eye);
        let seen = corners.iter().find(|p| !at_eye(p))?;
        let mut coordinates = [0.0; 3];
        for (point, corner) in coordinates.iter_mut().zip(corners) {
            *point = self.slope(if at_eye(corner) { seen } else { corner })?;
        }
        Some(coordinates)
    }

    /// Returns the slope of a point; `None` if the point is not ahead.
    fn slope(&self, p: &[f64; 3]) -> Option<f64> {
        let toward = difference(p, &self.eye);
        let depth = dot(&toward, &self.ahead);
        let slope = dot(&toward, &self.across) / depth;
        (depth > MIN_DEPTH_AHEAD * self.size && slope.abs() < MAX_SLOPE_AHEAD).then_some(slope)
    }

    /// Returns the least and the greatest slope of each element (a triangle or part of a face), padded by the
    /// error of slopes; an element that is not ahead gets the extremes of all slopes. `None` if no element is
    /// ahead.
    ///
    /// A slope is a quotient of linear functions. So on a triangle that is ahead, its extremes are at
    /// corners; on a triangle with a corner at the eye, it is constant along each line from that corner.
    pub fn spans(&self, elements: &[&SweptElement]) -> Option<Vec<Span>> {
        let span = |e: &&SweptElement| {
            let coordinates = self.coordinates(e.corners.as_ref()?)?;
            let least = coordinates.iter().copied().fold(f64::INFINITY, f64::min);
            let most = coordinates
                .iter()
                .copied()
                .fold(f64::NEG_INFINITY, f64::max);
            Some([least - SLOPE_ERROR, most + SLOPE_ERROR])
        };
        let spans: Vec<Option<Span>> = elements.iter().map(span).collect();
        let known = || spans.iter().flatten();
        let least = known().map(|s| s[0]).reduce(f64::min)?;
        let most = known().map(|s| s[1]).reduce(f64::max)?;
        Some(
            spans
                .into_iter()
                .map(|s| s.unwrap_or([least, most]))
                .collect(),
        )
    }
}
