//! The trait with the geometric predicates that a partition tree needs, in any dimension.
//!
//! `tree::partition` and `merge` use only [`Space`], so a law of trees that is tested exhaustively on the
//! line also holds in the plane and in space. Invariant: no fragment is empty or of lower dimension than its
//! hyperplane.
//!
//! # Example
//! ```
//! use bspcsg::geometry::spaces::dim1::{Dim1, Direction, Point1};
//! use bspcsg::geometry::spaces::dim2::{Dim2, Line2, Segment2};
//! use bspcsg::geometry::side::{Side, Split};
//! use bspcsg::geometry::spaces::space::Space;
//!
//! // On the line a hyperplane is a point, with the inside on one side of it.
//! assert_eq!(Dim1::side(&Point1::new(3, Direction::Below), &2), Side::Minus);
//! // In the plane it is a line, and cuts segments.
//! let segment = Segment2::between([0, 0], [4, 0]).expect("two points");
//! let line = Line2::through([1, 0], [1, 1]).expect("two points");
//! assert!(matches!(Dim2::split(&segment, &line), Split::Both { .. }));
//! ```

use std::fmt::Debug;
use std::hash::Hash;

use crate::geometry::side::{Half, Orientation, Side, Split};

/// A space of fixed dimension, as partition trees see it.
///
/// It has four exact predicates (`side`, `coincide`, `split`, `span`) and three views of a fragment
/// (`hyperplane`, `reversed`, `rims`). The minus side of a hyperplane is its inside.
pub trait Space: Copy + Debug + Send + Sync + 'static {
    /// The number of dimensions: 1, 2 or 3.
    const DIM: usize;

    /// A point that can be tested against hyperplanes.
    type Point: Clone + Debug + Send + Sync;

    /// An oriented point of the line, line of the plane or plane of space.
    type Hyperplane: Clone + Eq + Hash + Debug + Send + Sync;

    /// A convex piece of one hyperplane: a point (1D), a segment (2D), a convex polygon (3D).
    type Fragment: Clone + Debug + Send + Sync;

    /// The convex body in which trees are built; its border is not part of any set's boundary.
    type Frame: Clone + Debug + Send + Sync;

    /// The side of `cut` on which a point lies.
    fn side(cut: &Self::Hyperplane, point: &Self::Point) -> Side;

    /// The orientation of `a` relative to `b` if they are the same set of points, else `None`.
    fn coincide(a: &Self::Hyperplane, b: &Self::Hyperplane) -> Option<Orientation>;

    /// Splits `piece` by `cut`: returns the side on which it lies, or its two parts if `cut` crosses it.
    fn split(piece: &Self::Fragment, cut: &Self::Hyperplane) -> Split<Self::Fragment>;

    /// The part of `cut` inside `frame`; `None` if `cut` does not cross the frame's interior.
    fn span(cut: &Self::Hyperplane, frame: &Self::Frame) -> Option<Self::Fragment>;

    /// The hyperplane of a fragment, oriented as the fragment is.
    fn hyperplane(piece: &Self::Fragment) -> &Self::Hyperplane;

    /// The same piece with the orientation of its hyperplane reversed.
    fn reversed(piece: &Self::Fragment) -> Self::Fragment;

    /// Hyperplanes through the ends or edges of a fragment, crossing its own, with the fragment on their
    /// minus sides.
    ///
    /// They serve to compare coplanar fragments, between which a `split` by the common hyperplane does not
    /// distinguish.
    fn rims(piece: &Self::Fragment) -> Vec<Self::Hyperplane>;
}

/// The part of `piece` on one side of `cut`; `None` if it has no relative interior.
pub fn clip<S: Space>(piece: S::Fragment, cut: &S::Hyperplane, half: Half) -> Option<S::Fragment> {
    match (S::split(&piece, cut), half) {
        (Split::Minus, Half::Minus) | (Split::Plus, Half::Plus) => Some(piece),
        (Split::Both { minus, .. }, Half::Minus) => Some(minus),
        (Split::Both { plus, .. }, Half::Plus) => Some(plus),
        _ => None,
    }
}

/// Divides `piece` by the outline of a coplanar fragment `mask`: returns the part of the piece inside the
/// mask, if any, and the parts outside.
///
/// # Order
/// The outside parts follow the order of the mask's rims.
pub fn overlay<S: Space>(
    piece: S::Fragment,
    mask: &S::Fragment,
) -> (Option<S::Fragment>, Vec<S::Fragment>) {
    let mut outside = Vec::new();
    let mut rest = piece;
    for rim in S::rims(mask) {
        match S::split(&rest, &rim) {
            Split::Minus => {}
            Split::Both { minus, plus } => {
                outside.push(plus);
                rest = minus;
            }
            // A rim's hyperplane is never the mask's own, so a coplanar piece is not inside.
            Split::Plus | Split::Coplanar(_) => return (None, vec_with(outside, rest)),
        }
    }
    (Some(rest), outside)
}

fn vec_with<T>(mut list: Vec<T>, last: T) -> Vec<T> {
    list.push(last);
    list
}

/// The region of a node of a tree: a frame, cut off by the half-spaces along the path from the root.
#[derive(Clone, Debug)]
pub struct Region<S: Space> {
    frame: S::Frame,
    bounds: Vec<(S::Hyperplane, Half)>,
}

impl<S: Space> Region<S> {
    /// The region of a root: the whole frame.
    pub fn new(frame: S::Frame) -> Self {
        let bounds = Vec::new();
        Self { frame, bounds }
    }

    /// The number of half-spaces that bound the region.
    pub fn depth(&self) -> usize {
        self.bounds.len()
    }

    /// Narrows the region to one side of a cut.
    pub fn push(&mut self, cut: S::Hyperplane, half: Half) {
        self.bounds.push((cut, half));
    }

    /// Removes all half-spaces from the region except the first `depth`.
    pub fn truncate(&mut self, depth: usize) {
        self.bounds.truncate(depth);
    }

    /// The part of `cut` inside this region; `None` if the cut does not cross the interior.
    ///
    /// # Cost
    /// One split per half-space.
    pub fn span(&self, cut: &S::Hyperplane) -> Option<S::Fragment> {
        self.clip(S::span(cut, &self.frame)?)
    }

    /// The faces of this region that lie in its cuts, with the region on their minus sides; the frame's
    /// border is left out.
    pub fn faces(&self) -> Vec<S::Fragment> {
        let face = |i: usize| {
            let (cut, half) = &self.bounds[i];
            let others = self.bounds.iter().enumerate().filter(|(j, _)| *j != i);
            let whole = S::span(cut, &self.frame)?;
            let mut sides = others.map(|(_, (other, side))| (other, *side));
            let face = sides.try_fold(whole, |rest, (other, side)| clip::<S>(rest, other, side))?;
            Some(match half {
                Half::Minus => face,
                Half::Plus => S::reversed(&face),
            })
        };
        (0..self.bounds.len()).filter_map(face).collect()
    }

    /// The part of a fragment inside all of the region's half-spaces; `None` if it has no relative interior.
    pub fn clip(&self, piece: S::Fragment) -> Option<S::Fragment> {
        self.bounds
            .iter()
            .try_fold(piece, |rest, (cut, half)| clip::<S>(rest, cut, *half))
    }
}
