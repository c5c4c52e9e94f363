//! Coefficients, corners, boxes and measures of hyperplanes and fragments, as numbers.
//!
//! [`Space`] says how points, hyperplanes and fragments lie relative to each other, without coordinates. The
//! trait [`Affine`] adds numbers, for axis-parallel cuts, viewpoints, measures and output.

mod line;
mod plane;
mod region;
mod space3;
mod view;

use num_bigint::BigInt;

pub use region::Polytope;
pub use view::Viewpoint;

use crate::geometry::plane::Lattice;
use crate::geometry::side::{Side, Split};
use crate::geometry::spaces::space::Space;

/// A space whose hyperplanes and fragments have numeric coordinates, in lattice steps.
///
/// The line and the plane use the first one or two of three coordinates; the others are zero.
pub trait Affine: Space {
    /// The frame: a convex body around all lattice points.
    const EVERYTHING: Self::Frame;

    /// The largest coordinate, in magnitude, of a hyperplane across an axis.
    const MAX_COORDINATE: i64;

    /// The convex fragment with these corners; `None` if it has no relative interior.
    ///
    /// In 1D one corner, with smaller coordinates on its minus side; in 2D two, with the minus side to the
    /// left; in 3D the corners of a convex polygon, counterclockwise seen from the plus side.
    fn fragment(corners: &[Lattice]) -> Option<Self::Fragment>;

    /// The coefficients n and d of n·x + d = 0 in doubles, each within half a unit in the last place.
    fn approx(cut: &Self::Hyperplane) -> [f64; 4];

    /// The exact coefficients n and d of n·x + d = 0.
    fn exact(cut: &Self::Hyperplane) -> [BigInt; 4];

    /// The hyperplane `x[axis] = at`, with smaller coordinates on its minus side.
    ///
    /// `None` if |at| exceeds [`Affine::MAX_COORDINATE`] or there is no such axis.
    fn axis_cut(axis: usize, at: i64) -> Option<Self::Hyperplane>;

    /// The corners of a fragment in order, each coordinate within a few units in the last place.
    fn corners(piece: &Self::Fragment) -> Vec<[f64; 3]>;

    /// For each corner of a piece of a facet, whether the edge that leaves the corner lies on an edge of the
    /// facet.
    ///
    /// `facet` has the facet's corners; facet edges that `seams` marks count as not on the facet's border. In
    /// 2D: for each end of the piece, whether it is an end of the facet.
    fn original_edges(piece: &Self::Fragment, facet: &[Lattice], seams: &[bool]) -> Vec<bool>;

    /// Return how `piece` lies relative to `cut`, without computing its parts.
    fn relation(piece: &Self::Fragment, cut: &Self::Hyperplane) -> Split<()>;

    /// The measure of a fragment: 1 in 1D, length in 2D, area in 3D, in lattice steps.
    fn size(piece: &Self::Fragment) -> f64;

    /// The signed length, area or volume of the cone from `apex` over a fragment; positive if `apex` is on
    /// the minus side.
    fn cone_measure(piece: &Self::Fragment, apex: &[f64; 3]) -> f64;

    /// The least and the greatest coordinates of a fragment's corners, as rounded in [`Affine::corners`].
    fn bounds(piece: &Self::Fragment) -> [[f64; 3]; 2] {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for corner in Self::corners(piece) {
            for i in 0..3 {
                low[i] = low[i].min(corner[i]);
                high[i] = high[i].max(corner[i]);
            }
        }
        [low, high]
    }
}

/// The position of a convex set relative to a hyperplane, from the sides on which its corners lie.
fn relation_of(sides: impl Iterator<Item = Side>) -> Split<()> {
    let (mut minus, mut plus) = (false, false);
    for side in sides {
        minus |= side == Side::Minus;
        plus |= side == Side::Plus;
    }
    match (minus, plus) {
        (true, true) => Split::Both {
            minus: (),
            plus: (),
        },
        (false, true) => Split::Plus,
        // Fragments lie in no hyperplane but their own.
        _ => Split::Minus,
    }
}
