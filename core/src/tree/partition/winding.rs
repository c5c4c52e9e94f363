//! Labels of a tree by winding numbers, for facets that overlap, cross or face each other.
//!
//! Each leaf of an autopartition lies in one cell of the arrangement of the facets. Across a piece of a cut,
//! the winding number changes by the number of facets that cover the piece, signed by their orientation. From
//! one leaf with a known number, the numbers of all others follow by adjacency.

use super::flat::{Flat, FlatCut};
use super::node::{Cut, Facet, Label, PartitionTree};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::side::{Half, Orientation};
use crate::geometry::spaces::space::{overlay, Space};
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// A tree labelled by winding numbers, and whether the facets were simple.
#[derive(Clone, Debug)]
pub struct Winding<S: Space> {
    /// The tree of the set of points whose winding number satisfies the rule.
    pub tree: PartitionTree<S>,
    /// True if all winding numbers are 0 or 1 and no two facets overlap.
    pub simple: bool,
}

/// Labels an autopartition by the winding numbers of its facets.
///
/// `reference` gives the side of each hyperplane on which a point in no cut lies, `number` is the winding
/// number at that point, and `inside` is the rule that turns a winding number into a label.
///
/// # Errors
/// `NotClosed` if the facets do not define one winding number for every point; `Internal` for a broken tree.
pub fn winding_tree<S: Space>(
    tree: &PartitionTree<S>,
    reference: impl Fn(&S::Hyperplane) -> Half,
    number: i32,
    inside: impl Fn(i32) -> bool,
) -> Result<Winding<S>> {
    let flat = Flat::new(tree);
    let (changes, disjoint) = flat.winding_changes()?;
    let numbers = flat.numbers(&changes, flat.leaf_at(reference), number)?;
    let simple = disjoint
        && flat
            .leaves()
            .all(|leaf| matches!(numbers[leaf.index()], 0 | 1));
    let tree = flat.relabelled(|leaf| Label::from_inside(inside(numbers[leaf.index()])));
    Ok(Winding { tree, simple })
}

/// Two leaves on the sides of a piece of a cut, and by how much the winding number on the minus side exceeds
/// the winding number on the plus side.
struct WindingChange {
    minus: NodeId,
    plus: NodeId,
    rise: i32,
}

impl<S: Space> Flat<S> {
    /// The jumps of the winding number between all neighbouring leaves, and whether no two facets overlap.
    fn winding_changes(&self) -> Result<(Vec<WindingChange>, bool)> {
        let mut changes = Vec::new();
        let mut disjoint = true;
        for node in self.cuts() {
            poll();
            for piece in covered_pieces(&node.cut) {
                disjoint &= piece.layers <= 1;
                self.cross(node, piece, &mut changes)?;
            }
        }
        Ok((changes, disjoint))
    }

    fn cross(
        &self,
        node: &FlatCut<S>,
        piece: Piece<S>,
        changes: &mut Vec<WindingChange>,
    ) -> Result<()> {
        let rise = piece.rise;
        for (part, minus) in self.leaves_beside(node.minus, piece.fragment)? {
            for (_, plus) in self.leaves_beside(node.plus, part)? {
                changes.push(WindingChange { minus, plus, rise });
            }
        }
        Ok(())
    }

    /// The winding number of each leaf, by node number; zero for inner nodes.
    fn numbers(&self, changes: &[WindingChange], start: NodeId, number: i32) -> Result<Vec<i32>> {
        let mut neighbours = vec![Vec::new(); self.len()];
        for jump in changes {
            neighbours[jump.minus.index()].push((jump.plus, -jump.rise));
            neighbours[jump.plus.index()].push((jump.minus, jump.rise));
        }
        let mut numbers = vec![None; self.len()];
        numbers[start.index()] = Some(number);
        let mut pending = vec![(start, number)];
        while let Some((leaf, number)) = pending.pop() {
            poll();
            for &(next, rise) in &neighbours[leaf.index()] {
                let expected = number + rise;
                match numbers[next.index()] {
                    None => {
                        numbers[next.index()] = Some(expected);
                        pending.push((next, expected));
                    }
                    Some(known) if known != expected => return Err(not_closed()),
                    Some(_) => {}
                }
            }
        }
        Ok(numbers.into_iter().map(Option::unwrap_or_default).collect())
    }
}

fn not_closed() -> Error {
    Error::new(
        ErrorKind::NotClosed,
        "the faces do not close: some points have no unique winding number",
    )
}

/// A convex piece of a cut that each facet covers entirely or not at all.
struct Piece<S: Space> {
    fragment: S::Fragment,
    rise: i32,
    layers: u32,
}

fn covered_pieces<S: Space>(cut: &Cut<S>) -> Vec<Piece<S>> {
    let whole = Piece {
        fragment: cut.sub_hyperplane().span.clone(),
        rise: 0,
        layers: 0,
    };
    cut.sub_hyperplane()
        .facets
        .iter()
        .fold(vec![whole], |pieces, facet| {
            let same = S::coincide(S::hyperplane(&facet.fragment), cut.hyperplane());
            let rise = if same == Some(Orientation::Same) {
                1
            } else {
                -1
            };
            pieces
                .into_iter()
                .flat_map(|piece| cover(piece, facet, rise))
                .collect()
        })
}

/// The parts of a convex piece of a cut that a facet covers and the parts that it does not cover, with the
/// new winding number change and number of facets of each.
fn cover<S: Space>(piece: Piece<S>, facet: &Facet<S>, rise: i32) -> Vec<Piece<S>> {
    let (under, beside) = overlay::<S>(piece.fragment, &facet.fragment);
    let beside = beside.into_iter().map(|fragment| Piece {
        fragment,
        rise: piece.rise,
        layers: piece.layers,
    });
    let under = under.map(|fragment| Piece {
        fragment,
        rise: piece.rise + rise,
        layers: piece.layers + 1,
    });
    beside.chain(under).collect()
}
