//! A coarse grid that marks the cells into which a mesh's faces reach: faces of two meshes can meet only in
//! cells that both meshes mark.

use super::boxes::RoundedBox;
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::{Point, Triangle};
use crate::interrupt::poll;

/// The most cells of the grid along each axis: a row of cells is one 64-bit word.
const MAX_CELLS_PER_AXIS: usize = 64;

/// The least number of cells along each axis: fewer would hardly exclude any face.
const MIN_CELLS_PER_AXIS: usize = 8;

/// The most rows of cells to mark, on average for each face of both meshes: a row costs up to two hundred
/// instructions, and a face excluded from the search for pairs saves a thousand.
const MAX_ROWS_PER_FACE: usize = 8;

/// A face whose box extends over more cells than this on all axes marks only cells that its plane may meet.
const MAX_CELLS_UNCLIPPED: usize = 2;

/// A grid over a window that marks the cells into which a mesh's faces may reach.
#[derive(Debug)]
pub(super) struct Occupancy {
    /// The number of cells along each axis.
    cells: usize,
    low: Point,
    /// The number of cells per lattice step on each axis.
    scale: Point,
    /// For each row of cells along the first axis, one bit for each cell; empty if all cells count as marked.
    rows: Vec<u64>,
}

/// The indices of the first and the last cell on each axis.
type Cells = [[usize; 2]; 3];

/// The plane of a face, by one corner and a normal in doubles.
struct Plane {
    corner: Point,
    normal: Point,
    /// A bound on the error of normal · (point − corner) for points of the window.
    error: f64,
}

impl Occupancy {
    /// Marks the cells that faces with these boxes may reach into; `faces` is the number of faces of both
    /// meshes, which the work must suit.
    pub(super) fn of(
        window: &[Point; 2],
        boxes: &[RoundedBox],
        triangle: impl Fn(usize) -> Triangle,
        faces: usize,
    ) -> Self {
        let mut budget = MAX_ROWS_PER_FACE * faces;
        let mut made = Self::new(window, faces);
        for (i, bounds) in boxes.iter().enumerate() {
            let around = made.cells(bounds);
            let count = |axis: usize| around[axis][1] - around[axis][0] + 1;
            let rows = count(1) * count(2);
            if rows > budget || made.rows.is_empty() {
                made.rows.clear();
                return made;
            }
            budget -= rows;
            let is_large = (0..3).all(|axis| count(axis) > MAX_CELLS_UNCLIPPED);
            let plane = is_large.then(|| Plane::of(&triangle(i), window));
            made.mark(&around, plane.as_ref());
        }
        made
    }

    /// Makes an empty grid; with more faces it has more cells, because a large face may reach into all rows.
    fn new(window: &[Point; 2], faces: usize) -> Self {
        let mut cells = MAX_CELLS_PER_AXIS;
        while cells >= MIN_CELLS_PER_AXIS && 2 * cells * cells > faces {
            cells /= 2;
        }
        let rows = if cells < MIN_CELLS_PER_AXIS {
            0
        } else {
            cells * cells
        };
        #[allow(clippy::cast_precision_loss, reason = "a power of two")]
        let scale = |i: usize| cells as f64 / (window[1][i] - window[0][i]).max(1.0);
        Self {
            cells,
            low: window[0],
            scale: each_axis(scale),
            rows: vec![0; rows],
        }
    }

    /// Marks the cells from the first to the last of `around`; if a plane is given, only those that it may
    /// meet.
    fn mark(&mut self, around: &Cells, plane: Option<&Plane>) {
        poll();
        let [x, y, z] = *around;
        for k in z[0]..=z[1] {
            for j in y[0]..=y[1] {
                let met = plane
                    .as_ref()
                    .map_or(Some(x), |plane| self.cells_met_in_row(plane, x, [j, k]));
                if let Some(met) = met {
                    self.rows[self.cells * k + j] |= mask(met);
                }
            }
        }
    }

    /// Returns the first and the last cell of a row that a plane may meet, between `first` and `last`; `None`
    /// if it meets none. The plane meets a cell only if the cell's centre is no farther from it than a corner
    /// is from the centre, along the normal.
    fn cells_met_in_row(
        &self,
        plane: &Plane,
        [first, last]: [usize; 2],
        [j, k]: [usize; 2],
    ) -> Option<[usize; 2]> {
        #[allow(clippy::cast_precision_loss, reason = "a small number")]
        let middle = |cell: usize, i: usize| {
            self.low[i] + (cell as f64 + 0.5) / self.scale[i] - plane.corner[i]
        };
        let n = &plane.normal;
        let value = n[1] * middle(j, 1) + n[2] * middle(k, 2);
        let reach: f64 = (0..3).map(|i| n[i].abs() * 0.5 / self.scale[i]).sum();
        let reach = reach + plane.error;
        if n[0] == 0.0 {
            return (value.abs() <= reach).then_some([first, last]);
        }
        let at = |value: f64| (value / n[0] - middle(0, 0)) * self.scale[0];
        let ends = [at(-value - reach), at(-value + reach)];
        let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        // One cell is added on each side, because division may round across a cell's border.
        let (low, high) = (
            self.clamped(low - 1.0).max(first),
            self.clamped(high + 2.0).min(last),
        );
        (low <= high).then_some([low, high])
    }

    /// Returns true if a box may reach into a marked cell (a cell that the mesh's faces may reach into).
    pub(super) fn meets(&self, bounds: &RoundedBox) -> bool {
        if self.rows.is_empty() {
            return true;
        }
        let [x, y, z] = self.cells(bounds);
        let bits = mask(x);
        (z[0]..=z[1]).any(|k| {
            let row = self.cells * k;
            let mut rows = self.rows[row + y[0]..=row + y[1]].iter();
            rows.any(|r| r & bits != 0)
        })
    }

    /// Returns the first and the last cell that a box reaches into on each axis.
    ///
    /// All numbers are mapped to cells by the same rounding, which keeps their order; so boxes that meet
    /// share a cell.
    fn cells(&self, bounds: &RoundedBox) -> Cells {
        let cell = |x: f32, i: usize| self.clamped((f64::from(x) - self.low[i]) * self.scale[i]);
        each_axis(|i| [cell(bounds.low[i], i), cell(bounds.high[i], i)])
    }

    /// Returns the index of the cell at a coordinate in units of cells, clamped to the grid.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to the cells"
    )]
    fn clamped(&self, x: f64) -> usize {
        (x as usize).min(self.cells - 1)
    }
}

impl Plane {
    fn of([a, b, c]: &Triangle, [low, high]: &[Point; 2]) -> Self {
        let [u, v] = [b, c].map(|p| each_axis(|i| p[i] - a[i]));
        let product = |i: usize, j: usize| (u[i] * v[j], u[j] * v[i]);
        let minors = [product(1, 2), product(2, 0), product(0, 1)];
        let size: f64 = minors.iter().map(|(p, q)| p.abs() + q.abs()).sum();
        let reach: f64 = (0..3)
            .map(|i| high[i] - low[i] + (a[i] - low[i]).abs())
            .sum();
        Self {
            corner: *a,
            normal: minors.map(|(p, q)| p - q),
            // There are about ten roundings, each below an epsilon times the sizes.
            error: 16.0 * f64::EPSILON * size * reach,
        }
    }
}

/// Returns a word with the bits of the cells from `first` to `last` set.
fn mask([first, last]: [usize; 2]) -> u64 {
    (u64::MAX >> (MAX_CELLS_PER_AXIS - 1 - (last - first))) << first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arith::convert::as_number;

    const WINDOW: [Point; 2] = [[0.0; 3], [100.0, 7.0, 1e6]];

    fn next(k: u32) -> f64 {
        f64::from(k.wrapping_mul(2_654_435_761) >> 20) / 4096.0
    }

    /// Returns a triangle in the window or slightly outside it.
    fn triangle(k: u32, size: f64) -> Triangle {
        let at = |c: u32, i: usize| next(12 * k + 3 * c + as_number(i));
        [1, 2, 3]
            .map(|c| each_axis(|i| WINDOW[1][i] * (at(0, i) * 1.2 - 0.1 + size * (at(c, i) - 0.5))))
    }

    #[test]
    fn faces_that_meet_share_a_cell() {
        for k in 0..3000 {
            let [large, small] = [triangle(k, 1.0), triangle(k + 5000, 0.02)];
            let bounds = RoundedBox::around(&large);
            let cells = Occupancy::of(&WINDOW, &[bounds], |_| large, 10_000);
            // Corners of the triangle, and points inside it, by their barycentric coordinates.
            for [s, t] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.3, 0.3], [0.1, 0.7]] {
                let [a, b, c] = large;
                let p = each_axis(|i| a[i] + s * (b[i] - a[i]) + t * (c[i] - a[i]));
                let inside = (0..3).all(|i| (WINDOW[0][i]..=WINDOW[1][i]).contains(&p[i]));
                assert!(
                    !inside || cells.meets(&RoundedBox::between(&p, &p)),
                    "{k} {p:?}"
                );
            }
            let bounds = RoundedBox::around(&small);
            let far = Occupancy::of(&WINDOW, &[bounds], |_| small, 10_000);
            assert!(far.meets(&bounds));
        }
    }

    #[test]
    fn large_faces_reach_into_few_cells() {
        let slanted = [[0.0, 0.0, 0.0], [100.0, 0.0, 1e6], [0.0, 7.0, 1e6]];
        let cells = Occupancy::of(
            &WINDOW,
            &[RoundedBox::around(&slanted)],
            |_| slanted,
            10_000,
        );
        let count: u32 = cells.rows.iter().map(|row| row.count_ones()).sum();
        assert!(count < 6 * 64 * 64, "{count}");
    }
}
