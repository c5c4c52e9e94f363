//! The curves that segments on an element form: what continues what, and what may cross.

use std::cmp::Ordering;
use std::sync::Arc;

use smallvec::SmallVec;

use super::cutting::Special;
use super::segment::{End, Segment};
use crate::arith::convert::as_double;
use crate::geometry::outline::order_along;
use crate::geometry::polygon::{bounds, Polygon};
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;

/// The segment that continues each.
pub(super) struct Joints(SmallVec<[Option<usize>; 2]>);

impl Joints {
    /// Each end inside the element must be where exactly one other segment begins.
    pub(super) fn of(segments: &[Segment]) -> Result<Self, Special> {
        let address = |end: &End| Arc::as_ptr(&end.at) as usize;
        let inner = |end: &&End| end.edge.is_none();
        let mut begins: SmallVec<[(usize, usize); 4]> = SmallVec::new();
        let numbered = segments.iter().enumerate();
        begins.extend(
            numbered
                .filter(|(_, s)| inner(&&s.from))
                .map(|(i, s)| (address(&s.from), i)),
        );
        begins.sort_unstable();
        let ending = segments.iter().filter(|s| inner(&&s.to)).count();
        if ending != begins.len() || begins.windows(2).any(|w| w[0].0 == w[1].0) {
            return Err(Special);
        }
        let next = |segment: &Segment| {
            if segment.to.edge.is_some() {
                return Ok(None);
            }
            let found = begins.binary_search_by_key(&address(&segment.to), |b| b.0);
            found.map(|at| Some(begins[at].1)).map_err(|_| Special)
        };
        let next: SmallVec<_> = segments.iter().map(next).collect::<Result<_, _>>()?;
        let mut taken = none_of(segments);
        let twice = |i: &usize| std::mem::replace(&mut taken[*i], true);
        if next.iter().flatten().any(twice) {
            return Err(Special);
        }
        Ok(Self(next))
    }

    /// The segment that continues one.
    pub(super) fn next(&self, segment: usize) -> Option<usize> {
        self.0[segment]
    }

    /// The segments of each closed curve, by number.
    pub(super) fn loops(&self, segments: &[Segment]) -> Vec<Vec<usize>> {
        let mut seen = none_of(segments);
        let mut follow = |start: usize| {
            let mut at = Some(start);
            let mut found = Vec::new();
            while let Some(i) = at.filter(|i| !seen[*i]) {
                seen[i] = true;
                found.push(i);
                at = self.0[i];
            }
            found
        };
        for (i, segment) in segments.iter().enumerate() {
            poll();
            if segment.from.edge.is_some() {
                follow(i);
            }
        }
        let curves = (0..segments.len()).map(follow);
        curves.filter(|curve| !curve.is_empty()).collect()
    }

    /// The segments with those joined that continue each other on one line, and what continues them.
    pub(super) fn joined(self, segments: Vec<Segment>) -> Result<(Vec<Segment>, Self), Special> {
        let mut continued = none_of(&segments);
        let mut any = false;
        for (i, next) in self.0.iter().enumerate() {
            poll();
            let Some(next) = *next else { continue };
            let (a, b) = (&segments[i], &segments[next]);
            match a.plane.coincides(&b.plane) {
                None => {}
                Some(orientation) if orientation.is_opposite() == (a.plus != b.plus) => {
                    continued[next] = true;
                    any = true;
                }
                Some(_) => return Err(Special),
            }
        }
        if !any {
            return Ok((segments, self));
        }
        let last = |mut i: usize| {
            while let Some(next) = self.0[i].filter(|next| continued[*next]) {
                i = next;
            }
            segments[i].to.clone()
        };
        let firsts = (0..segments.len()).filter(|i| !continued[*i]);
        let joined: Vec<Segment> = firsts
            .map(|i| Segment {
                from: segments[i].from.clone(),
                to: last(i),
                plane: Arc::clone(&segments[i].plane),
                ..segments[i]
            })
            .collect();
        let joints = Self::of(&joined)?;
        Ok((joined, joints))
    }
}

/// For each segment false: as a rule they are few.
fn none_of(segments: &[Segment]) -> SmallVec<[bool; 16]> {
    SmallVec::from_elem(false, segments.len())
}

/// Calls for each two segments that do not follow each other and may meet, until that fails.
pub(super) fn each_near_pair(
    segments: &[Segment],
    mut found: impl FnMut(usize, usize) -> Result<(), Special>,
) -> Result<(), Special> {
    let (count, inner) = (
        segments.len(),
        segments.iter().any(|s| s.from.edge.is_none()),
    );
    if count < 2 || count == 2 && inner {
        return Ok(());
    }
    let boxes: Vec<([f64; 3], [f64; 3])> = segments
        .iter()
        .map(|s| bounds([&*s.from.at, &*s.to.at].into_iter()))
        .collect();
    let mut order: Vec<usize> = (0..segments.len()).collect();
    let axis = widest(&boxes);
    order.sort_by(|a, b| boxes[*a].0[axis].total_cmp(&boxes[*b].0[axis]));
    let beyond = |a: usize, b: usize| boxes[b].0[axis] > boxes[a].1[axis];
    let apart = |a: usize, b: usize| {
        let ((low, high), (least, most)) = (&boxes[a], &boxes[b]);
        (0..3).any(|i| low[i] > most[i] || least[i] > high[i])
    };
    for (k, a) in order.iter().enumerate() {
        poll();
        let others = order[k + 1..].iter().take_while(|b| !beyond(*a, **b));
        for b in others.filter(|b| !apart(*a, **b)) {
            if !segments[*a].is_clear_of(&segments[*b]) {
                found(*a, *b)?;
            }
        }
    }
    Ok(())
}

/// The axis along which boxes reach farthest.
fn widest(boxes: &[([f64; 3], [f64; 3])]) -> usize {
    let extent = |i: usize| {
        let low = boxes.iter().fold(f64::INFINITY, |m, b| m.min(b.0[i]));
        let high = boxes.iter().fold(f64::NEG_INFINITY, |m, b| m.max(b.1[i]));
        high - low
    };
    (0..3)
        .max_by(|i, j| extent(*i).total_cmp(&extent(*j)))
        .unwrap_or(0)
}

/// Sorts points of a segment in its direction.
pub(super) fn sort_between<T>(
    [a, b]: [&Arc<Vertex>; 2],
    items: &mut [T],
    at: impl Fn(&T) -> &Arc<Vertex>,
) {
    if items.len() < 2 {
        return;
    }
    let Some((axis, forward)) = direction([a, b]) else {
        return;
    };
    items.sort_by(|x, y| {
        let order = order_along(at(x), at(y), axis);
        if forward.is_lt() {
            order
        } else {
            order.reverse()
        }
    });
}

/// An axis along which two points differ, and how: the first one that tells, of those along which
/// doubles see them farthest apart.
///
/// Doubles alone do not tell: rounding moves points of a wall apart along the axis that it crosses,
/// and where lattice and doubles are equally fine, perhaps farther than along the wall.
fn direction([a, b]: [&Arc<Vertex>; 2]) -> Option<(usize, Ordering)> {
    let (p, q) = (a.approx(), b.approx());
    let extent = |i: &usize| (q[*i] - p[*i]).abs();
    let mut axes = [0, 1, 2];
    axes.sort_by(|i, j| extent(j).total_cmp(&extent(i)));
    let mut orders = axes.into_iter().map(|axis| (axis, order_along(a, b, axis)));
    orders.find(|(_, order)| order.is_ne())
}

impl Segment {
    /// Return whether two segments follow each other, or one lies on one side of the other's line.
    fn is_clear_of(&self, other: &Self) -> bool {
        let follows = |a: &Self, b: &Self| Arc::ptr_eq(&a.to.at, &b.from.at);
        follows(self, other)
            || follows(other, self)
            || self.is_beside(other)
            || other.is_beside(self)
    }

    fn is_beside(&self, other: &Self) -> bool {
        let side = |end: &End| end.at.side_of(&other.plane);
        let from = side(&self.from);
        from != Side::On && from == side(&self.to)
    }
}

/// Return whether a closed curve of segments turns left around what it encloses, as seen from the
/// plus side of the polygon's plane.
pub(super) fn turns_left(
    polygon: &Polygon,
    segments: &[Segment],
    curve: &[usize],
) -> Result<bool, Special> {
    let axis = polygon.support().main_axis();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let origin = segments[curve[0]].from.at.approx();
    let place = |end: &End| {
        let p = end.at.approx();
        [p[u] - origin[u], p[v] - origin[v]]
    };
    let (mut area, mut reach, mut size) = (0.0f64, 0.0f64, 0.0f64);
    for segment in curve.iter().map(|i| &segments[*i]) {
        poll();
        let (p, q) = (place(&segment.from), place(&segment.to));
        area += p[0] * q[1] - p[1] * q[0];
        reach = reach.max(p[0].abs()).max(p[1].abs());
        let c = segment.from.at.approx();
        size = size.max(c[u].abs()).max(c[v].abs());
    }
    // Coordinates are off by less than 4 units in the last place of `size`, each of two products
    // by twice that times `reach`; sums of n terms are rounded n times, and `reach` is at most
    // twice `size`.
    let n = as_double(curve.len());
    let doubt = n * (n + 32.0) * 4.0 * f64::EPSILON * reach * size;
    if area.abs() <= doubt {
        return Err(Special);
    }
    Ok((area > 0.0) == (polygon.support().normal()[axis] > 0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arith::convert::as_number;
    use crate::geometry::plane::{Lattice, Plane};
    use crate::merge::scenes::triangle;

    /// The segments from each of some points in a plane to the next.
    fn path(points: &[Lattice]) -> Vec<Segment> {
        let vertices: Vec<_> = points
            .iter()
            .map(|p| Arc::new(Vertex::lattice(*p)))
            .collect();
        let end = |at: &Arc<Vertex>| End {
            at: Arc::clone(at),
            edge: None,
        };
        let segment = |i: usize| {
            let next = (i + 1) % points.len();
            let [a, b] = [points[i], points[next]];
            let plane = Plane::through(&a, &b, &[a[0], a[1], a[2] + 1]);
            Segment {
                from: end(&vertices[i]),
                to: end(&vertices[next]),
                operand: 1,
                plane: Arc::new(plane.expect("two points and one above")),
                number: as_number(i),
                plus: false,
            }
        };
        (0..points.len()).map(segment).collect()
    }

    const SQUARE: [Lattice; 4] = [[1, 1, 0], [3, 1, 0], [3, 3, 0], [1, 3, 0]];

    #[test]
    fn a_ring_is_one_closed_curve_and_a_gap_in_it_is_special() {
        let mut ring = path(&SQUARE);
        let joints = Joints::of(&ring).ok().expect("all are continued");
        assert_eq!(joints.loops(&ring).len(), 1);
        ring.pop();
        assert!(Joints::of(&ring).is_err());
    }

    #[test]
    fn curves_turn_left_or_right_as_seen_from_above() {
        let floor = triangle([[0, 0, 0], [9, 0, 0], [0, 9, 0]]);
        let mut corners = SQUARE;
        let turns = |corners: &[Lattice]| turns_left(&floor, &path(corners), &[0, 1, 2, 3]).ok();
        assert_eq!(turns(&corners), Some(true));
        corners.reverse();
        assert_eq!(turns(&corners), Some(false));
    }

    /// Doubles this far out are as coarse as the lattice: points of a wall seem to lie on both sides
    /// of it, at times farther apart than they are along it.
    #[test]
    fn points_of_a_wall_are_sorted_along_it_however_coarse_doubles_are() {
        let far = (1 << 53) - 10;
        let [wall, floor] = [(1, 2 * far + 7), (2, 2 * far + 6)]
            .map(|(axis, doubled)| Arc::new(Plane::axis_cut(axis, doubled)));
        let at = |step: i64| {
            let slant = Plane::through_point([7, 0, 1], &[far, far, far + step]);
            let slant = Arc::new(slant.expect("a normal"));
            Arc::new(Vertex::meet(&slant, &wall, &floor).expect("one point"))
        };
        let row: Vec<(i64, Arc<Vertex>)> = (3..9).map(|step| (step, at(step))).collect();
        for (i, j) in (0..6).flat_map(|i| (i + 2..6).map(move |j| (i, j))) {
            let [first, last] = [&row[i].1, &row[j].1];
            let mut between: Vec<_> = row[i..=j].iter().rev().collect();
            sort_between([first, last], &mut between, |point| &point.1);
            assert!(between.is_sorted_by_key(|point| point.0), "{i} to {j}");
            sort_between([last, first], &mut between, |point| &point.1);
            assert!(between.is_sorted_by_key(|point| -point.0), "{j} to {i}");
        }
    }

    #[test]
    fn a_bow_tie_may_cross_itself_and_a_square_does_not() {
        let [a, b, c, d] = SQUARE;
        let may_cross = |corners| each_near_pair(&path(corners), |_, _| Err(Special)).is_err();
        assert!(!may_cross(&SQUARE));
        assert!(may_cross(&[a, c, b, d]));
    }
}
