//! A set of any dimension, and a macro that evaluates one expression for its tree.

use crate::geometry::spaces::dim1::Dim1;
use crate::geometry::spaces::dim3::Dim3;
use crate::tree::partition::PartitionTree;
use crate::tree::plane::PlaneSet;

/// A set of points: a partition tree or, in the plane, a boundary or a tree.
#[derive(Clone, Debug)]
pub enum Set {
    /// A set on the line.
    Line(PartitionTree<Dim1>),
    /// A set in the plane.
    Plane(PlaneSet),
    /// A set in space.
    Space(PartitionTree<Dim3>),
}

/// Evaluates an expression with the tree of a set, in any dimension, inside a function that may fail.
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
