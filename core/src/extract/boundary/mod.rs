//! The boundary as a tree lists it: the fates of source faces, and the edges where whole faces end.

pub mod collect;
pub mod leaves;
pub mod rim;
