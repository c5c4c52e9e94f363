//! The tree of a set, and one expression for it, whatever its dimension.

use crate::geometry::spaces::dim1::Dim1;
use crate::geometry::spaces::dim3::Dim3;
use crate::tree::partition::PartitionTree;
use crate::tree::plane::PlaneSet;

/// A set of points as a partition tree, or in the plane as what makes one.
#[derive(Clone, Debug)]
pub enum Set {
    /// On the line.
    Line(PartitionTree<Dim1>),
    /// In the plane.
    Plane(PlaneSet),
    /// In space.
    Space(PartitionTree<Dim3>),
}

/// The value of an expression generic over the space, inside a function that may fail.
macro_rules! each {
    ($set:expr, $tree:ident => $value:expr) => {
        match $set {
            $crate::python::sets::each::Set::Line($tree) => $value,
            $crate::python::sets::each::Set::Plane(set) => {
                let $tree = set.tree()?;
                $value
            }
            $crate::python::sets::each::Set::Space($tree) => $value,
        }
    };
}

pub(super) use each;
