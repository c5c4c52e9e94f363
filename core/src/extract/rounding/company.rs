//! Which triangles of a mesh lie so near others that the two may meet, by a coarse grid.

use crate::arith::convert::{as_double, as_number};
use crate::geometry::doubles::{Point, Triangle};

use crate::mesh::tasks::fill_chunks;

/// A mesh in doubles, closed by index.
#[derive(Clone, Copy, Debug)]
pub struct Faces<'a> {
    /// The vertices.
    pub vertices: &'a [Point],
    /// The triangles, each directed edge with one opposite.
    pub triangles: &'a [[u32; 3]],
}

impl Faces<'_> {
    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> Triangle {
        let [a, b, c] = self.triangles[triangle as usize];
        let at = |vertex: u32| self.vertices[vertex as usize];
        [at(a), at(b), at(c)]
    }
}

/// The most cells along an axis: the grid then fits into a cache.
const FINEST: usize = 32;

/// The triangles that are not among some, ascending, but may meet one of them or a triangle of
/// another party; with their parties.
///
/// # Cost
/// Two passes over vertices and triangles.
pub fn in_company(faces: &Faces, some: &[u32], party: impl Fn(u32) -> u32) -> Vec<(u32, u32)> {
    if some.len() == faces.triangles.len() {
        return Vec::new();
    }
    let Some(mut grid) = Grid::around(faces) else {
        return Vec::new();
    };
    let mut cells = vec![Cell::default(); faces.vertices.len()];
    fill_chunks(faces.vertices, &mut cells, |_, places, cells| {
        for (place, cell) in places.iter().zip(cells) {
            *cell = grid.cell(place);
        }
    });
    let block = |t: u32| Block::of(faces.triangles[t as usize].map(|v| cells[v as usize]));
    for t in some {
        grid.mark(block(*t), SHARED);
    }
    let mut own = some.iter().copied().peekable();
    let is_other = move |t: &u32| own.next_if_eq(t).is_none();
    let others: Vec<u32> = (0..as_number(faces.triangles.len()))
        .filter(is_other)
        .collect();
    for t in &others {
        grid.mark(block(*t), party(*t) + 1);
    }
    let near = others.into_iter().filter(|t| grid.is_shared(block(*t)));
    near.map(|t| (party(t), t)).collect()
}

/// The mark of cells with triangles of several parties, or with one of those that are asked about.
const SHARED: u32 = u32::MAX;

/// Cells over a mesh, each with the party whose triangles it holds, from 1 on.
struct Grid {
    low: Point,
    factor: Point,
    /// Cells along an axis.
    size: usize,
    marks: Vec<u32>,
}

/// A cell of the grid, on each axis.
type Cell = [u8; 3];

/// The lowest and the highest cell that a triangle may meet, on each axis.
#[derive(Clone, Copy)]
struct Block(Cell, Cell);

impl Block {
    fn of([a, b, c]: [Cell; 3]) -> Self {
        Self(
            [0, 1, 2].map(|i| a[i].min(b[i]).min(c[i])),
            [0, 1, 2].map(|i| a[i].max(b[i]).max(c[i])),
        )
    }
}

impl Grid {
    fn around(faces: &Faces) -> Option<Self> {
        let mut places = faces.vertices.iter();
        let first = *places.next()?;
        let (low, high) = places.fold((first, first), |(low, high), p| {
            let low = [0, 1, 2].map(|i| low[i].min(p[i]));
            (low, [0, 1, 2].map(|i| high[i].max(p[i])))
        });
        let size = (faces.triangles.len() / 24).isqrt().clamp(2, FINEST);
        let factor = |i: usize| as_double(size) / (high[i] - low[i]).max(f64::MIN_POSITIVE);
        Some(Self {
            low,
            factor: [0, 1, 2].map(factor),
            size,
            marks: vec![0; size * size * size],
        })
    }

    #[allow(
        clippy::cast_sign_loss,
        clippy::cast_possible_truncation,
        reason = "no place is below the lowest, and none beyond the size"
    )]
    fn cell(&self, p: &Point) -> Cell {
        [0, 1, 2].map(|i| {
            let place = (p[i] - self.low[i]) * self.factor[i];
            (place as usize).min(self.size - 1) as u8
        })
    }

    /// The stretches of marks that a block covers.
    fn columns(
        &self,
        Block(low, high): Block,
    ) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
        let [low, high] = [low, high].map(|c| c.map(usize::from));
        let size = self.size;
        (low[0]..=high[0]).flat_map(move |x| {
            (low[1]..=high[1]).map(move |y| {
                let start = (x * size + y) * size;
                start + low[2]..start + high[2] + 1
            })
        })
    }

    /// The mark of the only cell of a block.
    fn single(&self, Block(low, high): Block) -> Option<usize> {
        let [x, y, z] = low.map(usize::from);
        (low == high).then_some((x * self.size + y) * self.size + z)
    }

    fn mark(&mut self, block: Block, party: u32) {
        let marked = |mark: &mut u32| {
            *mark = if *mark == 0 || *mark == party {
                party
            } else {
                SHARED
            }
        };
        if let Some(only) = self.single(block) {
            return marked(&mut self.marks[only]);
        }
        for column in self.columns(block) {
            self.marks[column].iter_mut().for_each(marked);
        }
    }

    fn is_shared(&self, block: Block) -> bool {
        if let Some(only) = self.single(block) {
            return self.marks[only] == SHARED;
        }
        self.columns(block)
            .any(|column| self.marks[column].contains(&SHARED))
    }
}
