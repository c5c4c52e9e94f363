//! Partition trees of sets, generic over the dimension.
//!
//! A tree represents a set inside the region of its root: leaves are In or Out, cuts divide a region by a
//! hyperplane. Nodes are immutable and shared; no function here recurses, since a convex body of n faces is a
//! chain of depth n. Invariants, verified by [`check`]: the span of a node is its cut inside its region, the
//! coplanar set lies in the span, and no cut has two equal leaves.
//!
//! # Source
//! Fuchs, Kedem, Naylor 1980; Thibault, Naylor 1987.
//!
//! # Example
//! ```
//! use bspcsg::geometry::spaces::dim1::{Dim1, Direction, Point1};
//! use bspcsg::tree::partition::{
//!     autopartition, classify, Facet, Label, Location, PartitionTree, PivotPolicy,
//! };
//!
//! // The points between 0 and 10 on the line.
//! let ends = [(0, Direction::Above), (10, Direction::Below)];
//! let facets = ends.map(|(at, inside)| Facet { fragment: Point1::new(at, inside), source: 0 });
//! let built = autopartition(facets.to_vec(), (), Label::Out, PivotPolicy::First)?;
//! let between: PartitionTree<Dim1> = built.tree;
//! assert_eq!(classify(&between, &5), Location::In);
//! assert_eq!(classify(&between, &10), Location::On);
//! # Ok::<(), bspcsg::error::Error>(())
//! ```

mod boundary;
mod bounded;
mod build;
mod cells;
mod classify;
mod components;
mod enclose;
mod flat;
mod node;
mod policy;
mod preorder;
mod random;
mod stats;
mod winding;

pub use boundary::{boundary, boundary_of, owned_boundary};
pub use bounded::is_bounded;
pub use build::{autopartition, partition, Built};
pub use cells::cells;
pub use classify::{classify, classify_corner, Location};
pub use components::{walls, Wall};
pub use enclose::{enclosed, Plan};
pub use node::{Cut, Facet, Label, PartitionTree, SubHyperplane};
pub use policy::PivotPolicy;
pub use preorder::{from_preorder, preorder, Entry};
pub use random::SplitMix;
pub use stats::{check, stats, TreeStats};
pub use winding::{winding_tree, Winding};
