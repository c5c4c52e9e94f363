//! Queries of sets: pieces, outlines, measures, locations.

use super::each::Set;
use super::pieces::PieceList;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::polygon::Polygon;
use crate::geometry::spaces::axis::AxisSpace;
use crate::geometry::spaces::dim1::Point1;
use crate::geometry::spaces::dim2::{Point2, Segment2};
use crate::geometry::unbounded::big;
use crate::geometry::vertex::Vertex;
use crate::merge::plane::located;
use crate::mesh::grid::Pitch;
use crate::python::hyperplanes::shape;
use crate::query::measure::{in_powers, Fraction};
use crate::query::region::cast::cast;
use crate::query::region::hyperplane::line_along;
use crate::query::region::moments;
use crate::query::region::nearest::Nearest;
use crate::query::region::outlines::{outlines, Outline};
use crate::tree::partition::{boundary_of, cells, classify, Location, PartitionTree};
use crate::tree::plane::PlaneSet;

impl Set {
    /// Returns the boundary in convex pieces, each with the preorder number of its node.
    pub fn boundary(&self, pitch: Pitch) -> Result<PieceList> {
        let mut list = PieceList::new();
        match self {
            Self::Line(tree) => {
                for (node, piece) in boundary_of(tree)? {
                    list.push(point_corners(&piece, pitch), node.into());
                }
            }
            Self::Plane(set) => {
                for (node, piece) in boundary_of(set.tree()?)? {
                    list.push(segment_corners(&piece, pitch), node.into());
                }
            }
            Self::Space(tree) => {
                for (node, piece) in boundary_of(tree)? {
                    list.push(polygon_corners(&piece, pitch), node.into());
                }
            }
        }
        Ok(list)
    }

    /// Returns the faces of the set's convex cells, each with the number of its cell.
    pub fn cells(&self, pitch: Pitch) -> Result<PieceList> {
        if !self.is_bounded() {
            let text =
                "a cell of the set reaches to infinity; intersect it with a bounded set first";
            return Err(Error::new(ErrorKind::Unbounded, text));
        }
        let mut list = PieceList::new();
        match self {
            Self::Line(tree) => push_cells(tree, &mut list, |p| point_corners(p, pitch)),
            Self::Plane(set) => push_cells(set.tree()?, &mut list, |p| segment_corners(p, pitch)),
            Self::Space(tree) => push_cells(tree, &mut list, |p| polygon_corners(p, pitch)),
        }
        Ok(list)
    }

    /// Returns the maximal edges of a plane region's boundary, with the region on their left.
    pub fn edges(&self, pitch: Pitch) -> Result<PieceList> {
        let mut list = PieceList::new();
        let boundary = self.plane()?.boundary()?;
        for edge in &boundary.edges {
            let ends = boundary.points(edge);
            list.push(ends.map(|p| pitch.position_in_plane(p)), edge.inside.into());
        }
        Ok(list)
    }

    /// Returns the outlines of a plane region.
    pub fn outlines(&self) -> Result<Vec<Outline>> {
        outlines(self.plane()?.boundary()?)
    }

    /// Returns the exact length, area or volume, in powers of model units.
    pub fn measure(&self, pitch: Pitch) -> Result<Fraction> {
        match self {
            Self::Line(tree) => moments::length(tree, pitch),
            Self::Plane(set) => moments::area(set.boundary()?, pitch),
            Self::Space(tree) => moments::volume(tree, pitch),
        }
    }

    /// Returns a lower and an upper bound of the area of a plane region as fractions.
    pub fn area_bounds(&self, pitch: Pitch) -> Result<[Fraction; 2]> {
        moments::area_bounds(self.plane()?.boundary()?, pitch)
    }

    /// Returns the area of a plane region and its two first moments, ∫x and ∫y.
    pub fn moments(&self, pitch: Pitch) -> Result<[Fraction; 3]> {
        let boundary = self.plane()?.boundary()?;
        let [x, y] = moments::moments(boundary, pitch)?;
        Ok([moments::area(boundary, pitch)?, x, y])
    }

    /// Returns for each point the nearest point of a plane region's boundary, in model units.
    pub fn nearest(&self, points: &[[f64; 2]], pitch: Pitch) -> Result<Vec<[f64; 2]>> {
        let boundary = self.plane()?.boundary()?;
        let segment = |edge| boundary.points(edge).map(|p| pitch.position_in_plane(p));
        let nearest = Nearest::of(boundary.edges.iter().map(segment).collect());
        let found: Option<Vec<_>> = points.iter().map(|p| nearest.to(*p)).collect();
        found.ok_or_else(|| shape("the set has no boundary, so no nearest boundary point"))
    }

    /// Returns the intervals of a line inside a plane region, as segments.
    pub fn cast(&self, origin: [f64; 2], direction: [f64; 2], pitch: Pitch) -> Result<PieceList> {
        let line = line_along([pitch.snap(origin[0])?, pitch.snap(origin[1])?], direction)?;
        let mut list = PieceList::new();
        for stretch in cast(self.plane()?.tree()?, &line)? {
            list.push(stretch.map(|p| pitch.position_in_plane(&p)), 0);
        }
        Ok(list)
    }

    /// Returns the location of each point; points are given as rows of `columns` numbers, and are snapped.
    pub fn classify(&self, points: &[f64], columns: usize, pitch: Pitch) -> Result<Vec<Location>> {
        if !points.is_empty() && columns != self.dimension() {
            return Err(shape(format!(
                "each point must have {} numbers, not {columns}",
                self.dimension()
            )));
        }
        let steps: Result<Vec<i64>> = points.iter().map(|x| pitch.snap(*x)).collect();
        let steps = steps?;
        Ok(match self {
            Self::Line(tree) => steps.iter().map(|p| classify(tree, p)).collect(),
            Self::Plane(set) => located(set, steps.as_chunks().0)?,
            Self::Space(tree) => {
                let place = |p: &[i64; 3]| classify(tree, &Vertex::lattice(*p));
                steps.as_chunks().0.iter().map(place).collect()
            }
        })
    }

    pub(super) fn plane(&self) -> Result<&PlaneSet> {
        match self {
            Self::Plane(set) => Ok(set),
            _ => Err(shape("only sets of the plane have outlines")),
        }
    }
}

/// Returns the corners of outlines, each outline with the number of the outline directly around it, or −1.
pub fn outline_pieces(outlines: &[Outline], pitch: Pitch) -> PieceList {
    let mut list = PieceList::new();
    for outline in outlines {
        let corners = outline.corners.iter().map(|p| pitch.position_in_plane(p));
        list.push(corners, outline.parent.map_or(-1, |p| p as i64));
    }
    list
}

/// Returns the corners of an outline as exact fractions.
pub fn exact_corners(outline: &Outline, pitch: Pitch) -> Vec<[Fraction; 2]> {
    let exact = |point: &Point2| {
        let (x, w) = point.coordinates();
        [0, 1].map(|i| in_powers(big(&x[i]), big(w), pitch.exponent(), 1))
    };
    outline.corners.iter().map(exact).collect()
}

fn push_cells<S: AxisSpace, const D: usize>(
    tree: &PartitionTree<S>,
    list: &mut PieceList,
    corners: impl Fn(&S::Fragment) -> Vec<[f64; D]>,
) {
    for (cell, faces) in (0..).zip(cells(tree, &S::universe())) {
        for face in faces {
            list.push(corners(&face), cell);
        }
    }
}

fn point_corners(piece: &Point1, pitch: Pitch) -> Vec<[f64; 1]> {
    vec![[pitch.coordinate(piece.at())]]
}

fn segment_corners(piece: &Segment2, pitch: Pitch) -> Vec<[f64; 2]> {
    piece
        .points()
        .iter()
        .map(|p| pitch.position_in_plane(p))
        .collect()
}

fn polygon_corners(piece: &Polygon, pitch: Pitch) -> Vec<[f64; 3]> {
    piece
        .corners()
        .iter()
        .map(|c| pitch.position(&c.at))
        .collect()
}
