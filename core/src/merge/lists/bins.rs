//! Sorts the faces of a long list once into equally large cells, so that halving a larger cell moves none of
//! them.
//!
//! A cell larger than these only looks up how many faces it has and the winding number at its corner. Its
//! faces are collected where the descent ends or continues with short lists.
//!
//! # Source
//! Counting sort; integral images (Crow 1984) for the counts in boxes of cells.
// Indices of cells inside the window are never negative.

use std::sync::Arc;

use super::crossings::{line_count, Crossings};
use super::separation::triangle_misses;
use super::window::{Span, Window};
use crate::arith::convert::as_number;
use crate::geometry::axes::each_axis;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Orientation;
use crate::interrupt::poll;
use crate::mesh::handle::FaceId;
use crate::mesh::triangles::TriangleMesh;
use crate::tree::node::{Branch, DeferredLeaf, FaceGroup, Node};

/// The least average number of faces in a cell into which faces are sorted.
const MIN_FACES_PER_CELL: usize = 4;

/// The largest average number of cells in which a face is listed; if it is exceeded, larger cells are used.
const MAX_ENTRIES_PER_FACE: usize = 2;

/// The number of faces sampled to estimate in how many cells a face is listed.
const FACES_SAMPLED: usize = 1024;

/// The least number of cells for which it pays to sort faces into them.
const MIN_CELLS: usize = 64;

/// The faces of a deferred leaf, sorted by the equally large cells of a window.
#[derive(Debug)]
pub struct Bins {
    home: Branch,
    /// For each group of faces (with one mesh and orientation), the number of its first face; faces are
    /// numbered consecutively over all groups.
    firsts: Vec<u32>,
    window: Window,
    /// For each cell the index in `entries` of the first face in the cell; the last number is the end of the
    /// last cell's faces.
    starts: Vec<u32>,
    /// The numbers of the faces in each cell, cell after cell.
    entries: Vec<u32>,
    /// For each corner of the window's cells, the number of faces in the cells below it on all three axes; a
    /// face counts once for each cell.
    below: Vec<u32>,
    crossings: Crossings,
}

/// The faces of one group, which share a mesh and an orientation; `first` is the number of the first one
/// among the faces of the leaf.
struct GroupFaces<'a> {
    mesh: &'a TriangleMesh,
    faces: &'a [FaceId],
    orientation: Orientation,
    first: u32,
}

/// The cells that each face lies in.
struct Sorted {
    /// For each face the number of the one cell that contains it, or `SPANS` if it reaches into several or
    /// lies outside the window.
    cells: Vec<u32>,
    spans: Vec<Span>,
}

const SPANS: u32 = u32::MAX;

impl Bins {
    /// Sorts the faces of a branch whose node is a deferred leaf.
    ///
    /// `None` if the leaf does not consist of faces of meshes only, or if most faces are so large within
    /// their region that no cell size separates them.
    pub fn new(home: &Branch) -> Option<Self> {
        let Node::Deferred(leaf) = &*home.node else {
            return None;
        };
        let runs = runs(leaf)?;
        let mut window = plan_window(&runs, &home.cell, leaf.len())?;
        loop {
            if let Some(bins) = Self::sorted(home, &runs, window, leaf.len()) {
                return Some(bins);
            }
            let (low, high) = bounds(&runs, &home.cell)?;
            window =
                Window::around(&low, &high, window.size() + 1).filter(|w| w.len() >= MIN_CELLS)?;
        }
    }

    fn sorted(home: &Branch, runs: &[GroupFaces], window: Window, total: usize) -> Option<Self> {
        let sorted = Sorted::new(&window, runs, total);
        let rows = cell_element_pairs(
            &window,
            runs,
            &sorted.spans,
            2 * MAX_ENTRIES_PER_FACE * total,
        )?;
        let (starts, entries) = distribute(&window, &sorted.cells, &rows);
        let corners = |element: u32| {
            let (run, face) = group_and_face_of(runs, element);
            (run.mesh.corners(face), run.orientation)
        };
        Some(Self {
            home: home.clone(),
            firsts: runs.iter().map(|r| r.first).collect(),
            window,
            below: entries_below_corners(&window, &starts),
            crossings: Crossings::new(window, &sorted.spans, corners),
            starts,
            entries,
        })
    }

    /// Returns true if halving this cell cuts none of the cells into which faces are sorted.
    pub fn divide(&self, cell: &Cell) -> bool {
        self.window.is_divided_in(cell)
    }

    /// Returns the number of faces of the sorted leaf that reach into a cell, zero if none does; a face
    /// counts once for each of the smaller cells (bins) that it was sorted into.
    pub fn len_in(&self, cell: &Cell) -> usize {
        let [x, y, z] = self.window.cells_in(cell);
        let [_, ny, nz] = self.window.count();
        let at = |x: i32, y: i32, z: i32| {
            self.below[((x * (ny + 1) + y) * (nz + 1) + z).cast_unsigned() as usize]
        };
        let row = |x: i32, y: i32| at(x, y, z.end) - at(x, y, z.start);
        let slab = |x: i32| row(x, y.end) - row(x, y.start);
        (slab(x.end) - slab(x.start)) as usize
    }

    /// Returns the winding number at the low corner of a cell that lies in the sorted leaf.
    pub fn corner_of(&self, cell: &Cell) -> i32 {
        let change = self.crossings.sum_up_to(self.window.corner(cell));
        self.home.oriented(self.leaf().corner + change)
    }

    /// Returns the sorted leaf restricted to a cell, as a deferred leaf that lists the faces in this cell.
    pub fn branch_in(&self, cell: &Cell) -> Branch {
        if *cell == self.home.cell {
            return self.home.clone();
        }
        let leaf = DeferredLeaf {
            groups: self.groups_in(cell),
            parts: Vec::new(),
            corner: self.corner_of(cell),
            by_kernel: self.leaf().by_kernel,
            ..DeferredLeaf::default()
        };
        Branch::of_node(*cell, Node::Deferred(leaf))
    }

    /// Returns true if a kernel made the sorted leaf; false if it is the unchanged boundary of an operand.
    pub fn is_by_kernel(&self) -> bool {
        self.leaf().by_kernel
    }

    fn leaf(&self) -> &DeferredLeaf {
        match &*self.home.node {
            Node::Deferred(leaf) => leaf,
            Node::Leaf(_) | Node::Cut(_) => unreachable!("bins are made of deferred leaves"),
        }
    }

    fn groups_in(&self, cell: &Cell) -> Vec<FaceGroup> {
        let elements = self.elements_in(cell);
        let mut rest = &elements[..];
        let mut groups = Vec::new();
        for (i, group) in self.leaf().groups.iter().enumerate() {
            poll();
            let first = self.firsts[i];
            let end = self.firsts.get(i + 1).copied().unwrap_or(u32::MAX);
            let (own, others) = rest.split_at(rest.partition_point(|e| *e < end));
            rest = others;
            if !own.is_empty() {
                let face = |e: &u32| group.faces[(e - first) as usize];
                groups.push(FaceGroup {
                    touching: group.touching,
                    source: Arc::clone(&group.source),
                    orientation: group.orientation.turned_if(self.home.complement),
                    faces: own.iter().map(face).collect(),
                });
            }
        }
        groups
    }

    /// Returns the numbers of the faces in a cell, ascending and without repetition.
    fn elements_in(&self, cell: &Cell) -> Vec<u32> {
        let [x, y, z] = self.window.cells_in(cell);
        let mut elements = Vec::with_capacity(self.len_in(cell));
        for (x, y) in x.flat_map(|x| y.clone().map(move |y| (x, y))) {
            let row = self.window.index([x, y, z.start])..self.window.index([x, y, z.end]);
            let entries = self.starts[row.start] as usize..self.starts[row.end] as usize;
            elements.extend_from_slice(&self.entries[entries]);
        }
        sorted_without_repetition(elements, self.leaf().len())
    }
}

/// Sorts numbers below `limit` and removes repetitions.
fn sorted_without_repetition(mut numbers: Vec<u32>, limit: usize) -> Vec<u32> {
    if numbers.len() < limit / 32 {
        numbers.sort_unstable();
        numbers.dedup();
        return numbers;
    }
    let mut marks = vec![0u64; limit / 64 + 1];
    for n in &numbers {
        marks[*n as usize / 64] |= 1 << (n % 64);
    }
    numbers.clear();
    for (i, mark) in (0u32..).zip(marks) {
        let mut bits = mark;
        while bits != 0 {
            numbers.push(64 * i + bits.trailing_zeros());
            bits &= bits - 1;
        }
    }
    numbers
}

/// Returns the faces of a leaf by group (one mesh and orientation); `None` if the leaf lists anything but
/// triangles of meshes.
fn runs(leaf: &DeferredLeaf) -> Option<Vec<GroupFaces<'_>>> {
    if !leaf.parts.is_empty() {
        return None;
    }
    let mut runs = Vec::with_capacity(leaf.groups.len());
    let mut first = 0;
    for group in &leaf.groups {
        runs.push(GroupFaces {
            mesh: group.source.mesh()?,
            faces: &group.faces,
            orientation: group.orientation,
            first,
        });
        first += as_number(group.faces.len());
    }
    Some(runs)
}

/// Returns the group (faces of one mesh and orientation) of the face with this number, and the face.
fn group_and_face_of<'a, 'b>(
    runs: &'a [GroupFaces<'b>],
    element: u32,
) -> (&'a GroupFaces<'b>, FaceId) {
    let run = &runs[runs.partition_point(|r| r.first <= element) - 1];
    (run, run.faces[(element - run.first) as usize])
}

impl GroupFaces<'_> {
    /// Returns true if this group of faces of one mesh has at least as many faces as the mesh has vertices,
    /// so that one pass over all vertices pays.
    fn has_most_vertices(&self) -> bool {
        self.faces.len() >= self.mesh.vertices.len()
    }

    fn bounds(&self) -> Option<(Lattice, Lattice)> {
        if self.has_most_vertices() {
            return self.mesh.bounds();
        }
        self.faces
            .iter()
            .map(|f| self.mesh.face_box(*f))
            .reduce(box_union)
    }
}

fn box_union(a: (Lattice, Lattice), b: (Lattice, Lattice)) -> (Lattice, Lattice) {
    (
        each_axis(|i| a.0[i].min(b.0[i])),
        each_axis(|i| a.1[i].max(b.1[i])),
    )
}

/// Returns the intersection of a cell with the bounding box of all faces, as its low and its high corner;
/// `None` if it is empty.
fn bounds(runs: &[GroupFaces], home: &Cell) -> Option<(Lattice, Lattice)> {
    let (low, high) = runs
        .iter()
        .filter_map(GroupFaces::bounds)
        .reduce(box_union)?;
    let top = home.high();
    let low = each_axis(|i| low[i].max(home.low()[i]));
    let high = each_axis(|i| high[i].min(top[i]));
    (0..3).all(|i| low[i] <= high[i]).then_some((low, high))
}

/// Returns the window (box of equally large cells) of the smallest cells with enough faces in each cell and
/// with each face in few enough cells, on average; `None` if there is none, or if its cells are fewer than
/// `MIN_CELLS`.
fn plan_window(runs: &[GroupFaces], home: &Cell, total: usize) -> Option<Window> {
    let (low, high) = bounds(runs, home)?;
    let step = total.div_ceil(FACES_SAMPLED);
    let sample: Vec<(Lattice, Lattice)> = (0..as_number(total))
        .step_by(step)
        .map(|element| group_and_face_of(runs, element))
        .map(|(run, face)| run.mesh.face_box(face))
        .collect();
    let coarsest = home.size().into_iter().min().map_or(0, u32::from);
    (0..=coarsest)
        .filter_map(|size| Window::around(&low, &high, size))
        .filter(|w| w.len() * MIN_FACES_PER_CELL <= total)
        .find(|w| {
            sample.iter().map(|b| entry_count(w, b)).sum::<usize>()
                <= MAX_ENTRIES_PER_FACE * sample.len()
        })
        .filter(|w| w.len() >= MIN_CELLS)
}

/// Returns the number of the window's cells that a face with this bounding box may reach into.
fn entry_count(window: &Window, (low, high): &(Lattice, Lattice)) -> usize {
    let [low, high] = [window.code(low), window.code(high)];
    cell_count(window, &Span::new(0, [low, high, high]))
}

fn cell_count(window: &Window, span: &Span) -> usize {
    let product = |(low, high): ([i32; 3], [i32; 3])| {
        (0..3)
            .map(|i| (high[i] - low[i] + 1).cast_unsigned() as usize)
            .product()
    };
    window.within(span).map_or(0, product)
}

impl Sorted {
    fn new(window: &Window, runs: &[GroupFaces], total: usize) -> Self {
        let mut sorted = Self {
            cells: Vec::with_capacity(total),
            spans: Vec::new(),
        };
        for run in runs {
            poll();
            let mesh = run.mesh;
            if run.has_most_vertices() {
                let codes: Vec<u32> = mesh.vertices.iter().map(|p| window.code(p)).collect();
                let code = |f: FaceId| {
                    let vertices = mesh.vertices_of(f);
                    each_axis(|i| codes[vertices[i].index()])
                };
                sorted.add(window, run, code);
            } else {
                sorted.add(window, run, |f| mesh.corners(f).map(|p| window.code(&p)));
            }
        }
        sorted
    }

    fn add(&mut self, window: &Window, run: &GroupFaces, codes: impl Fn(FaceId) -> [u32; 3]) {
        for (element, face) in (run.first..).zip(run.faces) {
            let [a, b, c] = codes(*face);
            let cell = if a == b && b == c {
                window.index_of(a)
            } else {
                self.spans.push(Span::new(element, [a, b, c]));
                None
            };
            self.cells.push(cell.unwrap_or(SPANS));
        }
    }
}

/// Returns the pairs of cell and face for the faces that reach into several cells; `None` if these pairs,
/// with the lines that the faces may cross, are more than `limit`.
fn cell_element_pairs(
    window: &Window,
    runs: &[GroupFaces],
    spans: &[Span],
    limit: usize,
) -> Option<Vec<(u32, u32)>> {
    let mut rows = Vec::with_capacity(2 * spans.len());
    let mut lines = 0;
    for span in spans {
        poll();
        lines += line_count(span);
        let Some((low, high)) = window.within(span) else {
            continue;
        };
        if (0..3).any(|i| high[i] - low[i] > 1) {
            let (run, face) = group_and_face_of(runs, span.element);
            let corners = run.mesh.corners(face);
            spread(window, &corners, low, high, &mut |cell| {
                rows.push((cell, span.element));
            });
        } else {
            each_cell(window, low, high, &mut |cell| {
                rows.push((cell, span.element));
            });
        }
        if rows.len() + lines > limit {
            return None;
        }
    }
    Some(rows)
}

/// Calls `enter` with the number of each cell from `low` to `high`.
fn each_cell(window: &Window, low: [i32; 3], high: [i32; 3], enter: &mut impl FnMut(u32)) {
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            for z in low[2]..=high[2] {
                enter(as_number(window.index([x, y, z])));
            }
        }
    }
}

/// Calls `enter` with the number of each cell from `low` to `high` that a triangle may meet.
fn spread(
    window: &Window,
    corners: &[Lattice; 3],
    low: [i32; 3],
    high: [i32; 3],
    enter: &mut impl FnMut(u32),
) {
    let mut open = vec![(low, high)];
    while let Some((low, high)) = open.pop() {
        poll();
        let (a, b) = window.extent(&low, &high);
        if triangle_misses(corners, &a, &b) {
            continue;
        }
        let axis = (0..3).max_by_key(|i| high[*i] - low[*i]).unwrap_or(0);
        if low[axis] == high[axis] {
            enter(as_number(window.index(low)));
            continue;
        }
        let (mut end, mut start) = (high, low);
        end[axis] = i32::midpoint(low[axis], high[axis]);
        start[axis] = end[axis] + 1;
        open.extend([(start, high), (low, end)]);
    }
}

/// Sorts pairs of a cell and a face in it by cell; returns for each cell the index of its first pair, and the
/// faces of the pairs. `cells` has the only cell of each face, and `rows` the pairs of cell and face for
/// faces in several cells.
fn distribute(window: &Window, cells: &[u32], rows: &[(u32, u32)]) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; window.len() + 2];
    for cell in cells.iter().filter(|c| **c != SPANS) {
        starts[*cell as usize + 2] += 1;
    }
    for (cell, _) in rows {
        starts[*cell as usize + 2] += 1;
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut entries = vec![0u32; sum as usize];
    let mut enter = |cell: u32, element: u32| {
        let end = &mut starts[cell as usize + 1];
        entries[*end as usize] = element;
        *end += 1;
    };
    for (element, cell) in (0u32..).zip(cells).filter(|(_, c)| **c != SPANS) {
        enter(*cell, element);
    }
    for (cell, element) in rows {
        enter(*cell, *element);
    }
    (starts, entries)
}

/// Returns for each corner of the window's cells the number of faces in the cells below it on all three axes;
/// a face counts once for each cell.
fn entries_below_corners(window: &Window, starts: &[u32]) -> Vec<u32> {
    let [nx, ny, nz] = window.count().map(|c| c.cast_unsigned() as usize);
    let (row, slab) = (nz + 1, (ny + 1) * (nz + 1));
    let mut below = vec![0u32; (nx + 1) * slab];
    for x in 0..nx {
        poll();
        for y in 0..ny {
            let first = (x * ny + y) * nz;
            let to = (x + 1) * slab + (y + 1) * row;
            for z in 1..=nz {
                let in_row = starts[first + z] - starts[first];
                let before =
                    below[to - slab + z] + below[to - row + z] - below[to - slab - row + z];
                below[to + z] = before + in_row;
            }
        }
    }
    below
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::scenes::cuboids;
    use crate::mesh::handle::Slot;
    use crate::tree::solid::Solid;

    /// 64 boxes in a cubic array, each in a cell of 16 lattice points along each axis, and one box around
    /// them all.
    fn boxes_in_a_box() -> Solid {
        let places = (0..64).map(|i| [16 * (i & 3), 16 * (i >> 2 & 3), 16 * (i >> 4)]);
        let small = places.map(|p| [2, 13].map(|c| p.map(|x| x + c)));
        cuboids(small.chain([[[1; 3], [62; 3]]]))
    }

    #[test]
    fn a_cell_finds_its_faces_and_its_corner_by_its_place() {
        let solid = boxes_in_a_box();
        let bins = Bins::new(solid.root()).expect("many small faces");
        let mesh = solid.sources().get(Slot(0)).mesh().expect("a mesh");
        let is_small = |face: &FaceId| face.0 < 64 * 12;
        for place in (0..4).flat_map(|x| (0..4).map(move |y| [16 * x, 16 * y, 32])) {
            let cell = Cell::around(&place, &place.map(|c| c + 15));
            let inside = place.iter().all(|c| *c > 0);
            assert_eq!(bins.corner_of(&cell), i32::from(inside), "{place:?}");
            let held = |face: &FaceId| {
                let (low, high) = mesh.face_box(*face);
                cell.contains_box(&low, &high)
            };
            let small: Vec<FaceId> = mesh.face_ids().filter(held).collect();
            let faces = bins.groups_in(&cell).into_iter().flat_map(|g| g.faces);
            let (found, large): (Vec<FaceId>, Vec<FaceId>) = faces.partition(is_small);
            assert_eq!((found.len(), found), (12, small));
            let on_rim = place.iter().any(|c| [0, 48].contains(c));
            assert_eq!(!large.is_empty(), on_rim, "{place:?}");
        }
    }

    #[test]
    fn few_faces_are_not_worth_the_sorting() {
        assert!(Bins::new(cuboids([[[0; 3], [9; 3]]]).root()).is_none());
    }

    #[test]
    fn numbers_are_sorted_by_comparing_or_by_marking() {
        assert_eq!(sorted_without_repetition(vec![9, 2, 9], 1000), [2, 9]);
        assert_eq!(sorted_without_repetition(vec![9, 2, 9], 10), [2, 9]);
    }
}
