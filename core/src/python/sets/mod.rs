//! The class `ObjectTree`: sets of points of any dimension.

pub mod any_set;
pub mod each;
pub mod input;
pub mod objects;
pub mod pieces;
pub mod queries;
pub mod store;
pub mod traces;
