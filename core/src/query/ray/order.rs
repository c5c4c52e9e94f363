//! Sorts rays for casting, so that rays with similar starts and directions follow each other.
//!
//! Unsorted rays each read different memory; sorted rays share it, and often form bundles. The order does
//! not affect results: answers come in the order of the input.

use super::cell::Frame;

/// The number of bits per axis, in the sort key, for the point where a ray enters the scene.
const BITS_PER_AXIS: u32 = 7;

/// The smallest number of rays that are sorted: the nodes that fewer rays visit stay in the cache.
const SORT_FROM: usize = 256;

/// Rays are not sorted if, of their neighbouring pairs, at least one in this many is similar already.
const UNSORTED_IF_ONE_IN: usize = 2;

/// The similarity of one in this many neighbouring pairs is sampled.
const SAMPLED_IF_ONE_IN: usize = 16;

/// Returns the numbers of rays in the order in which to cast them; `None` for the order of the input.
///
/// `ray` gives the origin and the direction, in lattice steps up to rounding.
pub fn sorted<const D: usize>(
    count: usize,
    frame: &Frame<D>,
    ray: impl Fn(usize) -> ([f64; D], [f64; D]),
) -> Option<Vec<u32>> {
    if count < SORT_FROM {
        return None;
    }
    let count = u32::try_from(count).ok()?;
    let key = |i: u32| {
        let (origin, direction) = ray(i as usize);
        key(frame, &origin, &direction)
    };
    // Keys of similar rays agree in all but the last bit on each axis.
    let alike = |i: &u32| (key(*i) ^ key(*i + 1)) >> D == 0;
    let pairs = (0..count - 1).step_by(SAMPLED_IF_ONE_IN);
    if pairs.clone().filter(alike).count() * UNSORTED_IF_ONE_IN >= pairs.len() {
        return None;
    }
    let mut keys: Vec<(u32, u32)> = (0..count).map(|i| (key(i), i)).collect();
    keys.sort_unstable();
    Some(keys.into_iter().map(|(_, i)| i).collect())
}

/// Returns the sort key: the octant of a direction, its main axis, and the point where the ray enters the
/// scene's interval on that axis, with the bits of all axes interleaved.
fn key<const D: usize>(frame: &Frame<D>, origin: &[f64; D], direction: &[f64; D]) -> u32 {
    let size = |k: &usize| direction[*k].abs();
    let main = (0..D)
        .max_by(|a, b| size(a).total_cmp(&size(b)))
        .unwrap_or(0);
    let lead = direction[main].abs();
    let at: [f64; D] = std::array::from_fn(|k| frame.inward(k, origin[k]));
    let skipped = (-1.0 - at[main] * direction[main].signum()).max(0.0);
    let mut key = 0;
    let mut cells = [0u32; D];
    for k in 0..D {
        let octant = u32::from(direction[k] < 0.0);
        key |= (octant << 1 | u32::from(k == main)) << (D as u32 * BITS_PER_AXIS + 2 * k as u32);
        let entry = at[k] + direction[k] / lead * skipped;
        // Coordinates outside the range, and NaN, go to its ends.
        cells[k] = ((entry + 1.0) * f64::from(1 << (BITS_PER_AXIS - 1)))
            .clamp(0.0, f64::from((1 << BITS_PER_AXIS) - 1)) as u32;
    }
    for bit in 0..BITS_PER_AXIS {
        for (k, cell) in cells.iter().enumerate() {
            key |= (cell >> bit & 1) << (bit * D as u32 + k as u32);
        }
    }
    key
}
