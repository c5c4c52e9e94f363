//! The kernel that solves every cell, by small partition trees (local trees).
//!
//! Each operand gets a local tree, cut by the planes of its own faces. The fragments (pieces of faces) of
//! each operand are cut by the other operands' trees, and a piece stays if the expression differs on its two
//! sides. This is the dual of merging the trees (`merge::merge`, with which tests compare it): it labels the
//! same regions, but cuts only fragments, never regions.

mod coverage;
mod fragment;
mod local_tree;
mod operand;
mod overlay;

use super::counts::{KernelName, Refusal};
use super::kept::{assemble, KeptPart};
use super::problem::{CellProblem, Kernel, ListedOperand};
use crate::geometry::polygon::Polygon;
use crate::geometry::side::Orientation;
use crate::interrupt::poll;
use crate::merge::expression::Expression;
use crate::merge::rule::Rule;
use crate::tree::node::Node;
pub(in crate::merge) use fragment::Fragment;
use local_tree::{LabelledPolygon, LocalTree};
pub use operand::LeafTree;
use operand::Operand;

/// The kernel that cuts the faces of each operand by small partition trees of the other operands.
///
/// The result lists each wall between inside and outside once and nothing else, for any operands.
#[derive(Debug)]
pub struct LocalTrees;

/// A piece of a fragment of an operand's boundary, with the labels on its two sides: for each operand whether
/// this side is inside it.
pub(in crate::merge) struct Piece {
    pub(in crate::merge) polygon: Polygon,
    pub(in crate::merge) minus: Vec<bool>,
    pub(in crate::merge) plus: Vec<bool>,
}

impl Kernel for LocalTrees {
    fn name(&self) -> KernelName {
        KernelName::Trees
    }

    fn solve(&self, problem: &CellProblem, overlapping: &mut Vec<u32>) -> Result<Node, Refusal> {
        let CellProblem { cell, sources, .. } = *problem;
        let operand = |l: &ListedOperand| Operand::new(l.number, &l.list, cell, sources);
        let operands: Vec<Operand> = problem.operands.iter().map(operand).collect();
        let overlaps = |o: &&Operand| !o.simple;
        overlapping.extend(operands.iter().filter(overlaps).map(|o| o.number));
        let (kept, corner) = keep_all(&operands, problem.expression, problem.rule);
        Ok(assemble(kept, corner, true, cell, sources))
    }
}

/// Returns the parts of all operands' faces that bound the result, and the expression's value at the cell's
/// corner (1 for inside).
fn keep_all(operands: &[Operand], expression: &Expression, rule: Rule) -> (Vec<KeptPart>, i32) {
    let bounds = BoundaryTest {
        operands,
        expression,
    };
    let scratch = &mut Vec::new();
    let at_corner: Vec<bool> = operands.iter().map(|o| rule.inside(o.corner)).collect();
    let corner = i32::from(bounds.value(&at_corner, scratch));
    let mut kept = Vec::new();
    for (i, operand) in operands.iter().enumerate() {
        for fragment in &operand.fragments {
            poll();
            let pieces = sides(fragment, i, operands, rule);
            kept.extend(keep(fragment, pieces, |piece| {
                bounds.side(piece, i, scratch)
            }));
        }
    }
    (kept, corner)
}

/// Decides which pieces of faces bound the value of an expression.
struct BoundaryTest<'a> {
    operands: &'a [Operand],
    expression: &'a Expression,
}

impl BoundaryTest<'_> {
    fn operand_index(&self, number: u32) -> usize {
        let index = self.operands.iter().position(|o| o.number == number);
        index.unwrap_or(0)
    }

    fn value(&self, labels: &[bool], scratch: &mut Vec<u64>) -> bool {
        let label = |k: u32| labels[self.operand_index(k)];
        self.expression.value(label, scratch)
    }

    /// Returns the orientation in which a piece of an operand bounds the expression's value; `None` if it
    /// does not, or if a coinciding face of another operand stays instead.
    fn side(&self, piece: &Piece, own: usize, scratch: &mut Vec<u64>) -> Option<Orientation> {
        if piece.minus[own] == piece.plus[own] {
            return None;
        }
        let sides = [&piece.minus, &piece.plus].map(|labels| self.value(labels, scratch));
        let orientation = orientation(sides)?;
        (piece.is_only_boundary_of(own) || self.is_owned(piece, own)).then_some(orientation)
    }

    fn is_owned(&self, piece: &Piece, own: usize) -> bool {
        let word = |labels: &[bool], k: u32| u64::from(labels[self.operand_index(k)]);
        let [minus, plus] = [&piece.minus, &piece.plus];
        let owners = self
            .expression
            .owners(|k| word(minus, k), |k| word(plus, k));
        owners.iter().any(|(k, _)| self.operand_index(*k) == own)
    }
}

/// Returns the orientation in which a piece bounds a set, given whether its minus and its plus side are
/// inside the set; `None` if both are equal.
pub(in crate::merge) fn orientation([minus, plus]: [bool; 2]) -> Option<Orientation> {
    (minus != plus).then_some(if minus {
        Orientation::Same
    } else {
        Orientation::Opposite
    })
}

/// Cuts a fragment into pieces such that each side of a piece is inside or outside each operand as a whole.
fn sides(fragment: &Fragment, own: usize, operands: &[Operand], rule: Rule) -> Vec<Piece> {
    let first = Piece {
        polygon: fragment.polygon.clone(),
        minus: Vec::with_capacity(operands.len()),
        plus: Vec::with_capacity(operands.len()),
    };
    let mut pieces = vec![first];
    for (j, operand) in operands.iter().enumerate() {
        if j == own && operand.simple {
            let (minus, plus) = if fragment.weight > 0 { (1, 0) } else { (0, 1) };
            for piece in &mut pieces {
                piece.minus.push(rule.inside(minus));
                piece.plus.push(rule.inside(plus));
            }
        } else {
            pieces = pieces
                .into_iter()
                .flat_map(|p| p.labelled_by(&operand.tree, rule))
                .collect();
        }
    }
    pieces
}

impl Piece {
    fn labelled_by(self, tree: &LocalTree, rule: Rule) -> Vec<Self> {
        poll();
        let mut sided = tree.sides(self.polygon);
        // The last piece, usually the only one, reuses the memory of the labels.
        let last = sided.pop();
        let labelled = |s: LabelledPolygon, mut minus: Vec<bool>, mut plus: Vec<bool>| {
            minus.push(rule.inside(s.minus));
            plus.push(rule.inside(s.plus));
            Self {
                polygon: s.polygon,
                minus,
                plus,
            }
        };
        let others = sided.into_iter();
        let mut pieces: Vec<Self> = others
            .map(|s| labelled(s, self.minus.clone(), self.plus.clone()))
            .collect();
        pieces.extend(last.map(|s| labelled(s, self.minus, self.plus)));
        pieces
    }

    /// Returns true if no other operand changes between inside and outside across the piece.
    fn is_only_boundary_of(&self, operand: usize) -> bool {
        let differs = |k: usize| self.minus[k] != self.plus[k];
        (0..self.minus.len()).all(|k| k == operand || !differs(k))
    }
}

/// Returns the parts of a fragment that bound the result, in each orientation; `side` returns the orientation
/// in which a piece bounds the result, or `None`.
pub(in crate::merge) fn keep(
    fragment: &Fragment,
    pieces: Vec<Piece>,
    mut side: impl FnMut(&Piece) -> Option<Orientation>,
) -> Vec<KeptPart> {
    let total = pieces.len();
    let mut same = Vec::new();
    let mut turned = Vec::new();
    for piece in pieces {
        match side(&piece) {
            Some(Orientation::Same) => same.push(piece.polygon),
            Some(Orientation::Opposite) => turned.push(piece.polygon),
            None => {}
        }
    }
    [(same, Orientation::Same), (turned, Orientation::Opposite)]
        .into_iter()
        .filter(|(polygons, _)| !polygons.is_empty())
        .map(|(polygons, orientation)| {
            if fragment.intact && polygons.len() == total {
                KeptPart::whole(fragment.face, orientation)
            } else {
                KeptPart::pieces(fragment.face, orientation, polygons)
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::merge::expression::Term;
    use crate::merge::scenes::{both, counts, crossing, cuboid, Shared};
    use crate::mesh::handle::Slot;

    #[test]
    fn every_cell_is_taken() {
        let scene = crossing();
        let left = |combined| {
            let expression = both(combined);
            let node = LocalTrees.solve(&scene.problem(&expression), &mut Vec::new());
            counts(&node.expect("every cell"))
        };
        assert_eq!(left(Term::And), (0, 4));
        assert_eq!(left(Term::Or), (4, 4));
    }

    #[test]
    fn where_faces_coincide_the_first_operand_owns_them() {
        let scene = Shared::of(&[cuboid([0; 3], [4; 3]), cuboid([0; 3], [4; 3])]);
        let solve = |combined| {
            let expression = both(combined);
            LocalTrees
                .solve(&scene.problem(&expression), &mut Vec::new())
                .expect("every cell")
        };
        assert!(matches!(solve(Term::Xor), Node::Leaf(0)));
        let Node::Deferred(leaf) = solve(Term::And) else {
            panic!("a box");
        };
        assert_eq!(leaf.groups.len(), 1);
        assert!(std::sync::Arc::ptr_eq(
            &leaf.groups[0].source,
            scene.sources.get(Slot(0))
        ));
    }
}
