//! Changes of the winding number along the lines through the corners of a window's cells.
//!
//! The path from the low corner of the window to another corner of its cells runs along the first axis, then
//! the second, then the third. Only faces whose bounds contain lines across two axes can meet a line along
//! the third.
// The numbers of lines, and indices of cells inside the window, are never negative.

use super::window::{Span, Window};
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Orientation;
use crate::geometry::winding::crossing::{triangle_change, Segment};
use crate::interrupt::poll;

/// The number of a line along an axis and a cell index on it in one 64-bit word, ordered by line, then index.
type Key = u64;

/// The changes of the winding number along the lines parallel to one axis, as running sums.
#[derive(Debug, Default)]
struct AxisCrossings {
    keys: Vec<Key>,
    sums: Vec<i32>,
}

/// The crossings of faces with the paths from a window's low corner to the corners of its cells.
#[derive(Debug)]
pub struct Crossings {
    window: Window,
    by_axis: [AxisCrossings; 3],
}

fn key(line: u32, index: i32) -> Key {
    u64::from(line) << 32 | u64::from(index.cast_unsigned())
}

impl AxisCrossings {
    fn new(mut changes: Vec<(Key, i32)>) -> Self {
        changes.sort_unstable();
        let mut sum = 0;
        let sums = changes.iter().map(|(_, change)| {
            sum += change;
            sum
        });
        Self {
            sums: sums.collect(),
            keys: changes.iter().map(|(key, _)| *key).collect(),
        }
    }

    /// Returns the change of the winding number along line number `line`, from its start to the plane number
    /// `end` across it.
    fn sum_up_to(&self, line: u32, end: i32) -> i32 {
        let before = |key: Key| {
            let count = self.keys.partition_point(|k| *k < key);
            count.checked_sub(1).map_or(0, |last| self.sums[last])
        };
        before(key(line, end)) - before(key(line, 0))
    }
}

impl Crossings {
    /// Finds the crossings of faces that reach into several cells; `corners` returns the corners and the
    /// orientation of a face by its number.
    pub fn new(
        window: Window,
        spans: &[Span],
        corners: impl Fn(u32) -> ([Lattice; 3], Orientation),
    ) -> Self {
        let mut found = [Vec::new(), Vec::new(), Vec::new()];
        for span in spans.iter().filter(|s| crosses_two(s)) {
            poll();
            let (corners, orientation) = corners(span.element);
            let mut add = |axis: usize, x: i32, y: i32| {
                let Some((index, change)) = crossing(&window, span, &corners, axis, [x, y]) else {
                    return;
                };
                let line = number(&window, axis, x, y);
                found[axis].push((key(line, index), orientation.signed(change)));
            };
            visit_lines(span, &mut add);
        }
        Self {
            window,
            by_axis: found.map(AxisCrossings::new),
        }
    }

    /// Returns the change of the winding number from the window's low corner to another corner of its cells.
    pub fn sum_up_to(&self, corner: [i32; 3]) -> i32 {
        let [x, y, z] = corner;
        let line = |axis| number(&self.window, axis, x, y);
        self.by_axis[0].sum_up_to(line(0), x)
            + self.by_axis[1].sum_up_to(line(1), y)
            + self.by_axis[2].sum_up_to(line(2), z)
    }
}

/// Returns how many of the lines through corners of cells a face with this range of cells may cross.
pub fn line_count(span: &Span) -> usize {
    let mut count = 0;
    if crosses_two(span) {
        visit_lines(span, &mut |_, _, _| count += 1);
    }
    count
}

/// Returns true if a face reaches over planes between cells on at least two axes.
fn crosses_two(span: &Span) -> bool {
    (0..3).filter(|i| !span.lines(*i).is_empty()).count() >= 2
}

/// Calls `visit` with each line that a face with this range of cells may cross: the axis that it is parallel
/// to, and its indices on the first two axes.
fn visit_lines(span: &Span, visit: &mut impl FnMut(usize, i32, i32)) {
    let [x, y, z] = each_axis(|axis| span.lines(axis));
    let starts = |lines: &std::ops::Range<i32>| lines.contains(&0);
    if starts(&y) && starts(&z) {
        visit(0, 0, 0);
    }
    for i in x {
        if starts(&z) {
            visit(1, i, 0);
        }
        y.clone().for_each(|j| visit(2, i, j));
    }
}

/// Returns the number of a line parallel to `axis`, which lies at indices `x` and `y` on the first two axes;
/// the first axis has only one line, and the second one for each `x`.
fn number(window: &Window, axis: usize, x: i32, y: i32) -> u32 {
    match axis {
        0 => 0,
        1 => x.cast_unsigned(),
        _ => (x * (window.count()[1] + 1) + y).cast_unsigned(),
    }
}

/// Returns the index of the cell along a line, parallel to `axis`, in which a face crosses it, and the change
/// of the winding number there; `None` if it does not cross the line inside the window.
fn crossing(
    window: &Window,
    span: &Span,
    corners: &[Lattice; 3],
    axis: usize,
    [x, y]: [i32; 2],
) -> Option<(i32, i32)> {
    let mut at = [x, y, 0];
    at[axis..].fill(0);
    let (low, high) = (i32::from(span.low[axis]), i32::from(span.high[axis]));
    let (mut low, mut high) = (low.max(0), high.min(window.count()[axis] - 1));
    let change = |low: i32, high: i32| {
        let mut from = at;
        from[axis] = low;
        let from = each_axis(|i| window.line(i, from[i]));
        let to = window.line(axis, high + 1);
        triangle_change(corners, &Segment { from, axis, to })
    };
    let total = if low <= high { change(low, high) } else { 0 };
    while low < high && total != 0 {
        let middle = i32::midpoint(low, high);
        if change(low, middle) == 0 {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    (total != 0).then_some((low, total))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::cuboid;
    use crate::mesh::handle::{FaceId, Slot};

    #[test]
    fn the_way_to_a_corner_in_a_box_crosses_its_surface_once() {
        // The box extends above the top of the window.
        let solid = cuboid([4; 3], [28, 28, 40]);
        let mesh = solid.sources().get(Slot(0)).mesh().expect("a mesh");
        let window = Window::around(&[0; 3], &[31; 3], 3).expect("few cells");
        let span = |face: FaceId| {
            let codes = mesh.corners(face).map(|p| window.code(&p));
            Span::new(face.0, codes)
        };
        let spans: Vec<Span> = mesh.face_ids().map(span).collect();
        let corners = |element: u32| (mesh.corners(FaceId(element)), Orientation::Same);
        let crossings = Crossings::new(window, &spans, corners);
        // The corners of the cells have the coordinates -1/2, 15/2, 31/2, 47/2 and 63/2.
        for (x, y, z) in
            (0..5).flat_map(|x| (0..5).flat_map(move |y| (0..5).map(move |z| (x, y, z))))
        {
            let inside = [x, y].iter().all(|i| (1..4).contains(i)) && z > 0;
            assert_eq!(crossings.sum_up_to([x, y, z]), i32::from(inside));
        }
    }
}
