//! What a tree says of the faces of its sources, and where whole faces end.

pub mod collect;
pub mod leaves;
pub mod rim;
