//! Exact ray casting in one, two and three dimensions.
//!
//! A scene has facets with lattice corners: points on the line, segments in the plane, triangles in space. A
//! ray starts at a lattice point and has an integer direction. Whether and where it meets a facet is decided
//! exactly; doubles replace integers only where they are certain. So the hierarchy over the facets affects
//! the time of an answer, never the answer.
//!
//! Layers, from the bottom: `bounds` < `line` < `facet` | `block` < `filter` | `cell` < `divide` <
//! `treelet` < `closed` < `scene` < `bundle` | `order` | `view` < `walk` < `first` < `crossings` <
//! `narrow` < `answer` < `batch`.
//!
//! # Example
//! ```
//! use bspcsg::mesh::grid::Pitch;
//! use bspcsg::query::ray::answer::{hit, Kind};
//! use bspcsg::query::ray::first::Query;
//! use bspcsg::query::ray::{Ray, Scene};
//!
//! let wall = [[[5.0, -9.0, -9.0], [5.0, 9.0, -9.0], [5.0, 0.0, 9.0]]];
//! let scene = Scene::new(&wall, Some(Pitch::new(0)?))?;
//! let ray = Ray::new([0; 3], &[1.0, 0.0, 0.0])?;
//! let found = Query::new(&scene, &ray).first().expect("the wall stands in the way");
//! let hit = hit(&scene, &ray, &found);
//! assert_eq!((hit.t, hit.kind), (5.0, Kind::Interior));
//! # Ok::<(), bspcsg::error::Error>(())
//! ```

pub mod answer;
pub mod batch;
pub mod block;
pub mod bounds;
mod bundle;
pub mod cell;
pub mod closed;
pub mod crossings;
mod divide;
pub mod facet;
pub mod filter;
pub mod first;
pub mod narrow;
pub mod ratio;
pub mod scene;
pub mod treelet;
pub mod view;
pub mod walk;

mod line;
mod order;

pub use line::Ray;
pub use ratio::Ratio;
pub use scene::Scene;
