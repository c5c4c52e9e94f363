//! Small changes of a mesh that may remove a crossing or a flat triangle.

use super::part::{distance, Edit, Mending};
use crate::arith::Sign;
use crate::geometry::doubles::{seen_along, turn, Point, Triangle};
use crate::mesh::faces::edges;
use crate::mesh::handle::VertexId;

/// The translations of a vertex that are tried, in spacings of doubles at the largest coordinate.
const STEPS: [[f64; 3]; 14] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, -1.0],
    [1.0, -1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, 1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [-1.0, -1.0, -1.0],
];

impl Mending {
    /// Returns the changes to try for a pair of faulty triangles: first merges of vertices, then swaps of
    /// edges, then translations.
    pub(super) fn edits(&self, fault: [u32; 2]) -> Vec<Edit> {
        let mut corners: Vec<VertexId> = fault
            .iter()
            .filter_map(|t| self.triangles[*t as usize])
            .flatten()
            .collect();
        corners.sort_unstable_by_key(|v| (self.given[v.index()], *v));
        corners.dedup();
        let mut edits = self.merges(&corners);
        edits.extend(
            fault
                .iter()
                .flat_map(|t| (0..3).filter_map(|i| self.swap(*t, i))),
        );
        edits.extend(corners.iter().flat_map(|v| self.moves(*v)));
        edits
    }

    /// Returns the merges of two corners that are within the allowed distance of each other, the nearest
    /// pairs first.
    fn merges(&self, corners: &[VertexId]) -> Vec<Edit> {
        let place = |v: VertexId| &self.vertices[v.index()];
        let mut pairs: Vec<(f64, VertexId, VertexId)> = Vec::new();
        for (k, &v) in corners.iter().enumerate() {
            for &w in &corners[..k] {
                let gap = distance(place(v), place(w));
                if gap <= self.reach() {
                    let stays = self.given[v.index()] && !self.given[w.index()];
                    let (from, to) = if stays { (w, v) } else { (v, w) };
                    pairs.extend([(gap, from, to), (gap, to, from)]);
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let near = |p: &&(f64, VertexId, VertexId)| self.drift(p.1, place(p.2)) <= self.reach();
        let free = pairs.iter().filter(|p| !self.fixed[p.1.index()]);
        free.filter(near)
            .filter_map(|&(_, from, to)| self.merge(from, to))
            .collect()
    }

    /// Merges vertex `from` into `to`. Triangles with both vertices vanish, and so do pairs of triangles
    /// that become opposite. `None` if the surface would not stay closed.
    fn merge(&self, from: VertexId, to: VertexId) -> Option<Edit> {
        let star = self.star(from);
        let renamed = |t: [VertexId; 3]| t.map(|v| if v == from { to } else { v });
        let mut made: Vec<(u32, Option<[VertexId; 3]>)> = star
            .iter()
            .filter_map(|&t| {
                let corners = renamed(self.triangles[t as usize]?);
                Some((t, has_three(&corners).then_some(corners)))
            })
            .collect();
        let old = self.star(to).into_iter().filter(|t| !star.contains(t));
        made.extend(old.map(|t| (t, self.triangles[t as usize])));
        cancel_opposites(&mut made);
        let left = || made.iter().filter_map(|m| m.1);
        let mut ends: Vec<[VertexId; 2]> = left().flat_map(edges).collect();
        ends.sort_unstable();
        if ends.windows(2).any(|pair| pair[0] == pair[1]) {
            return None;
        }
        let mut edit = Edit {
            triangles: made,
            drift: Some((to, self.drift(from, &self.vertices[to.index()]))),
            ..Edit::default()
        };
        self.part_fans(&mut edit, to)?;
        Some(edit)
    }

    /// Gives each closed ring of triangles (fan) around a vertex its own copy of the vertex, where triangles
    /// were removed; `None` if the triangles around a vertex form no closed ring.
    fn part_fans(&self, edit: &mut Edit, to: VertexId) -> Option<()> {
        let gone = edit.triangles.iter().filter(|m| m.1.is_none());
        let mut loose: Vec<VertexId> = gone
            .filter_map(|m| self.triangles[m.0 as usize])
            .flatten()
            .chain([to])
            .collect();
        loose.sort_unstable();
        loose.dedup();
        for v in loose {
            let changed = |t: u32| edit.triangles.iter().position(|m| m.0 == t);
            let mut around: Vec<Numbered> = edit
                .triangles
                .iter()
                .filter_map(|m| Some((m.0, m.1?)))
                .filter(|m| m.1.contains(&v))
                .collect();
            let others = self.star(v).into_iter().filter(|t| changed(*t).is_none());
            around.extend(others.filter_map(|t| Some((t, self.triangles[t as usize]?))));
            if around.is_empty() {
                continue;
            }
            if self.fixed[v.index()] && !self.is_whole(v) {
                continue;
            }
            for fan in fans(v, around)?.into_iter().skip(1) {
                let copy = VertexId::of(self.vertices.len() + edit.copies.len());
                edit.copies.push(v);
                for (t, corners) in fan {
                    let renamed = corners.map(|c| if c == v { copy } else { c });
                    match edit.triangles.iter_mut().find(|m| m.0 == t) {
                        Some(m) => m.1 = Some(renamed),
                        None => edit.triangles.push((t, Some(renamed))),
                    }
                }
            }
        }
        Some(())
    }

    /// Returns true if this part of the mesh contains all triangles around a vertex.
    fn is_whole(&self, v: VertexId) -> bool {
        self.star(v).iter().all(|t| {
            let corners = self.triangles[*t as usize].unwrap_or_default();
            edges(corners)
                .iter()
                .filter(|e| e.contains(&v))
                .all(|[a, b]| self.halves.contains_key(&[*b, *a]))
        })
    }

    /// Replaces the common edge of a triangle and its neighbour by the other diagonal of their quadrilateral;
    /// `None` unless the two diagonals nearly meet.
    fn swap(&self, t: u32, edge: usize) -> Option<Edit> {
        let corners = self.triangles[t as usize]?;
        let (a, b, c) = (
            corners[edge],
            corners[(edge + 1) % 3],
            corners[(edge + 2) % 3],
        );
        let mate = *self.halves.get(&[b, a])?;
        let others = self.triangles[mate as usize]?;
        let d = *others.iter().find(|v| **v != a && **v != b)?;
        let taken = self.halves.contains_key(&[c, d]) || self.halves.contains_key(&[d, c]);
        let [p, q, r, s] = [a, b, c, d].map(|v| &self.vertices[v.index()]);
        if c == d || taken || !diagonals_meet([p, q, r, s], self.reach()) {
            return None;
        }
        Some(Edit {
            triangles: vec![(t, Some([a, d, c])), (mate, Some([d, b, c]))],
            ..Edit::default()
        })
    }

    /// Returns the translations of a vertex by one spacing of doubles that stay within the allowed distance.
    fn moves(&self, v: VertexId) -> Vec<Edit> {
        if self.fixed[v.index()] {
            return Vec::new();
        }
        let place = self.vertices[v.index()];
        let moved = |step: &[f64; 3]| {
            let place = [0, 1, 2].map(|i| self.precision.round(place[i] + step[i] * self.spacing));
            Edit {
                moves: vec![(v, place)],
                ..Edit::default()
            }
        };
        let is_near = |edit: &Edit| self.drift(v, &edit.moves[0].1) <= self.reach();
        STEPS.iter().map(moved).filter(is_near).collect()
    }
}

/// The number of a triangle, and its vertices.
type Numbered = (u32, [VertexId; 3]);

fn has_three([a, b, c]: &[VertexId; 3]) -> bool {
    a != b && b != c && c != a
}

/// Removes pairs of triangles with the same vertices in opposite order.
fn cancel_opposites(made: &mut [(u32, Option<[VertexId; 3]>)]) {
    let from_least = |t: [VertexId; 3]| {
        let first = (0..3).min_by_key(|i| t[*i]).unwrap_or(0);
        [t[first], t[(first + 1) % 3], t[(first + 2) % 3]]
    };
    for k in 1..made.len() {
        let Some(corners) = made[k].1.map(from_least) else {
            continue;
        };
        let opposite = [corners[0], corners[2], corners[1]];
        let mate = (0..k).find(|i| made[*i].1.map(from_least) == Some(opposite));
        if let Some(mate) = mate {
            made[mate].1 = None;
            made[k].1 = None;
        }
    }
}

/// Divides the triangles around a vertex into closed rings (fans), the ring of the first triangle first;
/// `None` if they form no closed rings.
fn fans(v: VertexId, around: Vec<Numbered>) -> Option<Vec<Vec<Numbered>>> {
    let turned = |t: &[VertexId; 3]| {
        let at = t.iter().position(|c| *c == v).unwrap_or(0);
        [t[(at + 1) % 3], t[(at + 2) % 3]]
    };
    let mut rest = around;
    let mut fans = Vec::new();
    while !rest.is_empty() {
        let first = rest.remove(0);
        let [start, mut next] = turned(&first.1);
        let mut fan = vec![first];
        while next != start {
            let at = rest.iter().position(|m| turned(&m.1)[0] == next)?;
            let found = rest.remove(at);
            next = turned(&found.1)[1];
            fan.push(found);
        }
        fans.push(fan);
    }
    Some(fans)
}

/// Returns true if the diagonals of the triangles a b c and b a d pass each other within the distance
/// `reach`.
///
/// Projected along the axis of their largest total area, no triangle over the other diagonal may turn over,
/// exactly. So the projected diagonals cross, and the distance there is a quotient.
fn diagonals_meet(corners: [&Point; 4], reach: f64) -> bool {
    let [a, b, c, d] = corners.map(|p| *p);
    let (first, second) = (area(&[a, b, c]), area(&[b, a, d]));
    let both = [0, 1, 2].map(|i| first[i] + second[i]);
    let axis = (1..3).fold(0, |m, i| if both[i].abs() > both[m].abs() { i } else { m });
    let facing = if both[axis] > 0.0 {
        Sign::Positive
    } else {
        Sign::Negative
    };
    let triangles = [[a, b, c], [b, a, d], [a, d, c], [d, b, c]];
    if triangles
        .iter()
        .any(|t| turn(seen_along(t, axis)) == -facing)
    {
        return false;
    }
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let minus = |p: &Point, q: &Point| [0, 1, 2].map(|i| p[i] - q[i]);
    let cross = |u: &Point, v: &Point| u[j] * v[k] - u[k] * v[j];
    let (u, v, w) = (minus(&b, &a), minus(&d, &c), minus(&c, &a));
    let (along, beside) = (cross(&w, &v) / cross(&u, &v), cross(&w, &u) / cross(&u, &v));
    let on = |p: &Point, u: &Point, t: f64| [0, 1, 2].map(|i| p[i] + t * u[i]);
    distance(&on(&a, &u, along), &on(&c, &v, beside)) <= reach
}

/// Twice the area of a triangle's projection along each axis, with its sign.
fn area([a, b, c]: &Triangle) -> Point {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j])
    })
}
