//! Trees of supporting hyperplanes over facets, which rays cause to grow, or which are complete from the
//! start.
//!
//! # Source
//! The augmented BSP tree: Ar, Montag, Tal 2002, "Deferred, self-organizing BSP trees"; lecture
//! notes on BSP trees, "Distribution optimized (self-organizing) BSP".
//!
//! # Example
//! ```
//! use bspcsg::geometry::spaces::dim2::Dim2;
//! use bspcsg::mesh::grid::Pitch;
//! use bspcsg::query::ray::{Ray, Scene};
//! use bspcsg::query::stab::node::Growth;
//! use bspcsg::query::stab::StabTree;
//!
//! let walls = [[[5.0, -9.0], [5.0, 9.0]], [[7.0, -9.0], [7.0, 9.0]]];
//! let scene = Scene::new(&walls, Some(Pitch::new(0)?))?;
//! // A leaf is divided after more than one visit.
//! let tree = StabTree::<Dim2, 2>::new(scene, Growth::Visits(1), None)?;
//! let ray = Ray::new([0; 2], &[1.0, 0.0])?;
//! for _ in 0..3 {
//!     tree.test_ray(&ray);
//! }
//! // The tree has grown where the rays went.
//! assert!(tree.shape().subdivisions > 0);
//! # Ok::<(), bspcsg::error::Error>(())
//! ```

pub mod batch;
pub mod cast;
pub mod heap;
pub mod record;
pub mod tree;
pub mod view;

mod cut;
pub mod node;
mod trace;
mod walk;

pub use cast::Cast;
pub use trace::{StabEvent, Trace};
pub use tree::StabTree;
