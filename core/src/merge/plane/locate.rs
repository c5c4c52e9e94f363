//! Locates many points relative to a set of the plane, by one sweep.

use std::cmp::Ordering;

use super::input::Outlines;
use super::sweep::Sweep;
use crate::arith::convert::as_whole;
use crate::error::Result;
use crate::geometry::spaces::dim2::{Lattice2, Point2};
use crate::interrupt::poll;
use crate::tree::partition::{classify, Label, Location};
use crate::tree::plane::{Boundary, PlaneSet};

/// Returns for each point whether it is inside, on the boundary of or outside a set of the plane.
///
/// # Errors
/// `Internal` for a defect.
pub fn located(set: &PlaneSet, points: &[Lattice2]) -> Result<Vec<Location>> {
    if !set.should_build_tree(points.len())
        && let Some(boundary) = set.closed()?
    {
        return locations_by_sweep(boundary, points);
    }
    let tree = set.tree()?;
    let location = |p: &Lattice2| classify(tree, &Point2::lattice(*p));
    Ok(points.iter().map(location).collect())
}

/// The width in lattice steps that is added around corners in doubles: they are off by two units in the last
/// place, which are at most two steps below 2⁵³, and truncation to integers is off by less than one step.
const CORNER_SLACK: f64 = 4.0;

/// Returns the low and the high corner of a box around a boundary, rounded outwards; `None` if the boundary
/// has no corners.
fn frame(boundary: &Boundary) -> Option<[Lattice2; 2]> {
    let points = boundary.corners.iter().map(|c| c.point.approx());
    let (low, high) = points.map(|p| (p, p)).reduce(|(low, high), (p, _)| {
        let on_both = |f: fn(f64, f64) -> f64, q: [f64; 2]| [f(q[0], p[0]), f(q[1], p[1])];
        (on_both(f64::min, low), on_both(f64::max, high))
    })?;
    Some([
        low.map(|c| as_whole(c - CORNER_SLACK)),
        high.map(|c| as_whole(c + CORNER_SLACK)),
    ])
}

/// Returns for each point whether it is inside, on or outside a closed boundary, by a sweep over the points
/// and the boundary's corners.
///
/// # Cost
/// O(k + (n + i) log n) for n edges and k points, of which i lie in the box around the edges, if the sweep
/// line meets few edges at once.
fn locations_by_sweep(boundary: &Boundary, points: &[Lattice2]) -> Result<Vec<Location>> {
    let mut outlines = Outlines::default();
    outlines.extend(boundary, 1);
    let outside = match boundary.outer {
        Label::In => Location::In,
        Label::Out => Location::Out,
    };
    let mut locations = vec![outside; points.len()];
    let Some([low, high]) = frame(boundary) else {
        return Ok(locations);
    };
    let is_near = |p: &Lattice2| (0..2).all(|i| low[i] <= p[i] && p[i] <= high[i]);
    let mut order: Vec<usize> = (0..points.len()).filter(|i| is_near(&points[*i])).collect();
    order.sort_unstable_by_key(|i| points[*i]);
    let mut left = order.into_iter().map(|i| (i, Point2::lattice(points[i])));
    let mut next = left.next();
    let mut sweep = Sweep::new(&outlines, |number| number > 0);
    while let Some(event) = sweep.next() {
        poll();
        while let Some((i, point)) = &next {
            locations[*i] = match point.order(&event.corner.point) {
                Ordering::Less => sweep.location(point),
                Ordering::Equal => Location::On,
                Ordering::Greater => break,
            };
            next = left.next();
        }
        sweep.process(&event)?;
    }
    for (i, point) in next.into_iter().chain(left) {
        locations[i] = sweep.location(&point);
    }
    Ok(locations)
}
