//! The list L(v) of a leaf of a stab tree: its fragments as a heap, ordered by their numbers of hits T(p).

/// A fragment in the list of a leaf.
#[derive(Clone, Debug)]
pub struct Entry<F> {
    /// The facet that the fragment is a part of.
    pub facet: u32,
    /// The number of rays that have hit the facet in this leaf; parts of a split fragment inherit its count.
    pub hits: u64,
    /// The part of the facet in the leaf's region; `None` for the whole facet.
    pub fragment: Option<Box<F>>,
}

impl<F> Entry<F> {
    fn precedes(&self, other: &Self) -> bool {
        (self.hits, other.facet) > (other.hits, self.facet)
    }
}

/// A binary heap of fragments: most hits first, then in the order of the input.
#[derive(Clone, Debug)]
pub struct Heap<F> {
    entries: Vec<Entry<F>>,
}

impl<F> Default for Heap<F> {
    fn default() -> Self {
        let entries = Vec::new();
        Self { entries }
    }
}

impl<F> Heap<F> {
    /// Makes a heap of entries that are already in heap order; `None` if they are not.
    pub fn of(entries: Vec<Entry<F>>) -> Option<Self> {
        let mut lower = entries.iter().enumerate().skip(1);
        let ordered = lower.all(|(place, entry)| !entry.precedes(&entries[(place - 1) / 2]));
        ordered.then_some(Self { entries })
    }

    /// The number of fragments.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns true if the heap has no fragments.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// The fragments in heap order: a parent before its children.
    pub fn entries(&self) -> &[Entry<F>] {
        &self.entries
    }

    /// Returns the index of a facet in the heap; tries the index `guess` first.
    pub fn place(&self, facet: u32, guess: usize) -> Option<usize> {
        if self.entries.get(guess).is_some_and(|e| e.facet == facet) {
            return Some(guess);
        }
        self.entries.iter().position(|entry| entry.facet == facet)
    }

    /// Adds a fragment with its facet and hits.
    pub fn push(&mut self, entry: Entry<F>) {
        self.entries.push(entry);
        self.rise(self.entries.len() - 1);
    }

    /// Counts a hit of the fragment at an index; only entries at lower indices may change their index.
    pub fn count_hit(&mut self, place: usize) {
        self.entries[place].hits += 1;
        self.rise(place);
    }

    fn rise(&mut self, mut place: usize) {
        while place > 0 {
            let parent = (place - 1) / 2;
            if !self.entries[place].precedes(&self.entries[parent]) {
                return;
            }
            self.entries.swap(place, parent);
            place = parent;
        }
    }

    /// Returns the fragments in heap order.
    pub fn into_entries(self) -> Vec<Entry<F>> {
        self.entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heap(hits: &[u64]) -> Heap<()> {
        let mut heap = Heap::default();
        for (facet, hits) in hits.iter().enumerate() {
            let (facet, hits, fragment) = (facet as u32, *hits, None);
            heap.push(Entry {
                facet,
                hits,
                fragment,
            });
        }
        heap
    }

    fn top(heap: &Heap<()>) -> u32 {
        heap.entries()[0].facet
    }

    fn assert_heap(heap: &Heap<()>) {
        assert!(Heap::of(heap.entries().to_vec()).is_some());
    }

    #[test]
    fn only_heaps_are_taken_as_such() {
        let mut entries = heap(&[1, 3, 2, 3]).into_entries();
        assert!(Heap::of(entries.clone()).is_some());
        entries.swap(0, 1);
        assert!(Heap::of(entries).is_none());
    }

    #[test]
    fn the_most_hit_is_on_top_and_of_equal_ones_the_first() {
        assert_eq!(top(&heap(&[1, 3, 2, 3])), 1);
        assert_eq!(top(&heap(&[0, 0, 0])), 0);
    }

    #[test]
    fn hits_move_up_and_leave_later_places_alone() {
        let mut heap = heap(&[5, 4, 4, 1, 0, 2, 3]);
        for place in [2, 5, 5, 6, 6, 6] {
            let later: Vec<u32> = heap.entries()[place + 1..]
                .iter()
                .map(|e| e.facet)
                .collect();
            heap.count_hit(place);
            assert_heap(&heap);
            let after: Vec<u32> = heap.entries()[place + 1..]
                .iter()
                .map(|e| e.facet)
                .collect();
            assert_eq!(after, later);
        }
        let total: u64 = heap.entries().iter().map(|e| e.hits).sum();
        assert_eq!(total, 19 + 6);
    }
}
