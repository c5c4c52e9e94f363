//! Stores a few facets coordinate by coordinate, so that one ray is tested against all of them at once.

use super::facet::Facet;

/// The number of facets in a block.
pub const LANES: usize = 4;

/// Up to [`LANES`] facets, stored coordinate by coordinate.
#[derive(Clone, Debug)]
pub struct Block<const D: usize> {
    /// The coordinates, by corner, axis and lane, in lattice steps; lanes without a facet repeat the first
    /// facet.
    pub corners: [[[f64; LANES]; D]; D],
    facets: [u32; LANES],
    len: u32,
}

impl<const D: usize> Block<D> {
    /// Makes a block of the facets with the indices in `list`, at least one and at most [`LANES`].
    pub fn of(scene: &[Facet<D>], list: impl IntoIterator<Item = u32>) -> Self {
        let mut facets = [0; LANES];
        let mut len = 0;
        for facet in list {
            facets[len] = facet;
            len += 1;
        }
        let first = facets[0];
        facets[len..].fill(first);
        let of = |lane: usize| &scene[facets[lane] as usize];
        Self {
            corners: std::array::from_fn(|i| {
                std::array::from_fn(|k| std::array::from_fn(|lane| of(lane)[i][k]))
            }),
            facets,
            len: len as u32,
        }
    }

    /// The indices of the facets in the scene.
    #[inline]
    pub fn facets(&self) -> &[u32] {
        &self.facets[..self.len as usize]
    }

    /// The corners of the facet in a lane of the block.
    #[inline]
    pub fn lane(&self, lane: usize) -> Facet<D> {
        let mut facet = [[0.0; D]; D];
        for (corner, lanes) in facet.iter_mut().zip(&self.corners) {
            for (c, lanes) in corner.iter_mut().zip(lanes) {
                *c = lanes[lane];
            }
        }
        facet
    }
}
