//! Partition trees over any facets: points, segments or convex polygons, closed or not.
//!
//! A tree of `tree::partition` represents a set and labels its leaves; a fragment tree represents its facets.
//! Each facet lies, perhaps in parts, in the coplanar sets of nodes, and every leaf is an empty region. Nodes
//! are in one list in preorder, minus before plus; regions and sub-hyperplanes are not stored, but computed
//! from the path to the root on demand.
//!
//! # Source
//! Fuchs, Kedem, Naylor 1980; Paterson, Yao 1990; de Berg et al., Computational Geometry, chapter 12.
//!
//! # Example
//! ```
//! use bspcsg::geometry::spaces::affine::{Affine, Viewpoint};
//! use bspcsg::geometry::spaces::dim2::Dim2;
//! use bspcsg::mesh::handle::NodeId;
//! use bspcsg::tree::fragments::{back_to_front, build, Piece, Plan, Policy};
//!
//! // Two walls, one behind the other, seen from far above.
//! let walls = [[[0, 0, 0], [9, 0, 0]], [[0, 5, 0], [9, 5, 0]]];
//! let pieces = (0..).zip(walls).map(|(number, corners)| {
//!     let fragment = Dim2::fragment(&corners).expect("a segment");
//!     Piece::<Dim2> { fragment, number }
//! });
//! let plan = Plan::Policy { policy: Policy::First, top: None, region: None };
//! let tree = build(pieces.collect(), plan)?;
//! let eye = Viewpoint::direction(&[0.0, 1.0, 0.0]);
//! assert_eq!(back_to_front(&tree, &eye), [NodeId(0), NodeId(1)]);
//! # Ok::<(), bspcsg::error::Error>(())
//! ```

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss
)]

mod axis;
mod build;
mod choosing;
mod measure;
mod node;
mod order;
mod perfect;
mod plan;
mod policy;
mod trace;

pub use build::{build, build_watched};
pub use measure::{measures, Measure};
pub use node::{Crossing, Fragment, FragmentTree, Node, NodeCut, Piece};
pub use order::{back_to_front, sides};
pub use perfect::{perfect, PERFECT_LIMIT};
pub use plan::{Answer, AnswerCallback, Ask, Lines, Plan};
pub use policy::{Policy, Sample};
pub use trace::{Candidate, Division, Reason};
