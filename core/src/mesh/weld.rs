//! Points with equal coordinates as one point.

use rustc_hash::FxHashMap;

use super::handle::VertexId;
use crate::arith::convert::as_number;
use crate::interrupt::poll;

/// The different points among some, in the order in which they first occur.
#[derive(Debug)]
pub struct Welded {
    /// Each point once, with 0.0 for -0.0.
    pub points: Vec<[f64; 3]>,
    /// For each given point, the number of its equal in `points`.
    pub same: Vec<VertexId>,
}

/// Finds the points whose coordinates are equal as numbers.
///
/// Linear in the points. There must be fewer than 2^32.
///
/// # Example
/// ```
/// use bspcsg::mesh::handle::VertexId;
/// use bspcsg::mesh::weld::welded;
///
/// let [a, b] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
/// assert_eq!(welded(&[a, b, a]).same, [0, 1, 0].map(VertexId));
/// ```
pub fn welded(points: &[[f64; 3]]) -> Welded {
    let mut numbers: FxHashMap<[u64; 3], VertexId> = FxHashMap::default();
    let mut different = Vec::new();
    let same = points
        .iter()
        .map(|point| {
            poll();
            let point = point.map(|x| x + 0.0);
            *numbers.entry(point.map(f64::to_bits)).or_insert_with(|| {
                different.push(point);
                VertexId(as_number(different.len()) - 1)
            })
        })
        .collect();
    Welded {
        points: different,
        same,
    }
}

#[cfg(test)]
mod tests {
    use super::{welded, VertexId};

    #[test]
    fn the_first_of_equal_points_stands_for_them() {
        let points = [[1.0, 0.0, 0.0], [0.0; 3], [1.0, -0.0, 0.0], [-0.0; 3]];
        let found = welded(&points);
        assert_eq!(found.same, [0, 1, 0, 1].map(VertexId));
        assert_eq!(found.points, [[1.0, 0.0, 0.0], [0.0; 3]]);
        assert!(found.points[0][1].is_sign_positive());
    }
}
