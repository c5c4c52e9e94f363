//! The partition tree of a solid: cuts that halve cells, and below them deferred leaves that list faces.

use std::sync::Arc;

use super::share::VolumeShare;
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

/// A node of the tree of a solid; immutable and shared.
///
/// Labels are winding numbers: a region is inside the solid where its number is positive.
#[derive(Debug)]
pub enum Node {
    /// A cell of space without boundary: it has one winding number everywhere.
    Leaf(i32),
    /// A cell of space whose boundary is listed but not yet partitioned.
    Deferred(DeferredLeaf),
    /// A cell of space that is cut into two halves.
    Cut(Halves),
}

impl Node {
    /// A node with these halves.
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
    /// The branches of the minus and of the plus half.
    pub children: [Branch; 2],
    /// The node's share of the solid's volume, once it is computed.
    pub share: Cached<VolumeShare>,
}

/// A subtree, with the cell that it describes.
///
/// `cell` may be smaller than the half of the parent's cell: the rest of that half has the winding number
/// `outside` everywhere (path compression). If `complement` is set, the node's winding numbers w count as 1 −
/// w.
#[derive(Clone, Debug)]
pub struct Branch {
    /// The region that the node describes.
    pub cell: Cell,
    /// The winding number around the cell, in the rest of the parent's half.
    pub outside: i32,
    /// True if the node's winding numbers w count as 1 − w.
    pub complement: bool,
    /// The root of the subtree.
    pub node: Arc<Node>,
}

impl Branch {
    /// A branch with one winding number everywhere.
    pub fn uniform(cell: Cell, w: i32) -> Self {
        Self {
            cell,
            outside: w,
            complement: false,
            node: Arc::new(Node::Leaf(w)),
        }
    }

    /// A branch with this node for a cell; the winding number around the cell is the leaf's number for a
    /// leaf, otherwise 0.
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

    /// The winding number if it is the same in the node and around the cell, else `None`.
    pub fn constant(&self) -> Option<i32> {
        match *self.node {
            Node::Leaf(w) => {
                let w = self.oriented(w);
                (w == self.outside).then_some(w)
            }
            _ => None,
        }
    }

    /// Converts a winding number w stored in the branch's node to the number in the branch: 1 − w if the
    /// branch is complemented, else w.
    pub fn oriented(&self, w: i32) -> i32 {
        if self.complement {
            1 - w
        } else {
            w
        }
    }

    /// The branch of the complement: each winding number w becomes 1 − w.
    #[must_use]
    pub fn complemented(&self) -> Self {
        Self {
            outside: 1 - self.outside,
            complement: !self.complement,
            ..self.clone()
        }
    }

    /// A child of this branch's node: complemented if this branch is complemented, else unchanged.
    #[must_use]
    pub fn child(&self, child: &Self) -> Self {
        if self.complement {
            child.complemented()
        } else {
            child.clone()
        }
    }
}

/// A leaf that lists the boundary in its cell without dividing it: whole faces, parts of faces, and the
/// winding number at the cell's corner of least coordinates.
///
/// All faces and parts that meet the closed cell are listed; others may be.
#[derive(Debug, Default)]
pub struct DeferredLeaf {
    /// The whole faces, grouped by source and orientation, with sources in the order of the expression.
    pub groups: Vec<FaceGroup>,
    /// The parts of faces.
    pub parts: Vec<PartElement>,
    /// The winding number at the cell's corner of least coordinates.
    pub corner: i32,
    /// True if a kernel made the list; false if it is an operand's boundary, unchanged.
    pub by_kernel: bool,
    /// The leaf's share of the solid's volume, once it is computed.
    pub share: Cached<VolumeShare>,
}

/// A list of whole faces of one source with one orientation.
#[derive(Clone, Debug)]
pub struct FaceGroup {
    /// True if the faces may touch other faces or parts anywhere, as in results of local trees or a grid;
    /// false if they touch others only where a face was cut.
    pub touching: bool,
    /// The source of the faces.
    pub source: Arc<Source>,
    /// The orientation of the faces relative to the source.
    pub orientation: Orientation,
    /// The numbers of the faces, ascending.
    pub faces: Vec<FaceId>,
}

/// A part of a face, together with its orientation in a solid.
#[derive(Clone, Debug)]
pub struct PartElement {
    /// The part of a face, in the orientation of its source.
    pub part: Arc<Part>,
    /// The orientation in the solid relative to the source.
    pub orientation: Orientation,
}

/// The part of a face that belongs to the boundary of a solid inside a cell, its home.
///
/// Its outline runs along the face's own edges, planes of other faces and the home cell's walls.
#[derive(Debug)]
pub struct Part {
    /// The source of the face.
    pub source: Arc<Source>,
    /// The number of the face in its source.
    pub face: FaceId,
    /// The cell inside which the outline describes the boundary.
    pub home: Cell,
    /// The outline, counterclockwise on the face; no two edges overlap, or continue each other on one line.
    pub edges: Box<[BareEdge]>,
    /// The lowest and highest lattice point in a box around the part; the walls of the box lie halfway
    /// between lattice points.
    pub around: [Lattice; 2],
    /// The flux through the whole part, once it is computed.
    pub flux: Cached<Flux>,
}

impl PartElement {
    /// The same part, with the orientation reversed if `turned`.
    #[must_use]
    pub fn turned_if(&self, turned: bool) -> Self {
        Self {
            part: Arc::clone(&self.part),
            orientation: self.orientation.turned_if(turned),
        }
    }
}

impl Part {
    /// The part of a face inside an outline, for the cell `home`.
    ///
    /// No two of the edges may overlap, or continue each other on one line.
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

    /// The edges of the outline with the keys of their lines.
    pub fn outline(&self) -> Vec<OutlineEdge> {
        let support = self.source.plane_residues(self.face);
        OutlineEdge::keyed(self.edges.to_vec(), &support)
    }

    /// A lattice box that contains the part, by its lowest and highest point; `around` may be half a step too
    /// small.
    pub fn enclosing(&self) -> [Lattice; 2] {
        let [low, high] = self.around;
        [low.map(|x| x - 1), high.map(|x| x + 1)]
    }

    /// The low and high corner of a box of doubles around the part.
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        bounds(self.edges.iter().map(|edge| &*edge.from))
    }

    /// The convex pieces of the part, computed from its outline.
    ///
    /// They are not cached: they need more memory than the part, and are rarely needed twice.
    pub fn pieces(&self) -> Vec<Polygon> {
        if let Some(whole) = outline::convex_loop(&self.source.plane(self.face), &self.edges) {
            return vec![whole];
        }
        let polygon = self.source.clip(self.face, &self.home);
        polygon.map_or_else(Vec::new, |p| outline::pieces(p, &self.edges))
    }
}

impl DeferredLeaf {
    /// The number of listed faces and parts.
    pub fn len(&self) -> usize {
        self.parts.len() + self.groups.iter().map(|g| g.faces.len()).sum::<usize>()
    }

    /// Return whether all listed faces and parts are perpendicular to coordinate axes.
    pub fn is_orthogonal(&self) -> bool {
        let faces = |g: &FaceGroup| g.faces.iter().all(|f| g.source.is_orthogonal(*f));
        let part = |p: &PartElement| p.part.source.is_orthogonal(p.part.face);
        self.groups.iter().all(faces) && self.parts.iter().all(part)
    }

    /// Return whether the leaf lists no faces and no parts.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
