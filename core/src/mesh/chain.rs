//! Tests whether the boundary of a surface vanishes, by a hash instead of pairing edges.

use super::handle::VertexId;
use super::tasks::each_chunk;
use crate::arith::convert::low_limb;

/// Return whether every directed edge occurs as often as its opposite.
///
/// Each edge has a hash of 128 bits, added for one direction and subtracted for the other, modulo 2^128. For
/// a closed surface the sum is zero, in any order of the faces. For an open surface it is zero with
/// probability 2^-128.
pub fn is_closed(faces: &[[VertexId; 3]]) -> bool {
    let sum = |_, faces: &[[VertexId; 3]]| faces.iter().map(boundary).fold(0, u128::wrapping_add);
    let sums = each_chunk(faces, sum);
    sums.into_iter().fold(0, u128::wrapping_add) == 0
}

fn boundary([a, b, c]: &[VertexId; 3]) -> u128 {
    directed(*a, *b)
        .wrapping_add(directed(*b, *c))
        .wrapping_add(directed(*c, *a))
}

fn directed(from: VertexId, to: VertexId) -> u128 {
    let number = scattered(u64::from(from.min(to).0) << 32 | u64::from(from.max(to).0));
    if from < to {
        number
    } else {
        number.wrapping_neg()
    }
}

/// Constants without pattern: the first 64 binary digits after the point of √2, √3, √5 and √7.
const SALT: [u64; 4] = [
    0x6A09_E667_F3BC_C908,
    0xBB67_AE85_84CA_A73B,
    0x3C6E_F372_FE94_F82B,
    0xA54F_F53A_5F1D_36F1,
];

/// A hash of the key in which each bit of it matters: two rounds of multiplication and folding.
fn scattered(key: u64) -> u128 {
    let first = u128::from(key ^ SALT[0]) * u128::from(key.rotate_left(29) ^ SALT[1]);
    let (low, high) = (low_limb(first), (first >> 64) as u64);
    let second = u128::from(low ^ SALT[2]) * u128::from(high ^ SALT[3]);
    second ^ first.rotate_left(64)
}

#[cfg(test)]
mod tests {
    use super::{is_closed, VertexId};
    use proptest::prelude::*;

    proptest! {
        /// Vertices are few, so that edges repeat and sometimes all cancel.
        #[test]
        fn closed_is_what_a_count_of_edges_says(
            faces in prop::collection::vec(prop::array::uniform3(0u32..5), 0..6),
            twins in any::<bool>(),
        ) {
            let proper = |f: &[u32; 3]| f[0] != f[1] && f[1] != f[2] && f[2] != f[0];
            let mut faces: Vec<_> = faces.into_iter().filter(proper).collect();
            if twins {
                let back: Vec<_> = faces.iter().map(|[a, b, c]| [*b, *a, *c]).collect();
                faces.extend(back);
            }
            let mut sums = [[0i32; 5]; 5];
            for [a, b, c] in &faces {
                for (from, to) in [(*a, *b), (*b, *c), (*c, *a)] {
                    sums[from as usize][to as usize] += 1;
                    sums[to as usize][from as usize] -= 1;
                }
            }
            let faces: Vec<_> = faces.into_iter().map(|f| f.map(VertexId)).collect();
            prop_assert_eq!(is_closed(&faces), sums.iter().flatten().all(|s| *s == 0));
        }
    }
}
