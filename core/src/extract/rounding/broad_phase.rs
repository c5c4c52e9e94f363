//! Finds the triangles of a mesh near enough to others to meet them, with a coarse grid.

use std::sync::atomic::{AtomicU32, Ordering};

use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::Point;
use crate::mesh::faces::Faces;
use crate::mesh::handle::VertexId;
use crate::mesh::tasks::{each_chunk, fill_chunks};

/// The largest number of cells along an axis: the grid then fits into a cache, and a cell's number into 16
/// bits.
const MAX_CELLS_PER_AXIS: usize = 32;

/// The largest average number of cells per triangle: if triangles reach into more cells, comparing a triangle
/// with its neighbours costs no more than marking its cells. A grid of four cells along each axis has no more
/// cells than this.
const MAX_CELLS_PER_TRIANGLE: usize = 64;

/// Returns the triangles outside the ascending list `some` that may meet a triangle of `some` or a triangle
/// with another party number; each with its own party number, ascending. Triangles with equal party numbers
/// are known not to cross.
///
/// # Cost
/// Two passes over vertices and triangles.
pub fn triangles_near(
    faces: &Faces,
    some: &[u32],
    party: impl Fn(u32) -> u32 + Sync,
) -> Vec<(u32, u32)> {
    if some.len() == faces.triangles.len() {
        return Vec::new();
    }
    let mut cells = Cells::of(faces);
    let marks = loop {
        if let Some(marks) = cells.marks(some, &party) {
            break marks;
        }
        cells.double();
    };
    let mut some = some.iter().peekable();
    let mut near = cells.shared(&marks);
    near.retain(|t| {
        while some.next_if(|s| *s < t).is_some() {}
        some.next_if_eq(&t).is_none()
    });
    let mut near: Vec<(u32, u32)> = near.into_iter().map(|t| (party(t), t)).collect();
    near.sort_unstable();
    near
}

/// The number of a cell of the grid: its indices along the three axes, in equally many bits each.
type Cell = u16;

/// A grid around a mesh, and the cell of each vertex.
struct Cells<'a> {
    triangles: &'a [[VertexId; 3]],
    of_vertices: Vec<Cell>,
    /// The binary logarithm of the number of cells along an axis.
    bits: u32,
}

/// The mark of a grid cell that triangles with different party numbers, or a triangle of `some`, reach into;
/// triangles with equal party numbers are known not to cross.
const SHARED: u32 = u32::MAX;

/// For each grid cell one plus the party number of the triangles that reach into it, or 0 if none do.
/// Triangles with equal party numbers are known not to cross.
type CellParties = Vec<AtomicU32>;

impl<'a> Cells<'a> {
    /// Makes a grid around a mesh and finds the cell of each vertex.
    fn of(faces: &Faces<'a>) -> Self {
        let first = faces.vertices.first().copied().unwrap_or_default();
        let end = |extreme: fn(f64, f64) -> f64| {
            let joined = |a: Point, b: &Point| each_axis(|i| extreme(a[i], b[i]));
            faces.vertices.iter().fold(first, joined)
        };
        let (low, high) = (end(f64::min), end(f64::max));
        let size = (faces.triangles.len() / 24)
            .isqrt()
            .clamp(2, MAX_CELLS_PER_AXIS);
        let bits = size.next_power_of_two().ilog2();
        let along = as_double(1usize << bits);
        let factor = each_axis(|i| along / (high[i] - low[i]).max(f64::MIN_POSITIVE));
        let mut cells = vec![0; faces.vertices.len()];
        fill_chunks(faces.vertices, &mut cells, |_, places, cells| {
            for (place, cell) in places.iter().zip(cells) {
                let at = each_axis(|i| along_axis((place[i] - low[i]) * factor[i], bits));
                *cell = number(at, bits);
            }
        });
        Self {
            triangles: faces.triangles,
            of_vertices: cells,
            bits,
        }
    }

    /// Doubles the edge of all cells: merges them in pairs along each axis.
    fn double(&mut self) {
        let bits = self.bits - 1;
        let doubled = |cell| number(self.place(cell).map(|k| k >> 1), bits);
        self.of_vertices = self.of_vertices.iter().map(|cell| doubled(*cell)).collect();
        self.bits = bits;
    }

    /// The index of a cell along each axis.
    #[inline]
    fn place(&self, cell: Cell) -> [Cell; 3] {
        [2, 1, 0].map(|above| cell >> (above * self.bits) & ((1 << self.bits) - 1))
    }

    /// Returns true if two cells, of which `low` has the lower number, have a common face.
    #[inline]
    fn are_beside(&self, low: Cell, high: Cell) -> bool {
        let along = |above: u32| {
            let shift = above * self.bits;
            high - low == 1 << shift && (low ^ high) >> shift < 1 << self.bits
        };
        along(0) || along(1) || along(2)
    }

    /// Marks the cells of all triangles; `None` if they reach into too many cells.
    fn marks(&self, some: &[u32], party: impl Fn(u32) -> u32 + Sync) -> Option<CellParties> {
        let mut marks = Vec::new();
        marks.resize_with(1 << (3 * self.bits), AtomicU32::default);
        let marked = each_chunk(self.triangles, |first, triangles| {
            let numbered = (as_number(first)..).zip(triangles);
            let parties = numbered.map(|(t, corners)| (*corners, party(t) + 1));
            self.mark(&marks, parties, triangles.len())
        });
        let shared = some.iter().map(|t| (self.triangles[*t as usize], SHARED));
        let all = marked.into_iter().all(|done| done);
        (all && self.mark(&marks, shared, some.len())).then_some(marks)
    }

    /// Marks the cells of `count` triangles; returns false if they reach into too many cells.
    fn mark(
        &self,
        marks: &CellParties,
        parties: impl Iterator<Item = ([VertexId; 3], u32)>,
        count: usize,
    ) -> bool {
        let mut left = MAX_CELLS_PER_TRIANGLE * count;
        for (corners, party) in parties {
            let mut reached = 0;
            self.any_row(marks, corners, |row| {
                reached += row.len();
                for mark in row {
                    join(mark, party);
                }
                false
            });
            if reached > left {
                return false;
            }
            left -= reached;
        }
        true
    }

    /// Returns the triangles that reach into a cell marked `SHARED`, ascending.
    fn shared(&self, marks: &CellParties) -> Vec<u32> {
        let is_shared = |mark: &AtomicU32| mark.load(Ordering::Relaxed) == SHARED;
        let near = each_chunk(self.triangles, |first, triangles| {
            let numbered = (as_number(first)..).zip(triangles);
            let near = numbered.filter(|(_, corners)| {
                self.any_row(marks, **corners, |row| row.iter().any(is_shared))
            });
            near.map(|(t, _)| t).collect::<Vec<u32>>()
        });
        near.concat()
    }

    /// Returns true if `holds` is true for at least one row of cells along the last axis into which a
    /// triangle may reach.
    #[inline]
    fn any_row(
        &self,
        marks: &[AtomicU32],
        corners: [VertexId; 3],
        mut holds: impl FnMut(&[AtomicU32]) -> bool,
    ) -> bool {
        let cells @ [a, b, c] = corners.map(|v| self.of_vertices[v.index()]);
        if a == b && b == c {
            return holds(&marks[usize::from(a)..=usize::from(a)]);
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        if (a == b || b == c || c == a) && self.are_beside(low, high) {
            let mut holds = |cell: Cell| holds(&marks[usize::from(cell)..=usize::from(cell)]);
            return holds(low) || holds(high);
        }
        let places = cells.map(|cell| self.place(cell));
        let [x, y, z] = each_axis(|i| {
            let [a, b, c] = places.map(|place| usize::from(place[i]));
            (a.min(b).min(c), a.max(b).max(c))
        });
        for x in x.0..=x.1 {
            for y in y.0..=y.1 {
                let row = (x << self.bits | y) << self.bits;
                if holds(&marks[row + z.0..=row + z.1]) {
                    return true;
                }
            }
        }
        false
    }
}

fn number([x, y, z]: [Cell; 3], bits: u32) -> Cell {
    (x << bits | y) << bits | z
}

/// The index of the cell at a position along an axis, which is given in cells.
#[allow(
    clippy::cast_sign_loss,
    clippy::cast_possible_truncation,
    reason = "no place is below the lowest, and the last cell takes what lies beyond"
)]
fn along_axis(place: f64, bits: u32) -> Cell {
    (place as Cell).min((1 << bits) - 1)
}

/// Marks a grid cell with the party number of a triangle, or as `SHARED` if the cell has another. The order
/// of calls does not matter.
#[inline]
fn join(mark: &AtomicU32, party: u32) {
    let mut old = mark.load(Ordering::Relaxed);
    while old != party && old != SHARED {
        let joint = if old == 0 { party } else { SHARED };
        match mark.compare_exchange_weak(old, joint, Ordering::Relaxed, Ordering::Relaxed) {
            Ok(_) => return,
            Err(now) => old = now,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::doubles::extent::Extent;

    /// Small triangles at pseudorandom positions in a cube.
    fn scattered(count: u32) -> (Vec<Point>, Vec<[VertexId; 3]>) {
        let next = |x: &u32| Some(x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
        let mut numbers = std::iter::successors(Some(7), next).map(|x| f64::from(x >> 8) / 2e7);
        let mut number = || numbers.next().unwrap_or(0.0);
        let mut vertices = Vec::new();
        for _ in 0..count {
            let place = [number(), number(), number()];
            for _ in 0..3 {
                vertices.push(place.map(|x| x + 0.05 * number()));
            }
        }
        let triangles = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        (vertices, VertexId::rows(triangles))
    }

    /// Long thin triangles side by side along a diagonal of a cube's face.
    fn needles(count: u32) -> (Vec<Point>, Vec<[VertexId; 3]>) {
        let needle = |k: u32| {
            let [low, high] = [k, k + 1].map(|k| f64::from(k) / f64::from(count));
            [[0.0, 0.0, low], [1.0, 1.0, low], [0.0, 0.0, high]]
        };
        let triangles = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        (
            (0..count).flat_map(needle).collect(),
            VertexId::rows(triangles),
        )
    }

    #[test]
    fn needles_are_marked_in_few_cells_each() {
        let (vertices, triangles) = needles(20_000);
        let faces = Faces {
            vertices: &vertices,
            triangles: &triangles,
        };
        assert!(Cells::of(&faces).marks(&[0], |_| 0).is_none());
        let found = triangles_near(&faces, &[0], |_| 0);
        assert!(found.contains(&(0, 1)) && found.len() < triangles.len() - 1);
    }

    #[test]
    fn all_that_may_meet_are_found() {
        for count in [30, 300, 1500] {
            let (vertices, triangles) = scattered(count);
            let faces = Faces {
                vertices: &vertices,
                triangles: &triangles,
            };
            let party = |t: u32| u32::from(faces.corners(t)[0][0] < 0.4);
            let some: Vec<u32> = (0..count)
                .filter(|t| faces.corners(*t)[0][1] > 0.75)
                .collect();
            let found = triangles_near(&faces, &some, party);
            assert!(found.is_sorted());
            assert!(found.iter().all(|(p, t)| party(*t) == *p));
            let is_some = |t: u32| some.binary_search(&t).is_ok();
            let meet = |t: u32, u: u32| {
                let [t, u] = [t, u].map(|t| Extent::of(&faces.corners(t)));
                !t.misses(&u)
            };
            let others = (0..count).filter(|t| !is_some(*t));
            for t in others.clone() {
                let asked = |u: &u32| is_some(*u) || party(*u) != party(t);
                let is_near = (0..count).filter(asked).any(|u| meet(t, u));
                assert!(!is_near || found.contains(&(party(t), t)), "{t}");
            }
            assert!(found.iter().all(|(_, t)| !is_some(*t)));
            assert!(count < 1000 || found.len() < others.count());
        }
    }
}
