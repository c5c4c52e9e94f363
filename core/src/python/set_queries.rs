//! What a set answers with: pieces, outlines, measures, places.

use super::each::Set;
use super::hyperplanes::shape;
use super::pieces::PieceList;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::axis::AxisSpace;
use crate::geometry::dim1::Point1;
use crate::geometry::dim2::{Dim2, Point2, Segment2};
use crate::geometry::polygon::Polygon;
use crate::geometry::vertex::Vertex;
use crate::mesh::grid::Pitch;
use crate::query::exact::big;
use crate::query::measure::{in_powers, Fraction};
use crate::query::region::cast::cast;
use crate::query::region::edges::Boundary;
use crate::query::region::hyperplane::line_along;
use crate::query::region::moments;
use crate::query::region::outlines::{outlines, Outline};
use crate::tree::partition::{boundary_of, cells, classify, Location, PartitionTree};

impl Set {
    /// The boundary in convex pieces, each with the preorder number of its node.
    pub fn boundary(&self, pitch: Pitch) -> Result<PieceList> {
        let mut list = PieceList::new();
        match self {
            Self::Line(tree) => {
                for (node, piece) in boundary_of(tree)? {
                    list.push(point_corners(&piece, pitch), node as i64);
                }
            }
            Self::Plane(tree) => {
                for (node, piece) in boundary_of(tree)? {
                    list.push(segment_corners(&piece, pitch), node as i64);
                }
            }
            Self::Space(tree) => {
                for (node, piece) in boundary_of(tree)? {
                    list.push(polygon_corners(&piece, pitch), node as i64);
                }
            }
        }
        Ok(list)
    }

    /// The faces of the convex cells, each with the number of its cell.
    pub fn cells(&self, pitch: Pitch) -> Result<PieceList> {
        if !self.is_bounded() {
            let text = "a cell of the set reaches to infinity";
            return Err(Error::new(ErrorKind::Unbounded, text));
        }
        let mut list = PieceList::new();
        match self {
            Self::Line(tree) => push_cells(tree, &mut list, |p| point_corners(p, pitch)),
            Self::Plane(tree) => push_cells(tree, &mut list, |p| segment_corners(p, pitch)),
            Self::Space(tree) => push_cells(tree, &mut list, |p| polygon_corners(p, pitch)),
        }
        Ok(list)
    }

    /// The maximal edges of a plane region's boundary, the region on their left.
    pub fn edges(&self, pitch: Pitch) -> Result<PieceList> {
        let mut list = PieceList::new();
        for edge in Boundary::of(self.plane()?)?.edges {
            list.push(segment_corners(&edge.segment, pitch), edge.inside as i64);
        }
        Ok(list)
    }

    /// The outlines of a plane region.
    pub fn outlines(&self) -> Result<Vec<Outline>> {
        outlines(self.plane()?)
    }

    /// The exact length or volume; that of the plane follows from the outlines.
    pub fn measure(&self, pitch: Pitch) -> Result<Fraction> {
        match self {
            Self::Line(tree) => moments::length(tree, pitch),
            Self::Plane(tree) => Ok(moments::area(&outlines(tree)?, pitch)),
            Self::Space(tree) => moments::volume(tree, pitch),
        }
    }

    /// The stretches of a line inside a plane region.
    pub fn cast(&self, origin: [f64; 2], direction: [f64; 2], pitch: Pitch) -> Result<PieceList> {
        let line = line_along([pitch.snap(origin[0])?, pitch.snap(origin[1])?], direction)?;
        let mut list = PieceList::new();
        for stretch in cast(self.plane()?, &line)? {
            list.push(stretch.map(|p| pitch.position_in_plane(&p)), 0);
        }
        Ok(list)
    }

    /// Where points lie, snapped to the lattice.
    pub fn classify(&self, points: &[Vec<f64>], pitch: Pitch) -> Result<Vec<Location>> {
        let snap = |row: &Vec<f64>| -> Result<Vec<i64>> {
            if row.len() != self.dimension() {
                return Err(shape(format!(
                    "points must have {} numbers",
                    self.dimension()
                )));
            }
            row.iter().map(|x| pitch.snap(*x)).collect()
        };
        let place = |row: &Vec<f64>| {
            let p = snap(row)?;
            Ok(match self {
                Self::Line(tree) => classify(tree, &p[0]),
                Self::Plane(tree) => classify(tree, &Point2::lattice([p[0], p[1]])),
                Self::Space(tree) => classify(tree, &Vertex::lattice([p[0], p[1], p[2]])),
            })
        };
        points.iter().map(place).collect()
    }

    fn plane(&self) -> Result<&PartitionTree<Dim2>> {
        match self {
            Self::Plane(tree) => Ok(tree),
            _ => Err(shape("only sets of the plane have outlines")),
        }
    }
}

/// The corners of outlines, each with the number of the one around it, or −1.
pub fn outline_pieces(outlines: &[Outline], pitch: Pitch) -> PieceList {
    let mut list = PieceList::new();
    for outline in outlines {
        let corners = outline.corners.iter().map(|p| pitch.position_in_plane(p));
        list.push(corners, outline.parent.map_or(-1, |p| p as i64));
    }
    list
}

/// The corners of an outline, exactly.
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
