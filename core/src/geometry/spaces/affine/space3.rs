//! Coefficients, coordinates and measures in space.

use std::sync::Arc;

use num_bigint::BigInt;

use super::Affine;
use crate::arith::bounds::MAX_COORDINATE;
use crate::geometry::cell::Cell;
use crate::geometry::doubles::vector::{cross, difference, dot};
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::polygon::{Carrier, Polygon};
use crate::geometry::side::Split;
use crate::geometry::spaces::dim3::Dim3;
use crate::geometry::spaces::space::Space;

/// The plane through a convex polygon, computed from its first corner and the first two consecutive corners
/// that are not on one line with it.
fn plane_of(corners: &[Lattice]) -> Option<Plane> {
    let (first, rest) = corners.split_first()?;
    rest.windows(2)
        .find_map(|pair| Plane::through(first, &pair[0], &pair[1]))
}

/// The vector along a polygon's normal whose length is twice the polygon's area: the sum of a fan's cross
/// products.
fn area_vector(corners: &[[f64; 3]]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for pair in corners.get(1..).unwrap_or_default().windows(2) {
        let arm = |p: &[f64; 3]| difference(p, &corners[0]);
        let normal = cross(&arm(&pair[0]), &arm(&pair[1]));
        for i in 0..3 {
            sum[i] += normal[i];
        }
    }
    sum
}

impl Affine for Dim3 {
    const EVERYTHING: Cell = Cell::UNIVERSE;
    const MAX_COORDINATE: i64 = MAX_COORDINATE - 1;

    fn fragment(corners: &[Lattice]) -> Option<Polygon> {
        let support = Arc::new(plane_of(corners)?);
        Some(Polygon::convex(corners, support))
    }

    fn approx(cut: &Arc<Plane>) -> [f64; 4] {
        *cut.approx()
    }

    fn exact(cut: &Arc<Plane>) -> [BigInt; 4] {
        let bytes: Vec<u8> = cut
            .offset()
            .limbs()
            .iter()
            .flat_map(|limb| limb.to_le_bytes())
            .collect();
        let [a, b, c] = cut.normal().map(BigInt::from);
        [a, b, c, BigInt::from_signed_bytes_le(&bytes)]
    }

    fn axis_cut(axis: usize, at: i64) -> Option<Arc<Plane>> {
        (axis < 3 && at.abs() <= Self::MAX_COORDINATE)
            .then(|| Arc::new(Plane::axis_cut(axis, 2 * at)))
    }

    fn corners(piece: &Polygon) -> Vec<[f64; 3]> {
        piece.corners().iter().map(|c| c.at.approx()).collect()
    }

    fn original_edges(piece: &Polygon, facet: &[Lattice], seams: &[bool]) -> Vec<bool> {
        let on_edge = |carrier: &Carrier| match carrier {
            Carrier::Edge(edge) => facet
                .iter()
                .position(|corner| corner == edge.ends().0)
                .is_some_and(|edge| !seams.get(edge).copied().unwrap_or(false)),
            Carrier::Cut(..) => false,
        };
        piece.corners().iter().map(|c| on_edge(&c.edge)).collect()
    }

    fn relation(piece: &Polygon, cut: &Arc<Plane>) -> Split<()> {
        if let Some(orientation) = Self::coincide(piece.support(), cut) {
            return Split::Coplanar(orientation);
        }
        super::relation_of(piece.corners().iter().map(|c| c.at.side_of(cut)))
    }

    fn size(piece: &Polygon) -> f64 {
        let normal = area_vector(&Self::corners(piece));
        dot(&normal, &normal).sqrt() / 2.0
    }

    fn cone_measure(piece: &Polygon, apex: &[f64; 3]) -> f64 {
        let corners = Self::corners(piece);
        let Some(first) = corners.first() else {
            return 0.0;
        };
        dot(&difference(first, apex), &area_vector(&corners)) / 6.0
    }
}
