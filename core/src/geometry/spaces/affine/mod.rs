//! Partition trees as numbers: coefficients, corners, boxes, sizes.
//!
//! [`Space`] tells where things lie relative to each other, without coordinates. This trait has the
//! numbers, for axis-parallel cuts, viewpoints, measures and output.

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

/// A space with numeric coordinates, in lattice steps.
///
/// Spaces of fewer than three dimensions use the first coordinates and leave the others zero.
pub trait Affine: Space {
    /// The frame around all lattice points.
    const EVERYTHING: Self::Frame;

    /// The largest coordinate of hyperplanes in the frame.
    const REACH: i64;

    /// The convex fragment with these corners, if it has a relative interior.
    ///
    /// In 1D one corner, with smaller coordinates on its minus side; in 2D two, with the minus side to the
    /// left; in 3D the corners of a convex polygon, counterclockwise seen from the plus side.
    fn fragment(corners: &[Lattice]) -> Option<Self::Fragment>;

    /// The coefficients n, d of n·x + d, each within half a unit in the last place.
    fn approx(cut: &Self::Hyperplane) -> [f64; 4];

    /// The coefficients n, d of n·x + d.
    fn exact(cut: &Self::Hyperplane) -> [BigInt; 4];

    /// The hyperplane x[axis] = at with the smaller coordinates on its minus side.
    ///
    /// `None` beyond [`Affine::REACH`] or if there is no such axis.
    fn axis_cut(axis: usize, at: i64) -> Option<Self::Hyperplane>;

    /// The corners in order, each coordinate within a few units in the last place.
    fn corners(piece: &Self::Fragment) -> Vec<[f64; 3]>;

    /// For each corner, whether the edge that leaves it lies on an edge of the facet.
    ///
    /// `facet` has the corners of the facet that the piece was cut from. In 2D: whether this end is an end
    /// of the facet. `seams` marks edges of the facet that do not count.
    fn original(piece: &Self::Fragment, facet: &[Lattice], seams: &[bool]) -> Vec<bool>;

    /// Return the side of `cut` on which `piece` lies, without computing its parts.
    fn relation(piece: &Self::Fragment, cut: &Self::Hyperplane) -> Split<()>;

    /// The size of a fragment: 1 in 1D, length in 2D, area in 3D.
    fn size(piece: &Self::Fragment) -> f64;

    /// The signed size of the cone from `apex` over a fragment, positive on the minus side.
    fn cone(piece: &Self::Fragment, apex: &[f64; 3]) -> f64;

    /// The least and the largest coordinates of the corners, as in [`Affine::corners`].
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

/// The split of a convex piece, from the strict sides of its corners.
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
