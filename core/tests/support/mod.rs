//! Helpers that the tests of solids share.
#![allow(dead_code, unused_imports, reason = "each test file uses its part")]

mod meshes;
mod shapes;
mod solids;
mod volumes;
mod voxels;

pub use meshes::{assert_same_set, assert_same_triangles, manifold_mesh};
pub use shapes::{double, straight, turned, Numbers, Shape, LIMIT};
pub use solids::{
    applied, combined, complement, inside, is_empty, is_full, located, normalized, wanted,
};
pub use volumes::{sixfold_volume, volume, Ratio};
pub use voxels::{square, Voxels};
