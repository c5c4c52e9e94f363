//! Decides whether lattice points lie inside, on the boundary of, or outside a solid.

use crate::error::Result;
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::Polygon;
use crate::geometry::side::{Half, Side};
use crate::interrupt::poll;
use crate::merge::kernels::trees::LeafTree;
use crate::merge::lists::list::{List, Sources};
use crate::tree::node::{Branch, Node};
use crate::tree::solid::Solid;

/// The position of a point relative to a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// In the interior of the solid.
    Inside,
    /// On the boundary of the solid.
    Boundary,
    /// In the interior of the solid's complement.
    Outside,
}

/// A list with at most this many faces and parts of faces is not divided further to locate points.
const MAX_ELEMENTS_SEARCHED: usize = 20;

/// Returns the location of each lattice point; `Boundary` means the solid's boundary if the solid is
/// reduced.
///
/// Divides deferred leaves for these points on the way, but does not store the result.
///
/// # Errors
/// None.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::mesh::grid::Pitch;
/// use bspcsg::mesh::import::import;
/// use bspcsg::query::classify::{classify, Location};
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let pitch = Pitch::new(-1)?;
/// let source = import(&vertices, &faces, Some(pitch))?;
/// let solid = Solid::of_source(Arc::new(source), false);
/// let found = classify(&solid, &[[1, 1, 1], [0, 0, 5], [9, 9, 9]])?;
/// assert_eq!(found, [Location::Inside, Location::Boundary, Location::Outside]);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn classify(solid: &Solid, points: &[Lattice]) -> Result<Vec<Location>> {
    let sources = Sources::new(solid.sources().clone());
    let mut found = vec![Location::Outside; points.len()];
    let all: Vec<usize> = (0..points.len()).collect();
    let mut search = Search {
        sources: &sources,
        points,
        found: &mut found,
    };
    search.tree(solid.root(), all);
    Ok(found)
}

struct Search<'a> {
    sources: &'a Sources,
    points: &'a [Lattice],
    found: &'a mut [Location],
}

impl Search<'_> {
    fn label(&mut self, points: &[usize], w: i32) {
        let location = if w > 0 {
            Location::Inside
        } else {
            Location::Outside
        };
        for i in points {
            poll();
            self.found[*i] = location;
        }
    }

    fn split(
        &self,
        points: Vec<usize>,
        inside: impl Fn(&Lattice) -> bool,
    ) -> (Vec<usize>, Vec<usize>) {
        points.into_iter().partition(|i| {
            poll();
            inside(&self.points[*i])
        })
    }

    fn tree(&mut self, root: &Branch, points: Vec<usize>) {
        let mut open = vec![(root.clone(), points)];
        while let Some((branch, points)) = open.pop() {
            poll();
            let (points, around) = self.split(points, |p| branch.cell.contains_box(p, p));
            self.label(&around, branch.outside);
            if points.is_empty() {
                continue;
            }
            match &*branch.node {
                Node::Leaf(w) => self.label(&points, branch.oriented(*w)),
                Node::Deferred(leaf) => {
                    let list = List::open(leaf, &branch, self.sources);
                    self.list(branch.cell, list, points);
                }
                Node::Cut(halves) => {
                    let [minus, plus] = &halves.children;
                    if let Some(cut) = branch.cell.cut() {
                        let (below, above) = self.split(points, |p| p[cut.axis] < cut.at);
                        open.push((branch.child(minus), below));
                        open.push((branch.child(plus), above));
                    }
                }
            }
        }
    }

    fn list(&mut self, cell: Cell, list: List, points: Vec<usize>) {
        let mut open = vec![(cell, list, points)];
        while let Some((cell, list, points)) = open.pop() {
            poll();
            if points.is_empty() {
                continue;
            }
            if list.is_empty() {
                self.label(&points, list.corner);
                continue;
            }
            let small = list.len() <= MAX_ELEMENTS_SEARCHED
                || list.count_reaching_out(&cell) * 8 > list.len() * 7;
            match cell.cut().filter(|_| !small) {
                Some(cut) => {
                    let (below, above) = self.split(points, |p| p[cut.axis] < cut.at);
                    let (minus, plus) = list.divide(&cell, cut, self.sources);
                    open.push((cell.half(cut, Half::Minus), minus, below));
                    open.push((cell.half(cut, Half::Plus), plus, above));
                }
                None => self.leaf(&cell, &list, &points),
            }
        }
    }

    fn leaf(&mut self, cell: &Cell, list: &List, points: &[usize]) {
        let leaf = LeafTree::new(list, cell, self.sources);
        for i in points {
            poll();
            let p = &self.points[*i];
            let on = leaf.polygons().any(|q| touches(q, p));
            self.found[*i] = match leaf.label_at(p) {
                _ if on => Location::Boundary,
                w if w > 0 => Location::Inside,
                _ => Location::Outside,
            };
        }
    }
}

/// Returns true if a point lies in a polygon, whose edges belong to it.
fn touches(polygon: &Polygon, p: &Lattice) -> bool {
    polygon.support().side_of_lattice(p) == Side::On
        && polygon
            .corners()
            .iter()
            .all(|c| c.edge.plane(polygon.support()).side_of_lattice(p) != Side::Plus)
}
