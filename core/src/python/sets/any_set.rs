//! A set of one, two or three dimensions, as Python's class `ObjectTree` stores it.

use std::sync::Arc;

use num_bigint::BigInt;

use super::each::{each, Set};
use super::input::{all, inside_of, points, segments, triangles, Input};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Plane;
use crate::geometry::spaces::axis::AxisSpace;
use crate::geometry::spaces::dim1::Dim1;
use crate::geometry::spaces::dim2::Dim2;
use crate::geometry::spaces::dim3::Dim3;
use crate::geometry::spaces::motion::Motion;
use crate::merge::plane::{combined, composed, equal};
use crate::merge::{merge, split_case, SetOp, SplitCase};
use crate::merge::{partition_tree, split_tree};
use crate::mesh::grid::Pitch;
use crate::python::hyperplanes::{in_plane, in_space, on_line, shape};
use crate::query::region::condense::condensed_line;
use crate::tree::partition::{
    from_preorder, is_bounded, preorder, stats, Entry, Label, PartitionTree, SubHyperplane,
    TreeStats,
};
use crate::tree::plane::tree_of;

impl Set {
    /// Makes the set inside a boundary of facets.
    pub fn build(dimension: usize, input: &Input, pitch: Pitch) -> Result<Self> {
        match dimension {
            1 => {
                let cuts = all(&input.cuts, on_line)?;
                Ok(Self::Line(inside_of(points(input, pitch)?, input, &cuts)?))
            }
            2 => {
                let cuts = all(&input.cuts, in_plane)?;
                let tree = inside_of(segments(input, pitch)?, input, &cuts)?;
                Ok(Self::Plane(tree.into()))
            }
            3 => {
                let cuts = all(&input.cuts, in_space)?;
                Ok(Self::Space(inside_of(
                    triangles(input, pitch)?,
                    input,
                    &cuts,
                )?))
            }
            _ => Err(bad_dimension(dimension)),
        }
    }

    /// Makes the set of all points, or the empty set.
    pub fn uniform(dimension: usize, full: bool) -> Result<Self> {
        let label = Label::from_inside(full);
        match dimension {
            1 => Ok(Self::Line(PartitionTree::Leaf(label))),
            2 => Ok(Self::Plane(PartitionTree::Leaf(label).into())),
            3 => Ok(Self::Space(PartitionTree::Leaf(label))),
            _ => Err(bad_dimension(dimension)),
        }
    }

    /// Makes the half-space on the minus side of a hyperplane.
    pub fn half_space(hyperplane: &[BigInt]) -> Result<Self> {
        let [minus, _] =
            Self::uniform(hyperplane.len().saturating_sub(1), true)?.split(hyperplane)?;
        Ok(minus)
    }

    /// The dimension: 1, 2 or 3.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Line(_) => 1,
            Self::Plane(_) => 2,
            Self::Space(_) => 3,
        }
    }

    /// The number of cuts of the tree or, in the plane, of edges of the boundary.
    pub fn size(&self) -> usize {
        match self {
            Self::Line(tree) => stats(tree).cuts,
            Self::Plane(set) => set.size(),
            Self::Space(tree) => stats(tree).cuts,
        }
    }

    /// Counts the cuts, leaves and facets of the tree.
    pub fn stats(&self) -> Result<TreeStats> {
        Ok(each!(self, tree => stats(tree)))
    }

    /// Returns true if the set contains all points, false if it is empty, `None` otherwise.
    pub fn uniform_label(&self) -> Option<bool> {
        let label = match self {
            Self::Line(tree) => tree.label(),
            Self::Plane(set) => set.label(),
            Self::Space(tree) => tree.label(),
        };
        label.map(|label| label == Label::In)
    }

    /// Returns true if the set fits into a box.
    pub fn is_bounded(&self) -> bool {
        match self {
            Self::Line(tree) => is_bounded(tree),
            Self::Plane(set) => set.is_bounded(),
            Self::Space(tree) => is_bounded(tree),
        }
    }

    /// Returns the complement of the set.
    pub fn complement(&self) -> Self {
        match self {
            Self::Line(tree) => Self::Line(tree.complement()),
            Self::Plane(set) => Self::Plane(set.complement()),
            Self::Space(tree) => Self::Space(tree.complement()),
        }
    }

    /// Applies a set operation by merging trees.
    pub fn merge(&self, other: &Self, op: SetOp) -> Result<Self> {
        match (self, other) {
            (Self::Line(a), Self::Line(b)) => Ok(Self::Line(merge(a, b, op)?)),
            (Self::Plane(a), Self::Plane(b)) => {
                Ok(Self::Plane(merge(a.tree()?, b.tree()?, op)?.into()))
            }
            (Self::Space(a), Self::Space(b)) => Ok(Self::Space(merge(a, b, op)?)),
            _ => Err(shape("the sets have different dimensions")),
        }
    }

    /// Applies a set operation by the faster method: merging trees or, in the plane, also a sweep over
    /// boundaries.
    pub fn combined(&self, other: &Self, op: SetOp) -> Result<Self> {
        match (self, other) {
            (Self::Plane(a), Self::Plane(b)) => combined(a, b, op).map(Self::Plane),
            _ => self.merge(other, op),
        }
    }

    /// Returns the union of sets of the plane.
    pub fn composed<'a>(sets: impl Iterator<Item = &'a Self>) -> Result<Self> {
        let sets = sets.map(Self::plane).collect::<Result<Vec<_>>>()?;
        composed(&sets).map(Self::Plane)
    }

    /// Returns true if two sets have the same points.
    pub fn equals(&self, other: &Self) -> Result<bool> {
        match (self, other) {
            (Self::Plane(a), Self::Plane(b)) => equal(a, b),
            _ => Ok(self
                .merge(other, SetOp::SymmetricDifference)?
                .uniform_label()
                == Some(false)),
        }
    }

    /// Returns the same set as a tree with the given hyperplane at its root.
    pub fn partitioned(&self, cut: &[BigInt]) -> Result<Self> {
        Ok(match self {
            Self::Line(tree) => Self::Line(rooted(tree, &on_line(cut)?)?),
            Self::Plane(set) => Self::Plane(rooted(set.tree()?, &in_plane(cut)?)?.into()),
            Self::Space(tree) => Self::Space(rooted(tree, &in_space(cut)?)?),
        })
    }

    /// Returns the parts of the set on the minus and on the plus side of a hyperplane.
    pub fn split(&self, cut: &[BigInt]) -> Result<[Self; 2]> {
        Ok(match self {
            Self::Line(tree) => halves(tree, &on_line(cut)?)?.map(Self::Line),
            Self::Plane(set) => {
                halves(set.tree()?, &in_plane(cut)?)?.map(|tree| Self::Plane(tree.into()))
            }
            Self::Space(tree) => halves(tree, &in_space(cut)?)?.map(Self::Space),
        })
    }

    /// Returns the name of the case (`SplitCase`) that describes the position of the root's cut relative to a
    /// hyperplane.
    pub fn split_case(&self, cut: &[BigInt]) -> Result<&'static str> {
        let case = match self {
            Self::Line(tree) => split_case(tree, &span::<Dim1>(&on_line(cut)?)?),
            Self::Plane(set) => split_case(set.tree()?, &span::<Dim2>(&in_plane(cut)?)?),
            Self::Space(tree) => split_case(tree, &span::<Dim3>(&in_space(cut)?)?),
        };
        case.map(SplitCase::name)
    }

    /// Returns the same set with a tree made from its boundary; in space the tree is unchanged.
    pub fn condensed(&self) -> Result<Self> {
        match self {
            Self::Line(tree) => condensed_line(tree).map(Self::Line),
            Self::Plane(set) => Ok(Self::Plane(tree_of(set.boundary()?)?.into())),
            Self::Space(_) => Ok(self.clone()),
        }
    }

    /// Returns the image of the set under a motion of the lattice.
    pub fn moved(&self, motion: &Motion) -> Result<Self> {
        let end = |h: &_| motion.end(h).ok_or_else(too_large);
        let line = |h: &_| motion.line(h).ok_or_else(too_large);
        let plane = |h: &Arc<Plane>| motion.plane(h).map(Arc::new).ok_or_else(too_large);
        Ok(match self {
            Self::Line(tree) => Self::Line(mapped(tree, end)?),
            Self::Plane(set) => Self::Plane(match set.own_boundary() {
                Some(boundary) => boundary.moved(motion).ok_or_else(too_large)?.into(),
                None => mapped(set.tree()?, line)?.into(),
            }),
            Self::Space(tree) => Self::Space(mapped(tree, plane)?),
        })
    }

    /// Returns the same set on a finer lattice; the empty set and the set of all points fit any lattice.
    pub fn refined(&self, own: Pitch, finer: Pitch) -> Result<Self> {
        if finer == own || self.uniform_label().is_some() {
            return Ok(self.clone());
        }
        self.moved(&Motion {
            scale: finer.refinement(own).ok_or_else(too_large)?,
            ..Motion::IDENTITY
        })
    }
}

fn too_large() -> Error {
    let text =
        "the moved or refined set does not fit the lattice of 2^53 steps; move the set less, or \
                choose a coarser pitch";
    Error::new(ErrorKind::TooLarge, text)
}

fn bad_dimension(dimension: usize) -> Error {
    shape(format!(
        "the dimension of a set must be 1, 2 or 3, not {dimension}"
    ))
}

fn span<S: AxisSpace>(cut: &S::Hyperplane) -> Result<S::Fragment> {
    S::span(cut, &S::universe()).ok_or_else(|| {
        let text =
            "the hyperplane misses the lattice of 2^53 steps; choose a hyperplane nearer to \
                    the origin";
        Error::new(ErrorKind::TooLarge, text)
    })
}

fn rooted<S: AxisSpace>(tree: &PartitionTree<S>, cut: &S::Hyperplane) -> Result<PartitionTree<S>> {
    partition_tree(tree, span::<S>(cut)?)
}

/// Returns the parts of a set on both sides of a hyperplane as sets of the whole space, with the hyperplane
/// at the root.
fn halves<S: AxisSpace>(
    tree: &PartitionTree<S>,
    cut: &S::Hyperplane,
) -> Result<[PartitionTree<S>; 2]> {
    let span = span::<S>(cut)?;
    let halves = split_tree(tree, &span)?;
    let sub_hyperplane = Arc::new(SubHyperplane {
        span,
        facets: halves.coplanar,
    });
    let other = Arc::clone(&sub_hyperplane);
    Ok([
        PartitionTree::cut(sub_hyperplane, halves.minus, PartitionTree::EMPTY),
        PartitionTree::cut(other, PartitionTree::EMPTY, halves.plus),
    ])
}

fn mapped<S: AxisSpace>(
    tree: &PartitionTree<S>,
    map: impl Fn(&S::Hyperplane) -> Result<S::Hyperplane>,
) -> Result<PartitionTree<S>> {
    let moved = preorder(tree).into_iter().map(|entry| {
        Ok(match entry {
            Entry::Leaf(label) => Entry::Leaf(label),
            Entry::Cut(cut) => Entry::Cut(map(&cut)?),
        })
    });
    let image = from_preorder(&moved.collect::<Result<Vec<_>>>()?, S::universe())?;
    // The image is right inside the frame; a bounded set must not lose a part outside it.
    if is_bounded(tree) && stats(&image).cuts != stats(tree).cuts {
        return Err(too_large());
    }
    Ok(image)
}
