//! What two triangles in doubles have in common, exactly.
//!
//! Points that surfaces share never make them cross: where two surfaces pass through each other
//! they do so along lines. So common points count as nothing, and a common stretch of a line is
//! told apart by whether it runs inside the triangles or along their edges.
#![allow(clippy::float_cmp, reason = "equal corners are meant to the last bit")]

use super::doubles::{is_flat, seen_along, side, turn, Facing, Point, Triangle};

/// What two triangles have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meeting {
    /// Nothing, or points.
    Clear,
    /// A stretch of this edge of the first, inside the second.
    FirstEdge(usize),
    /// A stretch of this edge of the second, inside the first.
    SecondEdge(usize),
    /// A stretch of an edge of each.
    Edges(usize, usize),
    /// A stretch that runs inside both.
    Crossing,
    /// An area.
    Overlap,
}

/// What two triangles that have area have in common.
pub fn meeting(p: &Triangle, q: &Triangle) -> Meeting {
    let of_p = sides(p, q);
    let first = reach(&of_p);
    if first == Reach::Point {
        return Meeting::Clear;
    }
    let of_q = sides(q, p);
    match (first, reach(&of_q)) {
        (_, Reach::Point) => Meeting::Clear,
        (Reach::All, _) | (_, Reach::All) if overlap(p, q) => Meeting::Overlap,
        (Reach::All, _) | (_, Reach::All) => Meeting::Clear,
        (Reach::Edge(i), Reach::Edge(j)) if is_same_edge(p, i, q, j) => Meeting::Edges(i, j),
        (first, second) if has_common_stretch(p, alone(&of_p), q, alone(&of_q)) => {
            match (first, second) {
                (Reach::Edge(i), Reach::Edge(j)) => Meeting::Edges(i, j),
                (Reach::Edge(i), _) => Meeting::FirstEdge(i),
                (_, Reach::Edge(j)) => Meeting::SecondEdge(j),
                _ => Meeting::Crossing,
            }
        }
        _ => Meeting::Clear,
    }
}

/// On which sides of a triangle's plane the corners of another lie.
fn sides(triangle: &Triangle, plane: &Triangle) -> [i32; 3] {
    let facing = Facing::of(plane);
    let side = |p: &Point| {
        if plane.contains(p) {
            0
        } else {
            facing.side(p)
        }
    };
    let [a, b, c] = triangle;
    [side(a), side(b), side(c)]
}

/// What a triangle has in common with the plane of another.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reach {
    /// A corner at most.
    Point,
    /// An edge, by its number.
    Edge(usize),
    /// A stretch of its inside.
    Inside,
    /// All of it.
    All,
}

fn reach(sides: &[i32; 3]) -> Reach {
    let zeros = sides.iter().filter(|s| **s == 0).count();
    let passes = sides.contains(&1) && sides.contains(&-1);
    match (zeros, passes) {
        (3, _) => Reach::All,
        (2, _) => Reach::Edge((alone(sides) + 1) % 3),
        (_, true) => Reach::Inside,
        _ => Reach::Point,
    }
}

fn is_same_edge(p: &Triangle, i: usize, q: &Triangle, j: usize) -> bool {
    let ends = |t: &Triangle, at: usize| [t[at], t[(at + 1) % 3]];
    let ([a, b], [c, d]) = (ends(p, i), ends(q, j));
    a == d && b == c || a == c && b == d
}

/// The corner that is alone on its side, and not in the plane where another can be.
fn alone(sides: &[i32; 3]) -> usize {
    let single = |i: &usize| {
        let others = sides.iter().filter(|s| **s == sides[*i]).count();
        others == 1 && sides[*i] != 0
    };
    (0..3).find(single).unwrap_or(0)
}

/// Whether the stretches in which two triangles cover the line that their planes share have more
/// than a point in common.
///
/// The edges at the lone corners `p[i]` and `q[k]` end the stretches. Which of two such edges comes
/// first on the line is the sign of the volume they span, up to a sign that is the same for all
/// four pairs; zero says that they meet there.
fn has_common_stretch(p: &Triangle, i: usize, q: &Triangle, k: usize) -> bool {
    let ends = |t: &Triangle, at: usize| [t[(at + 1) % 3], t[(at + 2) % 3]];
    let order = |our: &Point, their: &Point| side(&[p[i], *our, q[k]], their);
    let (ours, theirs) = (ends(p, i), ends(q, k));
    let pairs = [(0, 0), (0, 1), (1, 0), (1, 1)];
    let orders = pairs.map(|(a, b)| order(&ours[a], &theirs[b]));
    orders.contains(&1) && orders.contains(&-1)
}

/// Whether two triangles of one plane have an area in common: no edge's line separates them.
fn overlap(p: &Triangle, q: &Triangle) -> bool {
    let facing = |axis: usize| turn(seen_along(p, axis));
    let Some(axis) = (0..3).find(|axis| facing(*axis) != 0) else {
        return false;
    };
    let (p, q) = (seen_along(p, axis), seen_along(q, axis));
    let separates = |p: &[[f64; 2]; 3], q: &[[f64; 2]; 3]| {
        let inner = turn(*p);
        (0..3).any(|i| {
            let beyond = |c: &[f64; 2]| turn([p[i], p[(i + 1) % 3], *c]) != inner;
            q.iter().all(beyond)
        })
    };
    !separates(&p, &q) && !separates(&q, &p)
}

/// Whether the surface that bends from `p` to `p_mate` over their common edge a → b passes through
/// the one that bends from `q` to `q_mate` over an edge on the same line, each given by its apex.
///
/// Half-planes that coincide have an area in common, which is found elsewhere; here they count as
/// not passing.
pub fn interleave(axis: [&Point; 2], [p, p_mate]: [&Point; 2], [q, q_mate]: [&Point; 2]) -> bool {
    let turn = |u: &Point, v: &Point| side(&[*axis[0], *axis[1], *u], v);
    // The sector counterclockwise from p to its mate, by what lies strictly inside it.
    let inside = |x: &Point| match turn(p, p_mate) {
        1 => turn(p, x) > 0 && turn(x, p_mate) > 0,
        -1 => !(turn(p_mate, x) >= 0 && turn(x, p) >= 0),
        _ => turn(p, x) > 0,
    };
    let beside = |x: &Point| {
        let same = |y: &Point| turn(y, x) == 0 && is_same_half(axis, y, x);
        same(p) || same(p_mate)
    };
    !beside(q) && !beside(q_mate) && inside(q) != inside(q_mate)
}

/// Whether two points of one plane with a line lie on the same side of it.
fn is_same_half(axis: [&Point; 2], x: &Point, y: &Point) -> bool {
    let first = [*axis[0], *axis[1], *x];
    let second = [*axis[0], *axis[1], *y];
    (0..3).any(|along| {
        let turns = [
            turn(seen_along(&first, along)),
            turn(seen_along(&second, along)),
        ];
        turns[0] != 0 && turns[0] == turns[1]
    })
}

/// Whether a surface that bends over an edge, given by the apexes of its two triangles, passes
/// through the plane of a triangle in which the edge lies.
pub fn passes(plane: &Triangle, [apex, mate]: [&Point; 2]) -> bool {
    side(plane, apex) * side(plane, mate) < 0
}

/// Whether a triangle has no area, so that its points all lie on its neighbours' edges.
pub fn has_no_area(triangle: &Triangle) -> bool {
    let [a, b, c] = triangle;
    a == b || b == c || c == a || is_flat(triangle)
}
