//! The connected parts of a set and of its complement, and the walls between them.

use super::flat::Flat;
use super::node::{Label, PartitionTree};
use crate::error::Result;
use crate::geometry::spaces::space::Space;
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// A piece of the boundary and the parts on its two sides.
#[derive(Clone, Debug)]
pub struct Wall<S: Space> {
    /// The piece, the set on its minus side.
    pub fragment: S::Fragment,
    /// The set's part on the minus side.
    pub inside: NodeId,
    /// The complement's part on the plus side.
    pub outside: NodeId,
}

/// The boundary of a tree's set, each piece with the connected parts that it separates.
///
/// Parts are open: places that touch in less than a piece of a hyperplane are not connected. The
/// name of a part is its first leaf, and has no meaning beyond telling parts apart.
///
/// # Order
/// That of the nodes, breadth first.
///
/// # Errors
/// `Internal` if a cut lies in the border of its own region.
pub fn walls<S: Space>(tree: &PartitionTree<S>) -> Result<Vec<Wall<S>>> {
    let flat = Flat::new(tree);
    let mut parts = Parts::new(flat.len());
    let mut walls = Vec::new();
    for contact in flat.contacts()? {
        poll();
        let (minus, plus) = (contact.minus, contact.plus);
        if flat.label(minus) == flat.label(plus) {
            parts.join(minus, plus);
        } else if flat.label(minus) == Some(Label::In) {
            walls.push((contact.fragment, minus, plus));
        } else {
            walls.push((S::reversed(&contact.fragment), plus, minus));
        }
    }
    let numbered = |(fragment, inside, outside)| Wall {
        fragment,
        inside: parts.of(inside),
        outside: parts.of(outside),
    };
    Ok(walls.into_iter().map(numbered).collect())
}

/// Disjoint sets of leaves, each named by its smallest member.
struct Parts {
    parent: Vec<NodeId>,
}

impl Parts {
    fn new(count: usize) -> Self {
        Self {
            parent: NodeId::all().take(count).collect(),
        }
    }

    fn of(&self, leaf: NodeId) -> NodeId {
        let mut at = leaf;
        while self.parent[at.place()] != at {
            at = self.parent[at.place()];
        }
        at
    }

    fn join(&mut self, a: NodeId, b: NodeId) {
        let (a, b) = (self.halved(a), self.halved(b));
        self.parent[a.max(b).place()] = a.min(b);
    }

    /// The name of a leaf's set, the way there shortened for the next question.
    fn halved(&mut self, leaf: NodeId) -> NodeId {
        let mut at = leaf;
        while self.parent[at.place()] != at {
            self.parent[at.place()] = self.parent[self.parent[at.place()].place()];
            at = self.parent[at.place()];
        }
        at
    }
}
