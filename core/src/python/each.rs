//! The tree of a set, and one expression for it, whatever its dimension.

use crate::geometry::dim1::Dim1;
use crate::geometry::dim2::Dim2;
use crate::geometry::dim3::Dim3;
use crate::tree::partition::PartitionTree;

/// A set of points as a partition tree.
#[derive(Clone, Debug)]
pub enum Set {
    /// On the line.
    Line(PartitionTree<Dim1>),
    /// In the plane.
    Plane(PartitionTree<Dim2>),
    /// In space.
    Space(PartitionTree<Dim3>),
}

/// The value of an expression generic over the space.
macro_rules! each {
    ($set:expr, $tree:ident => $value:expr) => {
        match $set {
            $crate::python::each::Set::Line($tree) => $value,
            $crate::python::each::Set::Plane($tree) => $value,
            $crate::python::each::Set::Space($tree) => $value,
        }
    };
}

/// The set whose tree is the value of an expression generic over the space.
macro_rules! map_each {
    ($set:expr, $tree:ident => $value:expr) => {
        match $set {
            $crate::python::each::Set::Line($tree) => $crate::python::each::Set::Line($value),
            $crate::python::each::Set::Plane($tree) => $crate::python::each::Set::Plane($value),
            $crate::python::each::Set::Space($tree) => $crate::python::each::Set::Space($value),
        }
    };
}

pub(super) use {each, map_each};
