//! The elements that meet a cell: lists, divided with the cells, and bins for long lists.

pub(super) mod bins;
pub(super) mod crossings;
pub mod list;
pub mod separation;
pub(super) mod window;
