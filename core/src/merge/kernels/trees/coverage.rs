//! Partitions a plane by the edges of the fragments (pieces of faces) in it.
//!
//! Each edge is followed only through the cells of the plane that it crosses, and each cell has one sum of
//! weights for all fragments that cover it. Cutting overlapping fragments out of each other would cost the
//! square of their number.

use std::sync::Arc;

use smallvec::SmallVec;

use super::fragment::Fragment;
use crate::arith::convert::as_number;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Plane;
use crate::geometry::polygon::{straddle, Polygon, PolygonSplit};
use crate::geometry::side::Orientation;
use crate::interrupt::poll;

/// Makes the fragments of one plane (polygons with weights) disjoint: where fragments overlap, their
/// intersection gets the sum of their weights and the face of the first one.
pub(super) fn partitioned(fragments: &[Fragment]) -> Vec<Fragment> {
    let Some(region) = fragments
        .first()
        .and_then(|f| Polygon::span(f.polygon.support(), &Cell::UNIVERSE))
    else {
        return Vec::new();
    };
    let mut partition = Partition {
        shapes: fragments.iter().map(|f| Shape::of(f, &region)).collect(),
        cells: vec![Covered::of(region)],
    };
    partition.grow();
    partition.pieces(fragments)
}

/// A fragment (a polygon with a weight), given by planes through its edges.
struct Shape {
    /// For each edge a plane through it, with the fragment on its minus side.
    walls: SmallVec<[Arc<Plane>; 4]>,
    /// The winding number on the minus side of the partitioned plane, minus the number on its plus side.
    weight: i32,
}

impl Shape {
    fn of(fragment: &Fragment, region: &Polygon) -> Self {
        let support = fragment.polygon.support();
        let edges = fragment.polygon.edges();
        let walls = edges.map(|(_, _, edge)| Arc::new(edge.plane(support)));
        let same = support.coincides(region.support()) == Some(Orientation::Same);
        Self {
            walls: walls.collect(),
            weight: if same {
                fragment.weight
            } else {
                -fragment.weight
            },
        }
    }
}

/// The fragments that cover a cell of the plane: the sum of their weights, and the first of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Cover {
    weight: i32,
    /// The index of the first covering fragment; `None` if there is none.
    first: Option<u32>,
}

impl Cover {
    fn with(self, number: u32, weight: i32) -> Self {
        Self {
            weight: self.weight + weight,
            first: Some(self.first.map_or(number, |first| first.min(number))),
        }
    }

    /// Returns true if two adjacent cells of the plane can be merged: they have the same weight and, unless
    /// this is 0, the same first fragment.
    fn is_like(self, other: Self) -> bool {
        self.weight == other.weight && (self.weight == 0 || self.first == other.first)
    }
}

/// A cell of the partitioned plane.
struct Covered {
    region: Polygon,
    cover: Cover,
    /// The indices of the halves on the minus and the plus side of the line that cuts the cell; `None` if the
    /// cell is not divided.
    children: Option<[usize; 2]>,
}

impl Covered {
    fn of(region: Polygon) -> Self {
        Self {
            region,
            cover: Cover::default(),
            children: None,
        }
    }
}

/// A fragment that covers a part of a cell of the plane, and the indices of its edges that may cross the
/// cell.
#[derive(Clone)]
struct Crossing {
    number: u32,
    walls: SmallVec<[u32; 4]>,
}

struct Partition {
    shapes: Vec<Shape>,
    cells: Vec<Covered>,
}

impl Partition {
    /// Divides the whole plane until no edge of a fragment crosses a cell of it.
    fn grow(&mut self) {
        let all = (0u32..).zip(&self.shapes).map(|(number, shape)| Crossing {
            number,
            walls: (0..as_number(shape.walls.len())).collect(),
        });
        let mut open = vec![(0, all.collect::<Vec<_>>())];
        while let Some((cell, crossing)) = open.pop() {
            let crossing = self.settle(cell, crossing);
            let Some(halves) = self.halves(cell, &crossing) else {
                continue;
            };
            let first = self.cells.len();
            self.cells[cell].children = Some([first, first + 1]);
            let cover = self.cells[cell].cover;
            let made = halves.map(Covered::of);
            self.cells
                .extend(made.map(|half| Covered { cover, ..half }));
            open.push((first, crossing.clone()));
            open.push((first + 1, crossing));
        }
    }

    /// Adds to a cell's cover the fragments that cover all of this cell of the plane, and returns the
    /// fragments that cover only a part of it.
    fn settle(&mut self, cell: usize, crossing: Vec<Crossing>) -> Vec<Crossing> {
        let mut left = Vec::with_capacity(crossing.len());
        for one in crossing {
            poll();
            let Some(walls) = self.walls_across(cell, &one) else {
                continue;
            };
            if walls.is_empty() {
                let cover = &mut self.cells[cell].cover;
                *cover = cover.with(one.number, self.shapes[one.number as usize].weight);
            } else {
                left.push(Crossing { walls, ..one });
            }
        }
        left
    }

    /// Returns the edges of a fragment that cross a cell of the plane; `None` if the cell lies outside the
    /// fragment.
    fn walls_across(&self, cell: usize, crossing: &Crossing) -> Option<SmallVec<[u32; 4]>> {
        let shape = &self.shapes[crossing.number as usize];
        let mut across = SmallVec::new();
        for &wall in &crossing.walls {
            let sides = self.cells[cell].region.sides(&shape.walls[wall as usize]);
            match straddle(&sides) {
                (true, true) => across.push(wall),
                (true, false) => {}
                (false, _) => return None,
            }
        }
        Some(across)
    }

    /// Returns the halves of a cell of the plane, cut along an edge of the fragment in the middle of the
    /// list; `None` if the list is empty.
    fn halves(&self, cell: usize, crossing: &[Crossing]) -> Option<[Polygon; 2]> {
        let one = crossing.get(crossing.len() / 2)?;
        let wall = *one.walls.first()?;
        let cut = &self.shapes[one.number as usize].walls[wall as usize];
        match self.cells[cell].region.split(cut) {
            PolygonSplit::Both(minus, plus) => Some([minus, plus]),
            _ => None,
        }
    }

    /// Returns the covered cells of the plane as fragments; halves with the same cover are merged.
    fn pieces(mut self, fragments: &[Fragment]) -> Vec<Fragment> {
        for cell in (0..self.cells.len()).rev() {
            poll();
            let Some([minus, plus]) = self.cells[cell].children.map(|c| c.map(|k| &self.cells[k]))
            else {
                continue;
            };
            let ends = minus.children.is_none() && plus.children.is_none();
            if ends && minus.cover.is_like(plus.cover) {
                self.cells[cell].cover = minus.cover;
                self.cells[cell].children = None;
            }
        }
        let mut pieces = Vec::new();
        let mut open = vec![0];
        while let Some(cell) = open.pop() {
            poll();
            let Covered {
                region,
                cover,
                children,
            } = &self.cells[cell];
            match (children, cover.first) {
                (Some(halves), _) => open.extend(halves),
                (None, Some(first)) if cover.weight != 0 => {
                    pieces.push(piece(region, cover.weight, &fragments[first as usize]));
                }
                (None, _) => {}
            }
        }
        pieces
    }
}

/// Returns a region of the plane as a fragment with the face and the orientation of the fragment `of`.
fn piece(region: &Polygon, weight: i32, of: &Fragment) -> Fragment {
    let same = of.polygon.support().coincides(region.support()) == Some(Orientation::Same);
    Fragment {
        polygon: if same {
            region.clone()
        } else {
            region.flipped()
        },
        weight: if same { weight } else { -weight },
        face: of.face,
        intact: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane::Lattice;
    use crate::geometry::side::Side;
    use crate::merge::scenes::triangle;
    use crate::mesh::handle::{FaceId, Slot, SourceFace};

    fn fragments(triangles: &[[Lattice; 3]]) -> Vec<Fragment> {
        let fragment = |(k, corners): (u32, &[Lattice; 3])| Fragment {
            polygon: triangle(*corners),
            weight: 1,
            face: SourceFace::new(Slot(0), FaceId(k)),
            intact: true,
        };
        (0u32..).zip(triangles).map(fragment).collect()
    }

    fn weights_of(triangles: &[[Lattice; 3]]) -> Vec<(u32, i32)> {
        let pieces = partitioned(&fragments(triangles));
        let mut weights: Vec<_> = pieces.iter().map(|f| (f.face.id.0, f.weight)).collect();
        weights.sort_unstable();
        weights
    }

    #[test]
    fn the_first_keeps_the_place_and_the_sum() {
        let one = [[0, 0, 0], [8, 0, 0], [0, 8, 0]];
        let turned = [[0, 0, 0], [0, 8, 0], [8, 0, 0]];
        assert_eq!(weights_of(&[one]), [(0, 1)]);
        assert_eq!(weights_of(&[one, one, one]), [(0, 3)]);
        assert_eq!(weights_of(&[one, turned]), []);
        assert_eq!(weights_of(&[turned, one, turned]), [(0, 1)]);
        let beside = [[8, 8, 0], [0, 8, 0], [8, 0, 0]];
        assert_eq!(weights_of(&[one, beside]), [(0, 1), (1, 1)]);
        // The second triangle covers a corner of the first one.
        let inner = [[0, 0, 0], [4, 0, 0], [0, 4, 0]];
        assert_eq!(weights_of(&[one, inner]), [(0, 1), (0, 2)]);
        assert_eq!(weights_of(&[inner, one]), [(0, 2), (1, 1)]);
    }

    /// Returns whether a lattice point lies in a convex polygon; `None` if it lies on the line of an edge.
    fn contains(polygon: &Polygon, point: &Lattice) -> Option<bool> {
        let support = polygon.support();
        let planes = polygon.edges().map(|(_, _, edge)| edge.plane(support));
        let sides: Vec<Side> = planes.map(|plane| plane.side_of_lattice(point)).collect();
        let decided = !sides.contains(&Side::On);
        decided.then(|| sides.iter().all(|side| *side == Side::Minus))
    }

    #[test]
    fn points_have_the_weight_of_all_that_covers_them() {
        let mut state = 1u64;
        let mut draw = |most: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            i64::try_from((state >> 33) % most).expect("small")
        };
        let mut points = |count: usize| -> Vec<Lattice> {
            (0..count).map(|_| [draw(97), draw(89), 0]).collect()
        };
        let corners = points(90);
        let triangles = corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]);
        let fragments = fragments(&triangles.collect::<Vec<_>>());
        let pieces = partitioned(&fragments);
        let upward = |f: &Fragment| f.polygon.support().normal()[2].signum() as i32;
        let mut seen = 0;
        for point in points(500) {
            let over = |all: &[Fragment]| -> Option<Vec<(u32, i32)>> {
                let mut weights = Vec::new();
                for f in all {
                    if contains(&f.polygon, &point)? {
                        weights.push((f.face.id.0, f.weight * upward(f)));
                    }
                }
                Some(weights)
            };
            let (Some(given), Some(found)) = (over(&fragments), over(&pieces)) else {
                continue;
            };
            let sum: i32 = given.iter().map(|(_, weight)| weight).sum();
            let wanted = (sum != 0).then(|| (given[0].0, sum));
            assert_eq!(found, wanted.into_iter().collect::<Vec<_>>());
            seen += 1;
        }
        assert!(seen > 100);
    }
}
