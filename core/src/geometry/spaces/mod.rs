//! The line, the plane and space behind one trait, and motions of their lattices.

pub mod affine;
pub mod axis;
pub mod dim1;
pub mod dim2;
pub mod dim3;
pub mod motion;
pub mod space;
