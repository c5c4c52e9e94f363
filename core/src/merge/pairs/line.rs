//! Lines along which elements are swept, and the extents of elements along them.

use super::direction::{frame, unit, Span, SLACK};
use super::view::{views, View, SLOPE_ERROR};
use super::SweptElement;
use crate::arith::convert::as_double;
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::vector::{cross, dot};

/// The number of elements (triangles or parts of faces) above which lines other than the axes are tried.
pub const SLANTED_LINES_FROM: usize = 512;

/// The largest cosine of the angle between two lines whose plane is used; with a larger cosine they are
/// nearly parallel, and their plane separates little more than one line.
const MAX_COSINE_OF_LINES: f64 = 0.8;

/// A line, the extents of elements (triangles or parts of faces) along it, and how many elements overlap at a
/// point of it on average.
pub struct MeasuredLine {
    pub coordinate: LineCoordinate,
    pub spans: Vec<Span>,
    pub crowding: f64,
}

/// A function that gives each point of space a coordinate along a line.
#[derive(Clone, Copy)]
pub enum LineCoordinate {
    /// The coordinate is the dot product with this unit vector.
    Along([f64; 3]),
    /// The coordinate is the slope of the point in this view.
    Slope(View),
}

impl LineCoordinate {
    /// Returns true if the plane of two line coordinates may separate more elements (triangles or parts of
    /// faces) than one coordinate: they are far from parallel, and straight lines of space are straight in
    /// the plane.
    pub fn is_across(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Along(a), Self::Along(b)) => dot(a, b).abs() < MAX_COSINE_OF_LINES,
            _ => self.keeps_straight(other),
        }
    }

    /// Returns true if straight lines of space are straight in the plane of two line coordinates.
    pub fn keeps_straight(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Along(_), Self::Along(_)) => true,
            (Self::Slope(a), Self::Slope(b)) => a.shares_eye(b),
            _ => false,
        }
    }

    /// Returns the coordinates of a triangle's corners, or of a triangle with the same projection; `None` if
    /// the projection may be unbounded.
    pub fn coordinates(&self, corners: &[[f64; 3]; 3]) -> Option<[f64; 3]> {
        match self {
            Self::Along(direction) => Some(corners.map(|p| dot(&p, direction))),
            Self::Slope(view) => view.coordinates(corners),
        }
    }

    /// Returns a bound on the error of the coordinates along the line, for points with coordinates up to
    /// `size`.
    pub fn slack(&self, size: f64) -> f64 {
        match self {
            Self::Along(_) => size * SLACK,
            Self::Slope(_) => SLOPE_ERROR,
        }
    }
}

impl MeasuredLine {
    /// Returns the coordinate axes and, for many elements (triangles or parts of faces), lines along and
    /// across the main directions of long elements, and slopes seen from the corner that most elements of an
    /// operand share.
    pub fn all(elements: &[&SweptElement]) -> Vec<Self> {
        let mut lines: Vec<Self> = (0..3).map(|axis| Self::axis(elements, axis)).collect();
        if elements.len() > SLANTED_LINES_FROM {
            let slanted = directions(elements);
            lines.extend(slanted.iter().filter_map(|d| Self::slanted(elements, d)));
            lines.extend(
                views(elements)
                    .iter()
                    .filter_map(|v| Self::seen(elements, v)),
            );
        }
        lines
    }

    fn axis(elements: &[&SweptElement], axis: usize) -> Self {
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        let span = |e: &&SweptElement| [as_double(e.low[axis]), as_double(e.high[axis])];
        Self::new(
            LineCoordinate::Along(direction),
            elements.iter().map(span).collect(),
        )
    }

    /// Measures elements (triangles or parts of faces) along a direction; `None` if the corners of an element
    /// are not known.
    fn slanted(elements: &[&SweptElement], direction: &[f64; 3]) -> Option<Self> {
        let spans = projections(elements, direction)?;
        Some(Self::new(LineCoordinate::Along(*direction), spans))
    }

    /// Measures the slopes of elements (triangles or parts of faces) in a view; `None` if no element is ahead
    /// of the eye point.
    fn seen(elements: &[&SweptElement], view: &View) -> Option<Self> {
        let spans = view.spans(elements)?;
        Some(Self::new(LineCoordinate::Slope(*view), spans))
    }

    fn new(coordinate: LineCoordinate, spans: Vec<Span>) -> Self {
        let crowding = crowding(&spans);
        Self {
            coordinate,
            spans,
            crowding,
        }
    }
}

/// Returns the average number of elements (triangles or parts of faces) that overlap at a point of a line:
/// the sum of their lengths divided by the length of the whole range.
fn crowding(spans: &[Span]) -> f64 {
    let low = spans.iter().fold(f64::INFINITY, |m, s| m.min(s[0]));
    let high = spans.iter().fold(f64::NEG_INFINITY, |m, s| m.max(s[1]));
    let sum: f64 = spans.iter().map(|s| s[1] - s[0]).sum();
    sum / (high - low).max(f64::MIN_POSITIVE)
}

/// Returns unit vectors: the main direction of the first operand's elements (triangles or parts of faces) and
/// two directions perpendicular to it, the same three for all other elements, and the direction perpendicular
/// to both main directions.
fn directions(elements: &[&SweptElement]) -> Vec<[f64; 3]> {
    let own = elements.first().map_or(0, |e| e.operand);
    let (first, others): (Vec<&SweptElement>, Vec<&SweptElement>) =
        elements.iter().partition(|e| e.operand == own);
    let long = [direction_along(&first), direction_along(&others)];
    let mut found: Vec<[f64; 3]> = long.iter().flatten().flat_map(frame).collect();
    if let [Some(a), Some(b)] = long {
        found.push(cross(&a, &b));
    }
    found.iter().filter_map(unit).collect()
}

/// Returns the mean direction of the longest edges of triangles or parts of faces, as a unit vector; `None`
/// if there is none.
pub fn direction_along(elements: &[&SweptElement]) -> Option<[f64; 3]> {
    let mut long = [0.0f64; 3];
    let corners = elements.iter().filter_map(|e| e.corners.as_ref());
    for edge in corners.filter_map(longest_edge) {
        let sign = if dot(&edge, &long) < 0.0 { -1.0 } else { 1.0 };
        (0..3).for_each(|i| long[i] += sign * edge[i]);
    }
    unit(&long)
}

pub fn longest_edge(corners: &[[f64; 3]; 3]) -> Option<[f64; 3]> {
    let edge = |i: usize| {
        let (a, b) = (&corners[i], &corners[(i + 1) % 3]);
        each_axis(|k| b[k] - a[k])
    };
    let longer = |a: &[f64; 3], b: &[f64; 3]| dot(a, a).total_cmp(&dot(b, b));
    (0..3).map(edge).max_by(longer)
}

/// Returns the extents of elements (triangles or parts of faces) along a direction, padded for rounding;
/// `None` if the corners of an element are not known.
fn projections(elements: &[&SweptElement], direction: &[f64; 3]) -> Option<Vec<Span>> {
    elements
        .iter()
        .map(|e| {
            let corners = e.corners.as_ref()?;
            let at = corners.map(|p| dot(&p, direction));
            let size = corners.iter().flatten().fold(1.0f64, |m, x| m.max(x.abs()));
            let low = at[0].min(at[1]).min(at[2]) - size * SLACK - 1.0;
            Some([low, at[0].max(at[1]).max(at[2]) + size * SLACK + 1.0])
        })
        .collect()
}
