//! Exact geometry: planes, points, convex pieces, and predicates that never round.

pub mod apart;
pub mod axes;
pub mod cell;
pub mod coordinates;
pub mod doubles;
pub mod edge;
pub mod flux;
pub mod line;
pub mod outline;
pub mod plane;
pub mod points;
pub mod polygon;
mod residue;
pub mod side;
pub mod spaces;
pub mod unbounded;
pub mod vertex;
pub mod vertices;
pub mod winding;
