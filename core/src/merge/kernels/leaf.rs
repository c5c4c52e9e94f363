//! The leaf kernel: what an expression leaves of its operands' boundaries in a small cell.
//!
//! Each operand gets its local autopartition; each operand's fragments are pushed through the
//! others' trees, and a piece stays if the expression differs on its two sides. This is the dual of
//! merging the trees (which `merge::merge` does, and tests compare): it labels the same regions,
//! but cuts only fragments, never regions.

use super::general;
use super::kept::{assemble, Kept};
use super::local_tree::{LocalTree, Weighted};
use super::orthogonal;
use super::overlay::{disjoint, Fragment};
use crate::geometry::cell::Cell;
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::Polygon;
use crate::interrupt::poll;
use crate::merge::expression::Expression;
use crate::merge::lists::list::{List, Sources};
use crate::tree::node::{Node, Work};

/// Which winding numbers count as inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rule {
    /// w > 0.
    Positive,
    /// w ≠ 0.
    Nonzero,
    /// w odd.
    EvenOdd,
}

impl Rule {
    /// Whether a region with this winding number is inside.
    pub fn inside(self, w: i32) -> bool {
        match self {
            Self::Positive => w > 0,
            Self::Nonzero => w != 0,
            Self::EvenOdd => w % 2 != 0,
        }
    }
}

/// One operand inside the cell.
struct Operand {
    number: u32,
    corner: i32,
    fragments: Vec<Fragment>,
    tree: LocalTree,
    simple: bool,
}

/// A piece of a fragment, with what is known of the operands on its two sides.
struct Piece {
    polygon: Polygon,
    minus: Vec<bool>,
    plus: Vec<bool>,
}

/// Evaluates an expression in a cell: the node that describes the result there.
///
/// Operands in general position need no trees. `evidence` is told the operands that local trees
/// show to overlap themselves here.
pub fn evaluate(
    cell: &Cell,
    expression: &Expression,
    rule: Rule,
    lists: Vec<(u32, List)>,
    sources: &Sources,
    evidence: impl FnMut(u32),
) -> Node {
    let named: Vec<(u32, &List)> = lists.iter().map(|(k, list)| (*k, list)).collect();
    among_orthogonal(cell, expression, &named, sources)
        .or_else(|| in_general_position(cell, expression, rule, &named, sources))
        .unwrap_or_else(|| by_trees(cell, expression, rule, lists, sources, evidence))
}

/// Evaluates an expression in a cell where nothing is special; `None` if something is.
pub fn in_general_position(
    cell: &Cell,
    expression: &Expression,
    rule: Rule,
    lists: &[(u32, &List)],
    sources: &Sources,
) -> Option<Node> {
    if rule != Rule::Positive {
        return None;
    }
    let (kept, corner) = general::evaluate(cell, expression, lists, sources)?;
    let before = lists.iter().map(|l| l.1.work()).max().unwrap_or_default();
    Some(assemble(
        kept,
        corner,
        before.max(Work::General),
        cell,
        sources,
    ))
}

/// Evaluates an expression in a cell where all faces are perpendicular to axes; `None` if some are
/// not, or an operand overlaps itself.
pub fn among_orthogonal(
    cell: &Cell,
    expression: &Expression,
    lists: &[(u32, &List)],
    sources: &Sources,
) -> Option<Node> {
    let (kept, corner) = orthogonal::evaluate(cell, expression, lists, sources)?;
    Some(assemble(kept, corner, Work::Trees, cell, sources))
}

/// Evaluates an expression in a cell by the operands' local trees.
///
/// The result is the reduced boundary, whatever the operands are.
pub fn by_trees(
    cell: &Cell,
    expression: &Expression,
    rule: Rule,
    lists: Vec<(u32, List)>,
    sources: &Sources,
    mut evidence: impl FnMut(u32),
) -> Node {
    let operands: Vec<Operand> = lists
        .into_iter()
        .map(|(number, list)| Operand::new(number, &list, cell, sources))
        .collect();
    for operand in operands.iter().filter(|o| !o.simple) {
        evidence(operand.number);
    }
    let place = |number: u32| {
        operands
            .iter()
            .position(|o| o.number == number)
            .unwrap_or(0)
    };
    let scratch = &mut Vec::new();
    let mut value = |labels: &[bool]| expression.value(|k| labels[place(k)], scratch);
    let at_corner: Vec<bool> = operands.iter().map(|o| rule.inside(o.corner)).collect();
    let corner = i32::from(value(&at_corner));
    let mut kept = Vec::new();
    for (i, operand) in operands.iter().enumerate() {
        for fragment in &operand.fragments {
            poll();
            let pieces = sides(fragment, i, &operands, rule);
            kept.extend(keep(fragment, i, pieces, &mut value));
        }
    }
    assemble(kept, corner, Work::Trees, cell, sources)
}

impl Operand {
    fn new(number: u32, list: &List, cell: &Cell, sources: &Sources) -> Self {
        let corner = list.corner;
        let (fragments, overlap) = disjoint(fragments(list, cell, sources));
        let weighted = fragments
            .iter()
            .map(|f| Weighted {
                polygon: f.polygon.clone(),
                weight: f.weight,
            })
            .collect();
        let tree = if fragments.is_empty() {
            LocalTree::uniform(corner)
        } else {
            LocalTree::build(weighted, &cell.corner(), corner)
        };
        let simple = !overlap
            && fragments.iter().all(|f| f.weight.abs() == 1)
            && tree.labels().iter().all(|w| (0..=1).contains(w));
        Self {
            number,
            corner,
            fragments,
            tree,
            simple,
        }
    }
}

/// The fragments of a list's elements, clipped to the cell.
fn fragments(list: &List, cell: &Cell, sources: &Sources) -> Vec<Fragment> {
    let mut found = Vec::with_capacity(list.len());
    for r in &list.records {
        poll();
        if let Some(polygon) = sources.get(r.slot()).clip(r.face, cell) {
            let weight = if r.flip() { -1 } else { 1 };
            let face = (r.slot() as u32, r.face);
            found.push(Fragment {
                polygon,
                weight,
                face,
                intact: true,
            });
        }
    }
    for p in &list.parts {
        poll();
        let weight = if p.element.flip { -1 } else { 1 };
        let face = (
            sources.slot(&p.element.part.source) as u32,
            p.element.part.face,
        );
        let clipped = p.pieces().iter().filter_map(|q| q.clone().clipped(cell));
        found.extend(clipped.map(|polygon| Fragment {
            polygon,
            weight,
            face,
            intact: false,
        }));
    }
    found
}

/// Cuts a fragment into pieces that have one label of each operand on either side.
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
                .flat_map(|p| p.pushed(&operand.tree, rule))
                .collect();
        }
    }
    pieces
}

impl Piece {
    fn pushed(self, tree: &LocalTree, rule: Rule) -> Vec<Self> {
        poll();
        let (minus, plus) = (self.minus, self.plus);
        let with = |labels: &Vec<bool>, w: i32| {
            let mut labels = labels.clone();
            labels.push(rule.inside(w));
            labels
        };
        tree.sides(self.polygon)
            .into_iter()
            .map(|s| Self {
                polygon: s.polygon,
                minus: with(&minus, s.minus),
                plus: with(&plus, s.plus),
            })
            .collect()
    }

    /// Whether this operand is the first whose label differs on the two sides: it owns the piece.
    fn is_owned_by(&self, operand: usize) -> bool {
        let differs = |k: usize| self.minus[k] != self.plus[k];
        differs(operand) && !(0..operand).any(differs)
    }
}

/// The pieces across which the expression changes, by orientation.
fn keep(
    fragment: &Fragment,
    own: usize,
    pieces: Vec<Piece>,
    value: &mut impl FnMut(&[bool]) -> bool,
) -> Vec<Kept> {
    let total = pieces.len();
    let mut same = Vec::new();
    let mut turned = Vec::new();
    for piece in pieces.into_iter().filter(|p| p.is_owned_by(own)) {
        match (value(&piece.minus), value(&piece.plus)) {
            (true, false) => same.push(piece.polygon),
            (false, true) => turned.push(piece.polygon),
            _ => {}
        }
    }
    [(same, false), (turned, true)]
        .into_iter()
        .filter(|(polygons, _)| !polygons.is_empty())
        .map(|(polygons, flip)| {
            if fragment.intact && polygons.len() == total {
                Kept::whole(fragment.face, flip)
            } else {
                Kept::pieces(fragment.face, flip, polygons)
            }
        })
        .collect()
}

/// One operand's local tree in a small cell, for queries.
pub struct LeafTree(Operand);

impl LeafTree {
    /// The local tree of a list.
    pub fn new(list: &List, cell: &Cell, sources: &Sources) -> Self {
        Self(Operand::new(0, list, cell, sources))
    }

    /// The pieces of boundary in the cell.
    pub fn polygons(&self) -> impl Iterator<Item = &Polygon> {
        self.0.fragments.iter().map(|f| &f.polygon)
    }

    /// Whether nothing overlaps in the cell and all winding numbers are 0 or 1.
    pub fn is_simple(&self) -> bool {
        self.0.simple
    }

    /// The faces that truly meet the cell.
    pub fn faces(&self) -> impl Iterator<Item = u32> + '_ {
        self.0.fragments.iter().map(|f| f.face.1)
    }

    /// The winding number at a lattice point that lies on none of the pieces.
    pub fn label_at(&self, point: &Lattice) -> i32 {
        self.0.tree.label_at(point)
    }
}
