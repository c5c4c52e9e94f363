//! Partition trees over arbitrary facets: points, segments, convex polygons, closed or not.
//!
//! Where `tree::partition` stands for a set and labels its leaves, a fragment tree stands for its
//! facets: each lies, perhaps in parts, in the coplanar sets of the nodes, and every leaf is an
//! empty region. Nodes live in one list in preorder, minus before plus; neither regions nor
//! sub-hyperplanes are stored, since the way from the root yields them when asked for.
//!
//! # Source
//! Fuchs, Kedem, Naylor 1980; Paterson, Yao 1990; de Berg et al., Computational Geometry, chapter 12.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss
)]

mod axis;
mod build;
mod choice;
mod measure;
mod node;
mod order;
mod perfect;
mod trace;

pub use build::{build, build_watched, Plan};
pub use choice::{Policy, Sample};
pub use measure::{measures, Measure};
pub use node::{Crossing, Fragment, FragmentTree, Node, NodeCut, Piece};
pub use order::{back_to_front, sides};
pub use perfect::{perfect, PERFECT_LIMIT};
pub use trace::{Candidate, Division, Reason};
