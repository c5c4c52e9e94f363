//! The page's coordinates and the lattice.

use bspcsg::geometry::plane::Lattice;

/// The exponent of ten of a lattice step on the page, whose unit is about a pixel.
pub const PITCH: i64 = -3;

/// Lattice steps for one unit of the page.
pub const STEPS: f64 = 1000.0;

/// The lattice point nearest to a coordinate of the page.
#[allow(clippy::cast_possible_truncation)] // The page keeps to a square of some hundred units.
pub fn snapped(x: f64) -> i64 {
    (x.clamp(-1e6, 1e6) * STEPS).round() as i64
}

/// Rows of `dimension` coordinates as lattice points; missing coordinates are zero.
pub fn lattice(flat: &[f64], dimension: usize) -> Vec<Lattice> {
    let row = |chunk: &[f64]| [0, 1, 2].map(|k| chunk.get(k).map_or(0, |x| snapped(*x)));
    flat.chunks_exact(dimension.max(1)).map(row).collect()
}

/// A position in lattice steps as one of the page.
pub fn on_page(steps: [f64; 3]) -> [f64; 3] {
    steps.map(|k| k / STEPS)
}
