//! Computes the regions that outlines bound, and set operations on sets of the plane, by a sweep.
//!
//! A vertical line sweeps over the plane from left to right. It stores the segments that it meets in order
//! from below, and stops where a segment begins, ends or crosses its neighbour. Between two stops the winding
//! number of each gap between neighbouring segments is known. The boundary consists of the pieces of segments
//! that have the set on one side only. All predicates are exact.
//!
//! # Source
//! Bentley, Ottmann: *Algorithms for reporting and counting geometric intersections*. IEEE
//! Transactions on Computers 28, 1979. Mehlhorn, Näher: *LEDA*, 1999, section 10.7: segments that overlap,
//! or meet many at a time.

mod combine;
mod events;
mod input;
mod locate;
mod output;
mod status;
mod sweep;

pub use combine::{combined, composed, equal};
pub use input::{Outlines, Strand};
pub use locate::located;
pub use sweep::bounded;
