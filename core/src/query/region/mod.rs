//! Queries of sets of the line and the plane: outlines, measures, lines through them, sections.
//!
//! # Example
//! ```
//! use bspcsg::geometry::spaces::dim2::{Dim2, Segment2};
//! use bspcsg::mesh::grid::Pitch;
//! use bspcsg::query::region::moments::area;
//! use bspcsg::query::region::outlines::outlines;
//! use bspcsg::tree::partition::{enclosed, Facet, PartitionTree, Plan};
//! use bspcsg::tree::plane::Boundary;
//!
//! let corners = [[0, 0], [4, 0], [4, 3], [0, 3]];
//! let sides = (0..4).map(|i| Facet {
//!     fragment: Segment2::between(corners[i], corners[(i + 1) % 4]).expect("two points"),
//!     source: 0,
//! });
//! let rectangle: PartitionTree<Dim2> = enclosed(sides.collect(), 0, |w| w > 0, &Plan::BALANCED)?;
//! let boundary = Boundary::of(&rectangle)?;
//! let loops = outlines(&boundary)?;
//! assert_eq!(loops[0].corners.len(), 4);
//! assert_eq!(area(&boundary, Pitch::new(0)?)?.numerator, 12.into());
//! # Ok::<(), bspcsg::error::Error>(())
//! ```

pub mod cast;
pub mod condense;
pub mod hyperplane;
pub mod moments;
pub mod nearest;
pub mod outlines;
pub mod section;
pub mod solid;
