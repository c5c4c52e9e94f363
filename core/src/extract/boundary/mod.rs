//! The boundary as a tree lists it: whether each source face is whole, cut or gone, and the edges at which
//! whole faces end.

pub mod collect;
pub mod leaves;
pub mod rim;
