//! Removes the crossings that rounding made, by small changes.
//!
//! Each change is tried and judged exactly: it stays if fewer faults are left. So mending ends, and it
//! returns the faults that it could not remove.
//!
//! # Source
//! Iterated rounding and repair as in Lazard and Valque, *Removing self-intersections in 3D meshes
//! while preserving floating-point coordinates*, 2024. Changes here are local and never subdivide.

mod blocks;
mod edits;
mod part;
mod trial;

use std::collections::BTreeSet;

use self::part::{both, distance, Edit};
pub use self::part::{Mending, Precision};
use crate::interrupt::spend;

/// The largest number of changes tried for each fault: 30 merges, 6 swaps, and 14 translations of 6 corners.
const MAX_CHANGES_PER_FAULT: usize = 120;

impl Mending {
    /// Removes crossings and flat triangles until none is left, or no change helps.
    pub fn run(&mut self) {
        let mut open: Vec<[u32; 2]> = self.faults();
        while let Some(fault) = open.pop() {
            if !self.is_fault(fault) {
                continue;
            }
            if self.work == 0 {
                return;
            }
            if self.improve(fault) {
                // Changes that failed before may help now.
                open = self.faults();
            }
        }
    }

    fn is_fault(&self, fault: [u32; 2]) -> bool {
        self.crossings.contains(&fault) || fault[0] == fault[1] && self.flat.contains(&fault[0])
    }

    /// Tries changes for a fault, until one leaves fewer faults; returns false if none does.
    fn improve(&mut self, fault: [u32; 2]) -> bool {
        let edits = self.edits(fault);
        edits
            .into_iter()
            .take(MAX_CHANGES_PER_FAULT)
            .any(|edit| self.attempt(&edit))
    }

    /// Makes a change, and undoes it unless it leaves fewer faults; returns whether it stays.
    fn attempt(&mut self, edit: &Edit) -> bool {
        spend(1 + self.blocks.count());
        let moved = edit.moves.iter().flat_map(|m| self.star(m.0));
        let mut touched: Vec<u32> = edit.triangles.iter().map(|m| m.0).chain(moved).collect();
        touched.sort_unstable();
        touched.dedup();
        let of_all = touched.iter().flat_map(|t| self.crossings_of(*t));
        let old_crossings: BTreeSet<[u32; 2]> = of_all.collect();
        let is_flat = |t: &u32| self.flat.contains(t);
        let old_flat: Vec<u32> = touched.iter().copied().filter(is_flat).collect();
        let undo = self.apply(edit);
        let most = old_crossings.len() + old_flat.len();
        if let Some((crossings, flat)) = self.faults_of(&touched, most) {
            for pair in old_crossings.into_iter().flat_map(both) {
                self.crossings.remove(&pair);
            }
            for t in &old_flat {
                self.flat.remove(t);
            }
            self.crossings.extend(crossings.into_iter().flat_map(both));
            self.flat.extend(flat);
            for (v, old) in &undo.moves {
                self.moved.insert(*v);
                self.drifts[v.index()] += distance(old, &self.vertices[v.index()]);
            }
            if let Some((v, drift)) = edit.drift {
                self.drifts[v.index()] = self.drifts[v.index()].max(drift);
            }
            return true;
        }
        self.revert(edit, &undo);
        false
    }
}
