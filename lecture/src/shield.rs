//! The distance of the notes: how many segments shield one from the line of another.

use bspcsg::geometry::side::Split;
use bspcsg::geometry::spaces::dim2::{Dim2, Point2, Segment2};
use bspcsg::geometry::spaces::space::Space;
use std::cmp::Ordering;

/// For each segment the number that the line of segment `i` crosses before it gets there, and
/// where it does; `None` where it does not get there.
pub fn shields(segments: &[Segment2], i: usize) -> Vec<Option<(usize, [f64; 2])>> {
    let Some(own) = segments.get(i) else {
        return Vec::new();
    };
    let met: Vec<Option<Point2>> = segments.iter().map(|s| crossing(own, s)).collect();
    let rank = |at: &Option<Point2>| {
        let at = at.as_ref()?;
        let between = met.iter().flatten().filter(|p| is_between(own, p, at));
        Some((between.count(), at.approx()))
    };
    met.iter().map(rank).collect()
}

/// Return the point in which the line of one segment cuts another in two.
fn crossing(own: &Segment2, other: &Segment2) -> Option<Point2> {
    match Dim2::split(other, own.line()) {
        Split::Both { .. } => Point2::meet(own.line(), other.line()),
        _ => None,
    }
}

/// Return whether `p` lies between the segment and `q`, on the same side of the segment.
fn is_between(own: &Segment2, p: &Point2, q: &Point2) -> bool {
    let [first, last] = own.points();
    let ahead = |x: &Point2| own.order_along(last, x) != Ordering::Greater;
    let behind = |x: &Point2| own.order_along(x, first) != Ordering::Greater;
    (ahead(q) && ahead(p) && own.order_along(p, q) == Ordering::Less)
        || (behind(q) && behind(p) && own.order_along(q, p) == Ordering::Less)
}
