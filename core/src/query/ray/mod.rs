//! Exact ray casting in one, two and three dimensions.
//!
//! A scene holds facets with lattice corners: points on the line, segments in the plane, triangles
//! in space. A ray starts at a lattice point and has an integer direction; whether and where it
//! meets a facet is decided exactly, doubles only spare the integers where they are certain. So
//! the tree over the facets decides how fast an answer comes and never what it is.
//!
//! Layers, from the bottom: `bounds` < `ray` < `facet` | `filter` < `scene` | `node` < `closed` |
//! `walk` < `first` | `crossings` < `answer` < `batch`.

pub mod answer;
pub mod batch;
pub mod bounds;
pub mod closed;
pub mod crossings;
pub mod facet;
pub mod filter;
pub mod first;
pub mod node;
pub mod ratio;
pub mod scene;
pub mod walk;

mod line;

pub use line::Ray;
pub use ratio::Ratio;
pub use scene::Scene;
