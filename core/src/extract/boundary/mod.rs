//! The boundary as a tree lists it: the fates of its sources' faces, and the rims of whole faces.

pub mod collect;
pub mod leaves;
pub mod rim;
