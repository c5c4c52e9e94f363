//! The locations of many points: a sweep passes them with the corners of a boundary.

use super::input::Outlines;
use super::sweep::Sweep;
use crate::error::Result;
use crate::geometry::dim2::{Lattice2, Point2};
use crate::interrupt::poll;
use crate::tree::partition::{classify, Location};
use crate::tree::plane::{Boundary, PlaneSet};

/// Locate each of some points relative to a set.
///
/// # Errors
/// `Internal` for a defect.
pub fn located(set: &PlaneSet, points: &[Lattice2]) -> Result<Vec<Location>> {
    if !set.wants_tree(points.len())
        && let Some(boundary) = set.closed()?
    {
        return passed(boundary, points);
    }
    let tree = set.tree()?;
    let place = |p: &Lattice2| classify(tree, &Point2::lattice(*p));
    Ok(points.iter().map(place).collect())
}

/// Locate each of some points relative to a closed boundary's set.
///
/// # Cost
/// O((n + k) log n) for n edges and k points, if the sweep's line meets few edges at once.
fn passed(boundary: &Boundary, points: &[Lattice2]) -> Result<Vec<Location>> {
    let mut outlines = Outlines::default();
    outlines.extend(boundary, 1);
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_unstable_by_key(|i| points[*i]);
    let mut places = vec![Location::Out; points.len()];
    let mut left = order.into_iter().peekable();
    let mut sweep = Sweep::new(&outlines, |number| number > 0);
    while let Some(event) = sweep.next() {
        poll();
        let before = |i: &usize| {
            Point2::lattice(points[*i])
                .order(&event.corner.point)
                .is_lt()
        };
        while let Some(i) = left.next_if(before) {
            places[i] = sweep.location(&points[i]);
        }
        let equal = |i: &usize| {
            Point2::lattice(points[*i])
                .order(&event.corner.point)
                .is_eq()
        };
        while let Some(i) = left.next_if(equal) {
            places[i] = Location::On;
        }
        sweep.pass(&event)?;
    }
    for i in left {
        places[i] = sweep.location(&points[i]);
    }
    Ok(places)
}
