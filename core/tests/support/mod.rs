//! What the tests of solids share.
#![allow(dead_code, unused_imports, reason = "each test file uses its part")]

mod meshes;
mod shapes;
mod solids;
mod volumes;
mod voxels;

pub use meshes::{closed_mesh, manifold_mesh, triangle_set};
pub use shapes::{double, straight, turned, Numbers, Shape};
pub use solids::{applied, combined, complement, inside, is_empty, is_full, located, normalized};
pub use volumes::{sixfold_volume, volume, Ratio};
pub use voxels::Voxels;
