//! One expression for the tree of a set, whatever its dimension.

/// The value of an expression generic over the space.
macro_rules! each {
    ($set:expr, $tree:ident => $value:expr) => {
        match $set {
            $crate::python::sets::Set::Line($tree) => $value,
            $crate::python::sets::Set::Plane($tree) => $value,
            $crate::python::sets::Set::Space($tree) => $value,
        }
    };
}

/// The set whose tree is the value of an expression generic over the space.
macro_rules! map_each {
    ($set:expr, $tree:ident => $value:expr) => {
        match $set {
            $crate::python::sets::Set::Line($tree) => $crate::python::sets::Set::Line($value),
            $crate::python::sets::Set::Plane($tree) => $crate::python::sets::Set::Plane($value),
            $crate::python::sets::Set::Space($tree) => $crate::python::sets::Set::Space($value),
        }
    };
}

pub(super) use {each, map_each};
