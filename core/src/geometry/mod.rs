//! Exact predicates, planes, points and convex pieces.

pub mod affine;
pub mod apart;
pub mod axes;
pub mod axis;
pub mod cell;
pub mod coordinates;
pub mod crossing;
pub mod dim1;
pub mod dim2;
pub mod dim3;
pub mod doubles;
pub mod edge;
pub mod extent;
pub mod fixed;
pub mod hull;
pub mod line;
pub mod meeting;
pub mod motion;
pub mod outline;
pub mod path;
pub mod plane;
pub mod polygon;
mod residue;
pub mod side;
pub mod space;
pub mod trim;
pub mod vertex;
