//! Welding: merges points with equal coordinates.

use super::handle::VertexId;
use crate::arith::convert::{as_number, low_limb};
use crate::interrupt::poll;

/// The result of welding: the different points of a list, in the order in which they first occur.
#[derive(Debug)]
pub struct Welded {
    /// Each different point once, with 0.0 instead of -0.0.
    pub points: Vec<[f64; 3]>,
    /// For each given point, the index of the equal point in `points`.
    pub same: Vec<VertexId>,
}

/// Merges the points whose coordinates are equal as numbers.
///
/// Takes time linear in the number of points, which must be below 2^32.
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
    let mut table = PointTable::default();
    let same = points
        .iter()
        .map(|[x, y, z]| {
            poll();
            table.number_of([x + 0.0, y + 0.0, z + 0.0])
        })
        .collect();
    Welded {
        points: table.points,
        same,
    }
}

/// Different points, and a hash table that finds them by their bits.
#[derive(Debug, Default)]
struct PointTable {
    points: Vec<[f64; 3]>,
    /// The number of slots is a power of two; at most half of them are occupied.
    slots: Vec<Slot>,
}

/// A slot of the hash table. It stores no coordinates, so that processor caches have room for four times as
/// many points.
#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    /// The index of a point plus one, or 0 if the slot is free.
    next: u32,
    hash: u32,
}

/// The number of slots of a table when its first point is added.
const INITIAL_SLOTS: usize = 64;

impl PointTable {
    /// The index of a point, which is added if no equal point is in the table.
    fn number_of(&mut self, point: [f64; 3]) -> VertexId {
        if self.slots.len() <= 2 * self.points.len() {
            self.grow();
        }
        let hash = hash_of(&point);
        let mut index = self.home_slot(hash);
        while self.slots[index].next != 0 {
            let number = VertexId(self.slots[index].next - 1);
            if self.slots[index].hash == hash && are_same(&self.points[number.index()], &point) {
                return number;
            }
            index = self.next_slot(index);
        }
        self.points.push(point);
        let next = as_number(self.points.len());
        self.slots[index] = Slot { next, hash };
        VertexId(next - 1)
    }

    /// Doubles the number of slots.
    fn grow(&mut self) {
        let larger = (2 * self.slots.len()).max(INITIAL_SLOTS);
        let slots = std::mem::replace(&mut self.slots, vec![Slot::default(); larger]);
        for slot in slots.into_iter().filter(|slot| slot.next != 0) {
            let mut index = self.home_slot(slot.hash);
            while self.slots[index].next != 0 {
                index = self.next_slot(index);
            }
            self.slots[index] = slot;
        }
    }

    /// The index of the slot at which the search for a hash begins.
    fn home_slot(&self, hash: u32) -> usize {
        hash as usize & (self.slots.len() - 1)
    }

    fn next_slot(&self, index: usize) -> usize {
        (index + 1) & (self.slots.len() - 1)
    }
}

/// Return whether two points have the same bits; a NaN equals itself here.
fn are_same([a, b, c]: &[f64; 3], [x, y, z]: &[f64; 3]) -> bool {
    a.to_bits() == x.to_bits() && b.to_bits() == y.to_bits() && c.to_bits() == z.to_bits()
}

/// A hash of a point, in which each bit depends on all bits of the coordinates.
///
/// Coordinates of single precision end in zeros, and a product alone would end in zeros, too.
fn hash_of([x, y, z]: &[f64; 3]) -> u32 {
    let first = folded(x.to_bits() ^ ODD[0], y.to_bits() ^ ODD[1]);
    let [.., a, b, c, d] = folded(first ^ z.to_bits(), ODD[2]).to_be_bytes();
    u32::from_be_bytes([a, b, c, d])
}

/// The first 64 binary digits of the golden ratio, of √2 and of √3.
const ODD: [u64; 3] = [
    0x9e37_79b9_7f4a_7c15,
    0x6a09_e667_f3bc_c909,
    0xbb67_ae85_84ca_a73b,
];

/// The exclusive or of the two halves of a 128-bit product.
fn folded(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    low_limb(product >> 64) ^ low_limb(product)
}

#[cfg(test)]
mod tests {
    use super::{welded, PointTable, VertexId};

    /// Points on a grid of single precision: their bits differ little and end in zeros.
    fn grid(side: u8) -> Vec<[f64; 3]> {
        let along = || (0..side).map(|k| f64::from(f32::from(k) * 0.1));
        let across = |x| along().flat_map(move |y| along().map(move |z| [x, y, z]));
        along().flat_map(across).collect()
    }

    #[test]
    fn many_points_keep_their_numbers_as_the_table_grows() {
        let once = grid(24);
        let twice = [once.clone(), once.clone()].concat();
        let found = welded(&twice);
        assert_eq!(found.points, once);
        let numbers: Vec<_> = (0u32..).map(VertexId).take(once.len()).collect();
        assert_eq!(found.same, [numbers.clone(), numbers].concat());
    }

    #[test]
    fn a_point_without_numbers_equals_itself() {
        let points = [[f64::NAN, 0.0, 1.0], [0.0; 3], [f64::NAN, 0.0, 1.0]];
        assert_eq!(welded(&points).same, [0, 1, 0].map(VertexId));
    }

    #[test]
    fn points_of_single_precision_spread_over_the_table() {
        let mut table = PointTable::default();
        for point in grid(24) {
            table.number_of(point);
        }
        let slots = &table.slots;
        let away = |index: usize| {
            let home_slot = table.home_slot(slots[index].hash);
            (index + slots.len() - home_slot) % slots.len()
        };
        let taken: Vec<_> = (0..slots.len()).filter(|&k| slots[k].next != 0).collect();
        // With half of the slots occupied, a random hash ends half a slot from its home slot on average.
        assert!(taken.iter().map(|&index| away(index)).sum::<usize>() < taken.len());
    }

    #[test]
    fn the_first_of_equal_points_stands_for_them() {
        let points = [[1.0, 0.0, 0.0], [0.0; 3], [1.0, -0.0, 0.0], [-0.0; 3]];
        let found = welded(&points);
        assert_eq!(found.same, [0, 1, 0, 1].map(VertexId));
        assert_eq!(found.points, [[1.0, 0.0, 0.0], [0.0; 3]]);
        assert!(found.points[0][1].is_sign_positive());
    }
}
