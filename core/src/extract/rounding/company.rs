//! The triangles of a mesh that lie so near others that the two may meet, by a coarse grid.

use std::ops::Range;

use crate::arith::convert::{as_double, as_number};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::Point;
use crate::mesh::faces::Faces;
use crate::mesh::tasks::{each, fill_chunks, Worth, CHUNK};

/// The most cells along an axis: the grid then fits into a cache, and the number of a cell into
/// sixteen bits.
const FINEST: usize = 32;

/// So few triangles are compared all with all: telling them apart costs as much.
const FEW: usize = 256;

/// The number of triangles asked about for each other one from which all others are compared: telling
/// which are near costs more than it saves.
const MOST: usize = 4;

/// The most cells that a triangle is marked in, on average: comparing it with its neighbours costs as
/// much. A grid of four cells along an axis has no more.
const SPREAD: usize = 64;

/// Triangles that one thread looks through: a millisecond of work, above what marks of its own cost.
const SHARE: usize = CHUNK;

/// The triangles that are not among some, ascending, but may meet one of them or a triangle of
/// another party; with their parties, ascending.
///
/// # Cost
/// Two passes over vertices and triangles.
pub fn in_company(
    faces: &Faces,
    some: &[u32],
    party: impl Fn(u32) -> u32 + Sync + Send,
) -> Vec<(u32, u32)> {
    let count = faces.triangles.len();
    if some.len() == count {
        return Vec::new();
    }
    let others = Others { some, count };
    let mut near: Vec<(u32, u32)> = if count <= FEW || MOST * (count - some.len()) <= some.len() {
        others.each().map(|t| (party(t), t)).collect()
    } else {
        others.near(faces, &party)
    };
    near.sort_unstable();
    near
}

/// All triangles but some, ascending.
#[derive(Clone, Copy)]
struct Others<'a> {
    some: &'a [u32],
    count: usize,
}

impl<'a> Others<'a> {
    fn each(self) -> impl Iterator<Item = u32> + 'a {
        self.within(0..as_number(self.count))
    }

    /// Those in a range, ascending.
    fn within(self, range: Range<u32>) -> impl Iterator<Item = u32> + 'a {
        let place = |t: u32| self.some.partition_point(|s| *s < t);
        let some = &self.some[place(range.start)..place(range.end)];
        let mut next = range.start;
        some.iter()
            .copied()
            .chain([range.end])
            .flat_map(move |end| {
                let between = next..end;
                next = end + 1;
                between
            })
    }

    /// The triangles in shares, each of which one thread looks through.
    fn shares(self) -> Vec<Range<u32>> {
        let starts = (0..self.count).step_by(SHARE);
        let share = |start: usize| as_number(start)..as_number(self.count.min(start + SHARE));
        starts.map(share).collect()
    }

    /// Those in a cell with one that is left out, or with one of another party.
    fn near(self, faces: &Faces, party: impl Fn(u32) -> u32 + Sync + Send) -> Vec<(u32, u32)> {
        let Some(mut grid) = Grid::around(faces) else {
            return Vec::new();
        };
        loop {
            let places = Places::of(faces, grid);
            if let Some(marks) = self.marks(&places, &party) {
                let near = each(Worth::Task, self.shares(), |share| {
                    let shared = |t: &u32| marks.is_shared(places.corners(*t));
                    let near = self.within(share).filter(shared);
                    near.map(|t| (party(t), t)).collect::<Vec<_>>()
                });
                return near.concat();
            }
            grid = grid.coarser();
        }
    }

    /// The marks of all triangles; `None` if they reach into more cells than are worth marking.
    fn marks(self, places: &Places, party: impl Fn(u32) -> u32 + Sync + Send) -> Option<Marks> {
        let marked = each(Worth::Task, self.shares(), |share| {
            let mut marks = places.grid.marks(share.len());
            let mark = |t: u32| marks.mark(places.corners(t), party(t) + 1);
            self.within(share).try_for_each(mark).map(|()| marks)
        });
        let mut all = places.grid.marks(self.some.len());
        for marks in marked {
            all = all.joined(marks?);
        }
        let mut some = self.some.iter();
        some.try_for_each(|t| all.mark(places.corners(*t), SHARED))?;
        Some(all)
    }
}

/// The cells of a grid in which the corners of triangles lie.
struct Places<'a> {
    faces: &'a Faces<'a>,
    grid: Grid,
    /// Of the vertices.
    cells: Vec<Cell>,
}

impl<'a> Places<'a> {
    fn of(faces: &'a Faces, grid: Grid) -> Self {
        let mut cells = vec![0; faces.vertices.len()];
        fill_chunks(faces.vertices, &mut cells, |_, places, cells| {
            for (place, cell) in places.iter().zip(cells) {
                *cell = grid.cell(place);
            }
        });
        Self { faces, grid, cells }
    }

    fn corners(&self, triangle: u32) -> [Cell; 3] {
        self.faces.triangles[triangle as usize].map(|v| self.cells[v.place()])
    }
}

/// The mark of cells with triangles of several parties, or with one of those that are asked about.
const SHARED: u32 = u32::MAX;

/// Cells over a mesh, each with the party whose triangles it holds, from 1 on.
struct Marks {
    grid: Grid,
    of_cells: Vec<u32>,
    /// So many more may be set, about.
    left: usize,
}

impl Marks {
    /// The marks of the triangles of both.
    fn joined(mut self, other: Self) -> Self {
        for (mark, party) in self.of_cells.iter_mut().zip(other.of_cells) {
            *mark = joint(*mark, party);
        }
        self
    }

    /// Marks the cells that a triangle may meet; `None` if these are more than may be set.
    fn mark(&mut self, corners: [Cell; 3], party: u32) -> Option<()> {
        let of_cells = &mut self.of_cells;
        let [a, b, c] = corners;
        if a == b && b == c {
            let mark = &mut of_cells[usize::from(a)];
            *mark = joint(*mark, party);
            return Some(());
        }
        let mut set = 0;
        self.grid.visit(corners, |cell| {
            of_cells[cell] = joint(of_cells[cell], party);
            set += 1;
            true
        });
        self.left = self.left.checked_sub(set)?;
        Some(())
    }

    fn is_shared(&self, corners: [Cell; 3]) -> bool {
        let mut shared = false;
        self.grid.visit(corners, |cell| {
            shared = self.of_cells[cell] == SHARED;
            !shared
        });
        shared
    }
}

/// The mark of a cell with what two marks tell of.
#[inline]
const fn joint(one: u32, other: u32) -> u32 {
    if one == other || other == 0 {
        one
    } else if one == 0 {
        other
    } else {
        SHARED
    }
}

/// Equal cells over a mesh.
#[derive(Clone, Copy)]
struct Grid {
    low: Point,
    factor: Point,
    /// Bits of the number of cells along an axis.
    bits: u32,
}

/// The number of a cell of the grid, so many bits for each axis.
type Cell = u16;

impl Grid {
    fn around(faces: &Faces) -> Option<Self> {
        let first = *faces.vertices.first()?;
        let (mut low, mut high) = (first, first);
        for p in faces.vertices {
            for i in 0..3 {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
            }
        }
        let size = (faces.triangles.len() / 24).isqrt().clamp(2, FINEST);
        let bits = size.next_power_of_two().ilog2();
        let factor =
            |i: usize| as_double(1usize << bits) / (high[i] - low[i]).max(f64::MIN_POSITIVE);
        Some(Self {
            low,
            factor: each_axis(factor),
            bits,
        })
    }

    /// The same with half as many cells along each axis.
    fn coarser(mut self) -> Self {
        self.bits -= 1;
        self.factor = self.factor.map(|x| x / 2.0);
        self
    }

    /// A mark for each cell, none set, for so many triangles.
    fn marks(self, triangles: usize) -> Marks {
        Marks {
            grid: self,
            of_cells: vec![0; 1 << (3 * self.bits)],
            left: SPREAD * triangles,
        }
    }

    #[allow(
        clippy::cast_sign_loss,
        clippy::cast_possible_truncation,
        reason = "no place is below the lowest, and none beyond the size"
    )]
    fn cell(self, p: &Point) -> Cell {
        let last = (1 << self.bits) - 1;
        let place = |i: usize| (((p[i] - self.low[i]) * self.factor[i]) as Cell).min(last);
        self.number([place(0), place(1), place(2)])
    }

    fn number(self, [x, y, z]: [Cell; 3]) -> Cell {
        (x << self.bits | y) << self.bits | z
    }

    /// Call a function with each cell that a triangle may meet, until it says no.
    #[inline]
    fn visit(self, corners: [Cell; 3], mut visit: impl FnMut(usize) -> bool) {
        let [a, b, c] = corners;
        if a == b && b == c {
            visit(usize::from(a));
            return;
        }
        let last = (1 << self.bits) - 1;
        let [x, y, z] = [2, 1, 0].map(|above| {
            let [a, b, c] = corners.map(|cell| cell >> (above * self.bits) & last);
            a.min(b).min(c)..=a.max(b).max(c)
        });
        for (x, y) in x.flat_map(|x| y.clone().map(move |y| (x, y))) {
            for z in z.clone() {
                if !visit(usize::from(self.number([x, y, z]))) {
                    return;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::doubles::extent::Extent;
    use crate::mesh::handle::VertexId;

    /// Small triangles in a cube, their places taken from numbers that look random.
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

    /// Needles across a cube, side by side.
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
        let others = Others {
            some: &[0],
            count: triangles.len(),
        };
        let grid = Grid::around(&faces).expect("vertices");
        assert!(others.marks(&Places::of(&faces, grid), |_| 0).is_none());
        let company = in_company(&faces, &[0], |_| 0);
        assert!(company.contains(&(0, 1)) && company.len() < others.count);
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
            let company = in_company(&faces, &some, party);
            assert!(company.is_sorted());
            assert!(company.iter().all(|(p, t)| party(*t) == *p));
            let is_some = |t: u32| some.binary_search(&t).is_ok();
            let meet = |t: u32, u: u32| {
                let [t, u] = [t, u].map(|t| Extent::of(&faces.corners(t)));
                !t.misses(&u)
            };
            let others = (0..count).filter(|t| !is_some(*t));
            for t in others.clone() {
                let asked = |u: &u32| is_some(*u) || party(*u) != party(t);
                let is_near = (0..count).filter(asked).any(|u| meet(t, u));
                assert!(!is_near || company.contains(&(party(t), t)), "{t}");
            }
            assert!(company.iter().all(|(_, t)| !is_some(*t)));
            assert!(count < 1000 || company.len() < others.count());
        }
    }
}
