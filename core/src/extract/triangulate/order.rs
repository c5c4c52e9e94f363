//! A sequence of numbers in an order that only the caller knows.

/// The longest block: a trade-off between shifting entries in a block and shifting blocks.
const MAX_BLOCK_LENGTH: usize = 256;

/// Numbers in an order that only the caller knows, in blocks, so that insertion is cheap.
#[derive(Default)]
pub(super) struct Order {
    /// No block is empty.
    blocks: Vec<Vec<usize>>,
}

/// A gap between two entries of an [`Order`], valid until the order changes.
#[derive(Clone, Copy)]
pub(super) struct Place {
    block: usize,
    offset: usize,
}

impl Order {
    /// Returns the gap after all entries for which `below` is true; these must come first.
    pub(super) fn search(&self, below: impl Fn(usize) -> bool) -> Place {
        let block = self
            .blocks
            .partition_point(|block| below(block[0]))
            .saturating_sub(1);
        let offset = self
            .blocks
            .get(block)
            .map_or(0, |entries| entries.partition_point(|&entry| below(entry)));
        Place { block, offset }
    }

    /// The entry before a gap; `None` at the start.
    pub(super) fn before(&self, place: Place) -> Option<usize> {
        let offset = place.offset.checked_sub(1)?;
        self.blocks.get(place.block)?.get(offset).copied()
    }

    /// Inserts an entry at a gap.
    pub(super) fn insert(&mut self, place: Place, entry: usize) {
        if self.blocks.is_empty() {
            self.blocks.push(Vec::new());
        }
        let block = &mut self.blocks[place.block];
        block.insert(place.offset, entry);
        if block.len() > MAX_BLOCK_LENGTH {
            let tail = block.split_off(MAX_BLOCK_LENGTH / 2);
            self.blocks.insert(place.block + 1, tail);
        }
    }

    /// Removes `entry` after the gap `place`; returns false if an entry between them is not `among`.
    pub(super) fn remove(
        &mut self,
        mut place: Place,
        entry: usize,
        among: impl Fn(usize) -> bool,
    ) -> bool {
        while let Some(block) = self.blocks.get_mut(place.block) {
            match block.get(place.offset) {
                Some(&found) if found == entry => {
                    block.remove(place.offset);
                    if block.is_empty() {
                        self.blocks.remove(place.block);
                    }
                    return true;
                }
                Some(&other) if !among(other) => return false,
                Some(_) => place.offset += 1,
                None => {
                    place = Place {
                        block: place.block + 1,
                        offset: 0,
                    }
                }
            }
        }
        false
    }

    pub(super) fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }
}
