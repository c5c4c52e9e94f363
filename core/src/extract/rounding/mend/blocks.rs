//! Triangles in blocks of neighbours, so that a query compares few boxes.

use crate::arith::convert::as_number;
use crate::geometry::doubles::extent::Extent;

/// The largest number of triangles in one block: checking a block costs about as much as checking a
/// triangle.
const TRIANGLES_PER_BLOCK: usize = 32;

/// Blocks of neighbouring triangles, each with a box around all positions that its triangles ever had.
#[derive(Debug, Default)]
pub struct Blocks {
    /// For each triangle the number of its block.
    owner: Vec<u32>,
    members: Vec<Vec<u32>>,
    extents: Vec<Extent>,
}

impl Blocks {
    /// Divides triangles with these boxes into blocks.
    pub fn new(extents: &[Extent]) -> Self {
        let mut blocks = Self {
            owner: vec![0; extents.len()],
            ..Self::default()
        };
        let mut open = vec![(0..as_number(extents.len())).collect::<Vec<u32>>()];
        while let Some(mut some) = open.pop() {
            let Some(around) = joined(&some, extents) else {
                continue;
            };
            if some.len() <= TRIANGLES_PER_BLOCK {
                blocks.add(some, around);
            } else {
                let half = some.len() / 2;
                let axis = longest(&around);
                let low = |t: &u32| extents[*t as usize].low[axis];
                some.select_nth_unstable_by(half, |t, u| low(t).total_cmp(&low(u)).then(t.cmp(u)));
                open.push(some.split_off(half));
                open.push(some);
            }
        }
        blocks
    }

    fn add(&mut self, some: Vec<u32>, around: Extent) {
        for t in &some {
            self.owner[*t as usize] = as_number(self.members.len());
        }
        self.members.push(some);
        self.extents.push(around);
    }

    /// Extends the box of a triangle's block by the triangle's new box.
    pub fn grow(&mut self, triangle: u32, extent: &Extent) {
        let around = &mut self.extents[self.owner[triangle as usize] as usize];
        *around = around.joined(extent);
    }

    /// Yields the triangles of all blocks whose box meets a given box.
    pub fn near<'a>(&'a self, extent: &'a Extent) -> impl Iterator<Item = u32> + 'a {
        let blocks = self.extents.iter().zip(&self.members);
        let met = blocks.filter(|(around, _)| !around.misses(extent));
        met.flat_map(|(_, members)| members.iter().copied())
    }

    /// Returns the number of blocks, each of which a query compares once.
    pub fn count(&self) -> usize {
        self.members.len()
    }
}

fn joined(some: &[u32], extents: &[Extent]) -> Option<Extent> {
    let boxes = some.iter().map(|t| extents[*t as usize]);
    boxes.reduce(|a, b| a.joined(&b))
}

fn longest(extent: &Extent) -> usize {
    let lengths = [0, 1, 2].map(|i| extent.high[i] - extent.low[i]);
    (0..3).fold(
        0,
        |most, i| if lengths[i] > lengths[most] { i } else { most },
    )
}

#[cfg(test)]
mod tests {
    use super::Blocks;
    use crate::geometry::doubles::extent::Extent;

    #[test]
    fn every_triangle_that_meets_a_box_is_near_it() {
        let at = |i: u32| {
            let p = [
                f64::from(i % 10),
                f64::from(i / 10 % 10),
                f64::from(i / 100),
            ];
            Extent::of(&[p, p.map(|x| x + 0.5), p])
        };
        let mut extents: Vec<Extent> = (0..1000).map(at).collect();
        let mut blocks = Blocks::new(&extents);
        extents[7] = at(993);
        blocks.grow(7, &extents[7]);
        for one in &extents {
            let near: Vec<u32> = blocks.near(one).collect();
            let met = (0..1000).filter(|t| !extents[*t as usize].misses(one));
            assert!(met.into_iter().all(|t| near.contains(&t)));
            assert!(near.len() < 500);
        }
    }
}
