//! The partition tree of a solid: dyadic cuts, with deferred leaves below.

use std::sync::Arc;

use super::share::Share;
use crate::arith::convert::as_whole;
use crate::geometry::cell::Cell;
use crate::geometry::flux::fixed::Flux;
use crate::geometry::outline;
use crate::geometry::outline::{BareEdge, OutlineEdge};
use crate::geometry::plane::Lattice;
use crate::geometry::polygon::{bounds, Polygon};
use crate::geometry::side::Orientation;
use crate::mesh::cached::Cached;
use crate::mesh::handle::FaceId;
use crate::mesh::source::Source;

/// A node of the tree. Immutable and shared.
///
/// Labels are winding numbers: a region is inside where its number is positive.
#[derive(Debug)]
pub enum Node {
    /// No boundary: one winding number everywhere.
    Leaf(i32),
    /// A preliminary leaf: its boundary is listed but not yet partitioned.
    Deferred(Deferred),
    /// The cell's dyadic cut.
    Cut(Halves),
}

impl Node {
    /// A cut with these halves.
    pub fn cut(minus: Branch, plus: Branch) -> Self {
        Self::Cut(Halves {
            children: [minus, plus],
            share: Cached::new(),
        })
    }
}

/// The two halves of a node's cell.
#[derive(Debug)]
pub struct Halves {
    /// Minus half first.
    pub children: [Branch; 2],
    /// The node's cached share of the volume.
    pub share: Cached<Share>,
}

/// A subtree in its place.
///
/// The node describes `cell`; the rest of the parent's half is uniformly `outside` (path compression). If
/// `complement` is set, the node's winding numbers w count as 1 − w.
#[derive(Clone, Debug)]
pub struct Branch {
    /// The region of the node.
    pub cell: Cell,
    /// The winding number around the cell.
    pub outside: i32,
    /// Whether the node is turned inside out.
    pub complement: bool,
    /// The node.
    pub node: Arc<Node>,
}

impl Branch {
    /// One winding number everywhere.
    pub fn uniform(cell: Cell, w: i32) -> Self {
        Self {
            cell,
            outside: w,
            complement: false,
            node: Arc::new(Node::Leaf(w)),
        }
    }

    /// A branch for a node and the cell that it covers.
    pub fn of_node(cell: Cell, node: Node) -> Self {
        match node {
            Node::Leaf(w) => Self::uniform(cell, w),
            node => Self {
                cell,
                outside: 0,
                complement: false,
                node: Arc::new(node),
            },
        }
    }

    /// The winding number, if it is the same everywhere.
    pub fn constant(&self) -> Option<i32> {
        match *self.node {
            Node::Leaf(w) => {
                let w = self.oriented(w);
                (w == self.outside).then_some(w)
            }
            _ => None,
        }
    }

    /// A winding number of the node, complemented if this branch is.
    pub fn oriented(&self, w: i32) -> i32 {
        if self.complement {
            1 - w
        } else {
            w
        }
    }

    /// The same set turned inside out.
    #[must_use]
    pub fn complemented(&self) -> Self {
        Self {
            outside: 1 - self.outside,
            complement: !self.complement,
            ..self.clone()
        }
    }

    /// A child, complemented if this branch is.
    #[must_use]
    pub fn child(&self, child: &Self) -> Self {
        if self.complement {
            child.complemented()
        } else {
            child.clone()
        }
    }
}

/// A preliminary leaf: elements, and the winding number at the cell's low corner.
///
/// All elements that meet the closed cell are listed; others may be.
#[derive(Debug, Default)]
pub struct Deferred {
    /// Whole faces by source, sources in the order of the expression.
    pub groups: Vec<Group>,
    /// Parts of faces.
    pub parts: Vec<PartElement>,
    /// The winding number at the cell's low corner.
    pub corner: i32,
    /// True if a kernel made the elements; else they are an operand's boundary, unchanged.
    pub worked: bool,
    /// The node's cached share of the volume.
    pub share: Cached<Share>,
}

/// Whole faces of one source with one orientation.
#[derive(Clone, Debug)]
pub struct Group {
    /// True if they may touch other elements anywhere, as results of local trees or a grid. Other faces
    /// touch only where one was cut.
    pub touching: bool,
    /// The source of the faces.
    pub source: Arc<Source>,
    /// The orientation of the faces relative to the source.
    pub orientation: Orientation,
    /// The faces, ascending.
    pub faces: Vec<FaceId>,
}

/// A part of a face, with an orientation.
#[derive(Clone, Debug)]
pub struct PartElement {
    /// The part.
    pub part: Arc<Part>,
    /// Its orientation relative to the source.
    pub orientation: Orientation,
}

/// The part of a face that is boundary inside its home cell.
///
/// The outline runs along the face's own edges, input planes and the home cell's border.
#[derive(Debug)]
pub struct Part {
    /// The source of the face.
    pub source: Arc<Source>,
    /// The face.
    pub face: FaceId,
    /// The cell the outline describes.
    pub home: Cell,
    /// The outline, counterclockwise on the face; no two edges overlap or continue each other.
    pub edges: Box<[BareEdge]>,
    /// The lattice points next to the corners of a box around it; its walls lie halfway between lattice
    /// points.
    pub around: [Lattice; 2],
    /// The cached flux through the part.
    pub flux: Cached<Flux>,
}

impl PartElement {
    /// The element, turned over if the flag is set.
    #[must_use]
    pub fn turned_if(&self, turned: bool) -> Self {
        Self {
            part: Arc::clone(&self.part),
            orientation: self.orientation.turned_if(turned),
        }
    }
}

impl Part {
    /// The part of a face inside an outline in a cell.
    ///
    /// No two of the edges may overlap or continue each other on one line.
    pub fn new(
        source: Arc<Source>,
        face: FaceId,
        home: Cell,
        edges: Vec<impl Into<BareEdge>>,
    ) -> Self {
        let edges: Box<[BareEdge]> = edges.into_iter().map(Into::into).collect();
        let (low, high) = bounds(edges.iter().map(|edge| &*edge.from));
        Self {
            source,
            face,
            home,
            edges,
            around: [
                low.map(|x| as_whole((x - 0.5).ceil())),
                high.map(|x| as_whole((x + 0.5).floor())),
            ],
            flux: Cached::new(),
        }
    }

    /// The outline with the keys of its lines.
    pub fn outline(&self) -> Vec<OutlineEdge> {
        let support = self.source.plane_residues(self.face);
        OutlineEdge::keyed(self.edges.to_vec(), &support)
    }

    /// A lattice box that contains the part; `around` may be half a step smaller.
    pub fn enclosing(&self) -> [Lattice; 2] {
        let [low, high] = self.around;
        [low.map(|x| x - 1), high.map(|x| x + 1)]
    }

    /// A box of doubles around the part.
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        bounds(self.edges.iter().map(|edge| &*edge.from))
    }

    /// The convex pieces, computed from the outline.
    ///
    /// Not cached: they take more room than the part, and are rarely needed twice.
    pub fn pieces(&self) -> Vec<Polygon> {
        if let Some(whole) = outline::convex_loop(&self.source.plane(self.face), &self.edges) {
            return vec![whole];
        }
        let polygon = self.source.clip(self.face, &self.home);
        polygon.map_or_else(Vec::new, |p| outline::pieces(p, &self.edges))
    }
}

impl Deferred {
    /// The number of listed elements.
    pub fn len(&self) -> usize {
        self.parts.len() + self.groups.iter().map(|g| g.faces.len()).sum::<usize>()
    }

    /// Return whether all elements are perpendicular to axes.
    pub fn is_orthogonal(&self) -> bool {
        let faces = |g: &Group| g.faces.iter().all(|f| g.source.is_orthogonal(*f));
        let part = |p: &PartElement| p.part.source.is_orthogonal(p.part.face);
        self.groups.iter().all(faces) && self.parts.iter().all(part)
    }

    /// Return whether there are no elements.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
