//! The elements (faces and parts of faces) that meet a cell: short lists, which are divided with the cell,
//! and long ones sorted into bins.

pub(super) mod bins;
pub(super) mod crossings;
pub mod list;
pub mod separation;
pub(super) mod window;
