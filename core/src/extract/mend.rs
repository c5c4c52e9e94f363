//! Crossings that rounding made, taken out by small changes.
//!
//! Each change is tried and judged exactly: it stays if fewer faults are left. So mending ends, and
//! what it could not take out is known.
//!
//! # Source
//! Iterated rounding and repair as in Lazard and Valque, *Removing self-intersections in 3D meshes
//! while preserving floating-point coordinates*, 2024. Changes here are local and never subdivide.

use std::collections::BTreeSet;

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use super::crossings::{crosses_at, Faults};
use crate::geometry::doubles::{seen_along, turn, Point, Triangle};
use crate::geometry::extent::Extent;
use crate::geometry::meeting::{has_no_area, meeting, Meeting};
use crate::interrupt::spend;

/// The numbers in which coordinates are delivered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 53 binary places.
    Double,
    /// 24 binary places.
    Single,
}

impl Precision {
    /// The nearest number.
    pub fn round(self, x: f64) -> f64 {
        match self {
            Self::Double => x,
            Self::Single => f64::from(x as f32),
        }
    }

    /// The distance of neighbouring numbers of this size.
    fn spacing(self, x: f64) -> f64 {
        match self {
            Self::Double => x.abs().next_up() - x.abs(),
            Self::Single => f64::from((x.abs() as f32).next_up()) - self.round(x.abs()),
        }
    }
}

/// How far a change may move the surface, in spacings of the largest coordinate: rounding moves a
/// point by half a spacing on each axis, and two surfaces in opposite directions.
const FARTHEST: f64 = 4.0;

/// Directions in which a vertex is moved, in spacings of the largest coordinate.
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

/// Changes tried for each fault before it is left: 30 merges, 6 swaps, and 14 moves of 6 corners.
const TRIES: usize = 120;

/// Comparisons of boxes, at about a nanosecond each, after which mending gives up.
const WORK: usize = 4_000_000_000;

/// Part of a mesh that is being mended. Triangles keep their numbers; removed ones are `None`.
pub struct Mending {
    /// The vertices; copies are added at the end.
    pub vertices: Vec<Point>,
    /// The triangles.
    pub triangles: Vec<Option<[u32; 3]>>,
    /// Vertices that stay: not all of their triangles are in this part.
    fixed: Vec<bool>,
    /// Vertices of inputs, which others go to.
    given: Vec<bool>,
    extents: Vec<Extent>,
    flat: BTreeSet<u32>,
    crossings: BTreeSet<[u32; 2]>,
    halves: HashMap<[u32; 2], u32>,
    precision: Precision,
    /// Of the largest coordinate.
    spacing: f64,
    /// For each vertex how far it, and those merged with it, were moved at most.
    drifts: Vec<f64>,
    work: usize,
    moved: HashSet<u32>,
}

/// A change that is tried: where vertices go, and what becomes of triangles.
#[derive(Debug, Default)]
struct Edit {
    moves: Vec<(u32, Point)>,
    triangles: Vec<(u32, Option<[u32; 3]>)>,
    /// How far the vertex that another was merged with has moved it.
    drift: Option<(u32, f64)>,
    /// Copies of vertices, in order, made for surfaces that no longer hang together.
    copies: Vec<u32>,
}

impl Mending {
    /// The part, all faults of which are known.
    pub fn new(
        vertices: Vec<Point>,
        triangles: Vec<[u32; 3]>,
        [fixed, given]: [Vec<bool>; 2],
        precision: Precision,
        faults: &Faults,
    ) -> Self {
        let largest = vertices
            .iter()
            .flatten()
            .fold(0.0f64, |m, x| m.max(x.abs()));
        let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize]);
        let extents = triangles.iter().map(|t| Extent::of(&corners(t))).collect();
        let ends = |(t, c): (usize, &[u32; 3])| edges(c).map(|e| (e, t as u32));
        let drifts = vec![0.0; vertices.len()];
        let halves = triangles.iter().enumerate().flat_map(ends).collect();
        Self {
            triangles: triangles.into_iter().map(Some).collect(),
            vertices,
            fixed,
            given,
            extents,
            flat: faults.flat.iter().copied().collect(),
            crossings: faults.crossings.iter().copied().collect(),
            halves,
            precision,
            spacing: precision.spacing(largest),
            drifts,
            work: WORK,
            moved: HashSet::default(),
        }
    }

    /// Takes out faults until none is left or none of the changes helps.
    pub fn run(&mut self) {
        let mut open: Vec<[u32; 2]> = self.faults();
        while let Some(fault) = open.pop() {
            if !self.is_fault(fault) {
                continue;
            }
            if self.work == 0 {
                return;
            }
            if self.improve(fault) {
                // What was tried in vain before may help now.
                open = self.faults();
            }
        }
    }

    /// Whether a vertex was moved.
    pub fn is_moved(&self, vertex: u32) -> bool {
        self.moved.contains(&vertex)
    }

    /// The faults left; a flat triangle is a pair with itself.
    pub fn faults(&self) -> Vec<[u32; 2]> {
        let flat = self.flat.iter().map(|t| [*t, *t]);
        self.crossings.iter().copied().chain(flat).collect()
    }

    fn is_fault(&self, fault: [u32; 2]) -> bool {
        self.crossings.contains(&fault) || fault[0] == fault[1] && self.flat.contains(&fault[0])
    }

    /// Makes the first change that leaves fewer faults.
    fn improve(&mut self, fault: [u32; 2]) -> bool {
        let edits = self.edits(fault);
        edits
            .into_iter()
            .take(TRIES)
            .any(|edit| self.attempt(&edit))
    }

    /// Changes that may help, the gentlest first.
    fn edits(&self, fault: [u32; 2]) -> Vec<Edit> {
        let mut corners: Vec<u32> = fault
            .iter()
            .filter_map(|t| self.triangles[*t as usize])
            .flatten()
            .collect();
        corners.sort_unstable_by_key(|v| (self.given[*v as usize], *v));
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

    /// Two vertices put in one place, the nearest pairs first.
    fn merges(&self, corners: &[u32]) -> Vec<Edit> {
        let place = |v: u32| &self.vertices[v as usize];
        let mut pairs: Vec<(f64, u32, u32)> = Vec::new();
        for (k, &v) in corners.iter().enumerate() {
            for &w in &corners[..k] {
                let gap = distance(place(v), place(w));
                if gap <= self.reach() {
                    let stays = self.given[v as usize] && !self.given[w as usize];
                    let (from, to) = if stays { (w, v) } else { (v, w) };
                    pairs.extend([(gap, from, to), (gap, to, from)]);
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let near = |p: &&(f64, u32, u32)| self.drift(p.1, place(p.2)) <= self.reach();
        let free = pairs.iter().filter(|p| !self.fixed[p.1 as usize]);
        free.filter(near)
            .filter_map(|&(_, from, to)| self.merge(from, to))
            .collect()
    }

    /// One vertex goes where another is. Triangles that have both vanish, and so do such as then are
    /// each other's opposites. `None` if the surface would not stay closed.
    fn merge(&self, from: u32, to: u32) -> Option<Edit> {
        let star = self.star(from);
        let renamed = |t: [u32; 3]| t.map(|v| if v == from { to } else { v });
        let mut made: Vec<(u32, Option<[u32; 3]>)> = star
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
        let mut ends: Vec<[u32; 2]> = left().flat_map(|t| edges(&t)).collect();
        ends.sort_unstable();
        if ends.windows(2).any(|pair| pair[0] == pair[1]) {
            return None;
        }
        let mut edit = Edit {
            triangles: made,
            drift: Some((to, self.drift(from, &self.vertices[to as usize]))),
            ..Edit::default()
        };
        self.part_fans(&mut edit, to)?;
        Some(edit)
    }

    /// Gives each closed fan around vertices whose triangles were removed a vertex of its own.
    fn part_fans(&self, edit: &mut Edit, to: u32) -> Option<()> {
        let gone = edit.triangles.iter().filter(|m| m.1.is_none());
        let mut loose: Vec<u32> = gone
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
            if self.fixed[v as usize] && !self.is_whole(v) {
                continue;
            }
            for fan in fans(v, around)?.into_iter().skip(1) {
                let copy = (self.vertices.len() + edit.copies.len()) as u32;
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

    /// Whether all triangles around a vertex are in this part.
    fn is_whole(&self, v: u32) -> bool {
        self.star(v).iter().all(|t| {
            let corners = self.triangles[*t as usize].unwrap_or_default();
            edges(&corners)
                .iter()
                .filter(|e| e.contains(&v))
                .all(|[a, b]| self.halves.contains_key(&[*b, *a]))
        })
    }

    /// The other diagonal of the two triangles at an edge, where both are nearly in one place.
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
        let [p, q, r, s] = [a, b, c, d].map(|v| &self.vertices[v as usize]);
        if c == d || taken || !diagonals_meet([p, q, r, s], self.reach()) {
            return None;
        }
        Some(Edit {
            triangles: vec![(t, Some([a, d, c])), (mate, Some([d, b, c]))],
            ..Edit::default()
        })
    }

    /// A vertex a spacing aside.
    fn moves(&self, v: u32) -> Vec<Edit> {
        if self.fixed[v as usize] {
            return Vec::new();
        }
        let place = self.vertices[v as usize];
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

    /// How far a vertex, or one that was merged with it, is from where it came when it is here.
    fn drift(&self, v: u32, place: &Point) -> f64 {
        self.drifts[v as usize] + distance(&self.vertices[v as usize], place)
    }

    fn reach(&self) -> f64 {
        FARTHEST * self.spacing
    }

    fn star(&self, v: u32) -> Vec<u32> {
        let has = |t: &Option<[u32; 3]>| t.is_some_and(|t| t.contains(&v));
        let triangles = self.triangles.iter().enumerate();
        triangles
            .filter(|(_, t)| has(t))
            .map(|(t, _)| t as u32)
            .collect()
    }

    /// Makes a change if it leaves fewer faults.
    fn attempt(&mut self, edit: &Edit) -> bool {
        spend(1 + self.triangles.len() / 16);
        self.work = self.work.saturating_sub(self.triangles.len());
        let moved = edit.moves.iter().flat_map(|m| self.star(m.0));
        let mut touched: Vec<u32> = edit.triangles.iter().map(|m| m.0).chain(moved).collect();
        touched.sort_unstable();
        touched.dedup();
        let is_touched = |t: &u32| touched.binary_search(t).is_ok();
        let old_crossings: Vec<[u32; 2]> = self
            .crossings
            .iter()
            .filter(|pair| pair.iter().any(is_touched))
            .copied()
            .collect();
        let old_flat: Vec<u32> = self.flat.iter().copied().filter(is_touched).collect();
        let undo = self.apply(edit);
        let most = old_crossings.len() + old_flat.len();
        if let Some((crossings, flat)) = self.faults_of(&touched, most) {
            for pair in &old_crossings {
                self.crossings.remove(pair);
            }
            for t in &old_flat {
                self.flat.remove(t);
            }
            self.crossings.extend(crossings);
            self.flat.extend(flat);
            for (v, old) in &undo.moves {
                self.moved.insert(*v);
                self.drifts[*v as usize] += distance(old, &self.vertices[*v as usize]);
            }
            if let Some((v, drift)) = edit.drift {
                self.drifts[v as usize] = self.drifts[v as usize].max(drift);
            }
            return true;
        }
        self.revert(edit, &undo);
        false
    }

    /// Carries a change out; returns the change back.
    fn apply(&mut self, edit: &Edit) -> Edit {
        let mut undo = Edit::default();
        for &v in &edit.copies {
            self.vertices.push(self.vertices[v as usize]);
            self.fixed.push(self.fixed[v as usize]);
            self.given.push(self.given[v as usize]);
            self.drifts.push(self.drifts[v as usize]);
        }
        for &(v, place) in &edit.moves {
            undo.moves.push((v, self.vertices[v as usize]));
            self.vertices[v as usize] = place;
        }
        self.exchange(&edit.triangles, &mut undo);
        let moved: Vec<u32> = edit.moves.iter().flat_map(|m| self.star(m.0)).collect();
        for t in moved {
            self.measure(t);
        }
        undo
    }

    fn revert(&mut self, edit: &Edit, undo: &Edit) {
        let mut nothing = Edit::default();
        for &(v, place) in undo.moves.iter().rev() {
            self.vertices[v as usize] = place;
        }
        self.exchange(&undo.triangles, &mut nothing);
        let moved: Vec<u32> = edit.moves.iter().flat_map(|m| self.star(m.0)).collect();
        for t in moved {
            self.measure(t);
        }
        let count = self.vertices.len() - edit.copies.len();
        self.vertices.truncate(count);
        self.fixed.truncate(count);
        self.given.truncate(count);
        self.drifts.truncate(count);
    }

    fn exchange(&mut self, triangles: &[(u32, Option<[u32; 3]>)], undo: &mut Edit) {
        for (t, _) in triangles {
            let old = self.triangles[*t as usize].take();
            undo.triangles.push((*t, old));
            for edge in old.iter().flat_map(edges) {
                self.halves.remove(&edge);
            }
        }
        for &(t, corners) in triangles {
            self.triangles[t as usize] = corners;
            for edge in corners.iter().flat_map(edges) {
                self.halves.insert(edge, t);
            }
            self.measure(t);
        }
    }

    fn measure(&mut self, t: u32) {
        if let Some(corners) = self.corners(t) {
            self.extents[t as usize] = Extent::of(&corners);
        }
    }

    fn corners(&self, t: u32) -> Option<Triangle> {
        let corners = self.triangles[t as usize]?;
        Some(corners.map(|v| self.vertices[v as usize]))
    }

    /// The faults of some triangles, ascending, if they are fewer than a number.
    fn faults_of(&mut self, some: &[u32], most: usize) -> Option<(Vec<[u32; 2]>, Vec<u32>)> {
        let left = some.iter().copied().filter(|t| self.corners(*t).is_some());
        let area = |t: &u32| self.corners(*t).is_some_and(|c| !has_no_area(&c));
        let (solid, flat): (Vec<u32>, Vec<u32>) = left.partition(area);
        let mut crossings = Vec::new();
        if flat.len() >= most {
            return None;
        }
        for t in solid {
            self.work = self.work.saturating_sub(self.triangles.len());
            for u in 0..self.triangles.len() as u32 {
                let first = u > t || some.binary_search(&u).is_err();
                let near =
                    first && u != t && !self.extents[t as usize].misses(&self.extents[u as usize]);
                if near && self.cross(t, u, &flat) {
                    crossings.push([t.min(u), t.max(u)]);
                    if crossings.len() + flat.len() >= most {
                        return None;
                    }
                }
            }
        }
        Some((crossings, flat))
    }

    fn cross(&self, t: u32, u: u32, flat: &[u32]) -> bool {
        let pair = [t.min(u), t.max(u)];
        let is_flat = |t: &u32| self.flat.contains(t) || flat.contains(t);
        let (Some(p), Some(q)) = (self.corners(pair[0]), self.corners(pair[1])) else {
            return false;
        };
        if is_flat(&u) && has_no_area(if u == pair[0] { &p } else { &q }) {
            return false;
        }
        let met = meeting(&p, &q);
        if let Meeting::Edges(i, j) = met {
            if self.ends(pair[0], i) == self.ends(pair[1], j).map(|[a, b]| [b, a]) {
                return false;
            }
        }
        let mate = |which: usize, edge: usize| {
            let [a, b] = self.ends(pair[which], edge)?;
            let mate = self.triangles[*self.halves.get(&[b, a])? as usize]?;
            let apex = mate.iter().find(|v| **v != a && **v != b)?;
            Some(self.vertices[*apex as usize])
        };
        crosses_at(met, &[p, q], mate)
    }

    fn ends(&self, t: u32, edge: usize) -> Option<[u32; 2]> {
        let corners = self.triangles[t as usize]?;
        Some([corners[edge], corners[(edge + 1) % 3]])
    }
}

fn edges(corners: &[u32; 3]) -> [[u32; 2]; 3] {
    [0, 1, 2].map(|i| [corners[i], corners[(i + 1) % 3]])
}

fn has_three([a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// Removes pairs of triangles that are each other's opposites.
fn cancel_opposites(made: &mut [(u32, Option<[u32; 3]>)]) {
    let from_least = |t: [u32; 3]| {
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

/// A triangle with its number.
type Numbered = (u32, [u32; 3]);

/// The triangles around a vertex as closed fans, that of the first triangle first; `None` if one is
/// open.
fn fans(v: u32, around: Vec<Numbered>) -> Option<Vec<Vec<Numbered>>> {
    let turned = |t: &[u32; 3]| {
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

/// Whether the diagonals of the triangles a b c and b a d pass each other within a distance.
///
/// Seen along the axis that both face most, none of the triangles turns over with the other
/// diagonal, exactly; so the diagonals cross there, and how far apart they are is a quotient.
fn diagonals_meet(corners: [&Point; 4], reach: f64) -> bool {
    let [a, b, c, d] = corners.map(|p| *p);
    let (first, second) = (area(&[a, b, c]), area(&[b, a, d]));
    let both = [0, 1, 2].map(|i| first[i] + second[i]);
    let axis = (1..3).fold(0, |m, i| if both[i].abs() > both[m].abs() { i } else { m });
    let facing = if both[axis] > 0.0 { 1 } else { -1 };
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

/// Twice the area of a triangle along each axis.
fn area([a, b, c]: &Triangle) -> Point {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j])
    })
}

fn distance(p: &Point, q: &Point) -> f64 {
    let square = |i: usize| (p[i] - q[i]) * (p[i] - q[i]);
    (square(0) + square(1) + square(2)).sqrt()
}
