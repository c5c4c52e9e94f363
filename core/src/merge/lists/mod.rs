//! The elements that meet a cell: lists of them, divided with the cells, and bins for long ones.

pub(super) mod bins;
pub(super) mod crossings;
pub mod list;
pub mod separation;
pub(super) mod window;
