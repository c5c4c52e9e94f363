//! A set of any dimension: what Python's one class `ObjectTree` holds.

use super::each::{each, map_each};
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::axis::AxisSpace;
use crate::geometry::dim1::{Dim1, Direction, Point1};
use crate::geometry::dim2::{Dim2, Segment2};
use crate::geometry::dim3::Dim3;
use crate::geometry::side::Half;
use crate::merge::{merge, partition_tree, split_case, split_tree, SetOp, SplitCase};
use crate::mesh::grid::Pitch;
use crate::mesh::import::import;
use crate::query::region::condense::{condensed_line, condensed_plane};
use crate::query::region::hyperplane::{line, plane, point, LatticeMap};
use crate::query::region::solid;
use crate::tree::partition::{
    enclosed, from_preorder, is_bounded, preorder, stats, Entry, Facet, Label, PartitionTree,
    PivotPolicy, Plan, TreeStats,
};

/// A set of points as a partition tree.
#[derive(Clone, Debug)]
pub enum Set {
    /// On the line.
    Line(PartitionTree<Dim1>),
    /// In the plane.
    Plane(PartitionTree<Dim2>),
    /// In space.
    Space(PartitionTree<Dim3>),
}

/// Which winding numbers are inside.
pub type Rule = fn(i32) -> bool;

/// How the facets' hyperplanes are chosen, and whether axis-parallel cuts come above them.
pub type Policy = (PivotPolicy, bool);

/// What a set is built from.
#[derive(Debug)]
pub struct Input {
    /// Points with orientations (1D), ends of segments (2D), or vertices (3D).
    pub facets: Vec<Vec<f64>>,
    /// Triangles, in space.
    pub faces: Vec<[i64; 3]>,
    /// Hyperplanes to be cut along first: the normal, then the offset.
    pub cuts: Vec<Vec<f64>>,
    /// Which winding numbers are inside.
    pub rule: Rule,
    /// How the rest is divided.
    pub policy: Policy,
}

/// The rule of this name.
pub fn rule(name: &str) -> Result<Rule> {
    match name {
        "positive" => Ok(|number| number > 0),
        "nonzero" => Ok(|number| number != 0),
        "even-odd" => Ok(|number| number % 2 != 0),
        _ => Err(unknown(
            name,
            "a winding rule",
            "positive, nonzero or even-odd",
        )),
    }
}

/// The policy of this name.
pub fn policy(name: &str, seed: u64) -> Result<Policy> {
    match name {
        "balanced" => Ok((PivotPolicy::Random(seed), true)),
        "random" => Ok((PivotPolicy::Random(seed), false)),
        "first" => Ok((PivotPolicy::First, false)),
        "fewest-splits" => Ok((PivotPolicy::FewestSplits(16), false)),
        _ => {
            let known = "balanced, random, first or fewest-splits";
            Err(unknown(name, "a policy", known))
        }
    }
}

/// The set operation of this name.
pub fn operation(name: &str) -> Result<SetOp> {
    match name {
        "union" => Ok(SetOp::Union),
        "intersection" => Ok(SetOp::Intersection),
        "difference" => Ok(SetOp::Difference),
        "xor" => Ok(SetOp::SymmetricDifference),
        _ => {
            let known = "union, intersection, difference or xor";
            Err(unknown(name, "an operation", known))
        }
    }
}

fn unknown(name: &str, what: &str, known: &str) -> Error {
    shape(format!("'{name}' is not {what}; use {known}"))
}

pub(super) fn shape(text: impl Into<String>) -> Error {
    Error::new(ErrorKind::Shape, text)
}

/// Refuses operands of different pitch.
pub fn same_lattice(a: Pitch, b: Pitch) -> Result<()> {
    if a == b {
        return Ok(());
    }
    let text = format!(
        "the sets live on lattices of pitch 10^{} and 10^{}",
        a.exponent(),
        b.exponent()
    );
    Err(Error::new(ErrorKind::PitchMismatch, text))
}

/// The map of the lattice that signed axis numbers from 1, a shift and a scale describe.
pub fn lattice_map(
    dimension: usize,
    axes: &[i64],
    shift: Vec<i64>,
    scale: i64,
) -> Result<LatticeMap> {
    let mut sorted: Vec<u64> = axes.iter().map(|a| a.unsigned_abs()).collect();
    sorted.sort_unstable();
    let permutes = (1..).zip(&sorted).all(|(i, a)| i == *a);
    if axes.len() != dimension || shift.len() != dimension || !permutes || scale < 1 {
        return Err(shape("the axes, shift and scale are no map of the lattice"));
    }
    let axes = axes
        .iter()
        .map(|a| (a.unsigned_abs() as usize - 1, a.signum()));
    Ok(LatticeMap {
        axes: axes.collect(),
        shift,
        scale,
    })
}

impl Set {
    /// The set inside a boundary.
    pub fn build(dimension: usize, input: &Input, pitch: Pitch) -> Result<Self> {
        match dimension {
            1 => {
                let cuts = all(&input.cuts, |cut| on_line(cut, pitch))?;
                Ok(Self::Line(set(points(input, pitch)?, input, &cuts)?))
            }
            2 => {
                let cuts = all(&input.cuts, |cut| in_plane(cut, pitch))?;
                Ok(Self::Plane(set(segments(input, pitch)?, input, &cuts)?))
            }
            3 => {
                let cuts = all(&input.cuts, |cut| in_space(cut, pitch))?;
                Ok(Self::Space(set(triangles(input, pitch)?, input, &cuts)?))
            }
            _ => Err(bad_dimension(dimension)),
        }
    }

    /// Everything, or nothing.
    pub fn uniform(dimension: usize, full: bool) -> Result<Self> {
        let label = Label::from_inside(full);
        match dimension {
            1 => Ok(Self::Line(PartitionTree::Leaf(label))),
            2 => Ok(Self::Plane(PartitionTree::Leaf(label))),
            3 => Ok(Self::Space(PartitionTree::Leaf(label))),
            _ => Err(bad_dimension(dimension)),
        }
    }

    /// The minus side of a hyperplane.
    pub fn half_space(hyperplane: &[f64], pitch: Pitch) -> Result<Self> {
        let [minus, _] =
            Self::uniform(hyperplane.len().saturating_sub(1), true)?.split(hyperplane, pitch)?;
        Ok(minus)
    }

    /// The dimension.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Line(_) => 1,
            Self::Plane(_) => 2,
            Self::Space(_) => 3,
        }
    }

    /// The number of nodes.
    pub fn size(&self) -> usize {
        self.stats().cuts
    }

    /// Size figures.
    pub fn stats(&self) -> TreeStats {
        each!(self, tree => stats(tree))
    }

    /// Whether everything (true) or nothing (false) is inside, if either.
    pub fn uniform_label(&self) -> Option<bool> {
        each!(self, tree => tree.label()).map(|label| label == Label::In)
    }

    /// Whether the set fits into some box.
    pub fn is_bounded(&self) -> bool {
        each!(self, tree => is_bounded(tree))
    }

    /// Everything else.
    pub fn complement(&self) -> Self {
        map_each!(self, tree => tree.complement())
    }

    /// The set operation by merging trees.
    pub fn merge(&self, other: &Self, op: SetOp) -> Result<Self> {
        match (self, other) {
            (Self::Line(a), Self::Line(b)) => Ok(Self::Line(merge(a, b, op)?)),
            (Self::Plane(a), Self::Plane(b)) => Ok(Self::Plane(merge(a, b, op)?)),
            (Self::Space(a), Self::Space(b)) => Ok(Self::Space(merge(a, b, op)?)),
            _ => Err(shape("the sets have different dimensions")),
        }
    }

    /// The same set with a hyperplane in its root.
    pub fn partitioned(&self, cut: &[f64], pitch: Pitch) -> Result<Self> {
        Ok(match self {
            Self::Line(tree) => Self::Line(rooted(tree, &on_line(cut, pitch)?)?),
            Self::Plane(tree) => Self::Plane(rooted(tree, &in_plane(cut, pitch)?)?),
            Self::Space(tree) => Self::Space(rooted(tree, &in_space(cut, pitch)?)?),
        })
    }

    /// The parts of the set on the minus and the plus side of a hyperplane.
    pub fn split(&self, cut: &[f64], pitch: Pitch) -> Result<[Self; 2]> {
        Ok(match self {
            Self::Line(tree) => halves(tree, &on_line(cut, pitch)?)?.map(Self::Line),
            Self::Plane(tree) => halves(tree, &in_plane(cut, pitch)?)?.map(Self::Plane),
            Self::Space(tree) => halves(tree, &in_space(cut, pitch)?)?.map(Self::Space),
        })
    }

    /// The name of the case that the root and a hyperplane are.
    pub fn split_case(&self, cut: &[f64], pitch: Pitch) -> Result<&'static str> {
        let case = match self {
            Self::Line(tree) => split_case(tree, &span::<Dim1>(&on_line(cut, pitch)?)?),
            Self::Plane(tree) => split_case(tree, &span::<Dim2>(&in_plane(cut, pitch)?)?),
            Self::Space(tree) => split_case(tree, &span::<Dim3>(&in_space(cut, pitch)?)?),
        };
        case.map(case_name)
    }

    /// The same set as a tree of a size that its boundary asks for; in space the tree itself.
    pub fn condensed(&self) -> Result<Self> {
        match self {
            Self::Line(tree) => condensed_line(tree).map(Self::Line),
            Self::Plane(tree) => condensed_plane(tree).map(Self::Plane),
            Self::Space(_) => Ok(self.clone()),
        }
    }

    /// The image under a map of the lattice.
    pub fn moved(&self, map: &LatticeMap) -> Result<Self> {
        Ok(match self {
            Self::Line(tree) => Self::Line(mapped(tree, |h| map.point(h))?),
            Self::Plane(tree) => Self::Plane(mapped(tree, |h| map.line(h))?),
            Self::Space(tree) => Self::Space(mapped(tree, |h| map.plane(h))?),
        })
    }
}

fn bad_dimension(dimension: usize) -> Error {
    shape(format!("sets have dimension 1, 2 or 3, not {dimension}"))
}

fn case_name(case: SplitCase) -> &'static str {
    match case {
        SplitCase::Leaf => "leaf",
        SplitCase::Same => "same",
        SplitCase::Opposite => "opposite",
        SplitCase::Crossing => "crossing",
        SplitCase::OneSided { deep, home } => match (deep, home) {
            (Half::Minus, Half::Minus) => "minus-minus",
            (Half::Minus, Half::Plus) => "minus-plus",
            (Half::Plus, Half::Minus) => "plus-minus",
            (Half::Plus, Half::Plus) => "plus-plus",
        },
    }
}

fn all<T>(rows: &[Vec<f64>], make: impl Fn(&[f64]) -> Result<T>) -> Result<Vec<T>> {
    rows.iter().map(|row| make(row)).collect()
}

fn numbers<const N: usize>(row: &[f64]) -> Result<[f64; N]> {
    row.try_into()
        .map_err(|_| shape(format!("a row must have {N} numbers, not {}", row.len())))
}

fn on_line(cut: &[f64], pitch: Pitch) -> Result<Point1> {
    let [n, offset] = numbers(cut)?;
    point(n, offset, pitch)
}

fn in_plane(cut: &[f64], pitch: Pitch) -> Result<crate::geometry::dim2::Line2> {
    let [a, b, offset] = numbers(cut)?;
    line([a, b], offset, pitch)
}

fn in_space(cut: &[f64], pitch: Pitch) -> Result<std::sync::Arc<crate::geometry::plane::Plane>> {
    let [a, b, c, offset] = numbers(cut)?;
    plane([a, b, c], offset, pitch)
}

fn set<S: AxisSpace>(
    facets: Vec<Facet<S>>,
    input: &Input,
    cuts: &[S::Hyperplane],
) -> Result<PartitionTree<S>> {
    let (policy, axis_cuts) = input.policy;
    let plan = Plan {
        cuts,
        axis_cuts,
        policy,
    };
    enclosed(facets, 0, input.rule, &plan)
}

/// Facets with the numbers of their rows; rows without a facet are left out.
fn facets<S: AxisSpace>(
    input: &Input,
    make: impl Fn(&[f64]) -> Result<Option<S::Fragment>>,
) -> Result<Vec<Facet<S>>> {
    let mut facets = Vec::new();
    for (source, row) in (0..).zip(&input.facets) {
        let fragment = make(row).map_err(|e| Error::at(e.kind(), vec![source], e.message()))?;
        facets.extend(fragment.map(|fragment| Facet { fragment, source }));
    }
    Ok(facets)
}

/// Rows (x, ±1): +1 where the inside begins, −1 where it ends.
fn points(input: &Input, pitch: Pitch) -> Result<Vec<Facet<Dim1>>> {
    facets(input, |row| {
        let [x, sign] = numbers(row)?;
        let inside = if sign > 0.0 {
            Direction::Above
        } else {
            Direction::Below
        };
        Ok(Some(Point1::new(pitch.snap(x)?, inside)))
    })
}

/// Rows (x, y, x', y'), the inside on the left; those the lattice shrinks to a point are left out.
fn segments(input: &Input, pitch: Pitch) -> Result<Vec<Facet<Dim2>>> {
    facets(input, |row| {
        let [a, b, c, d] = numbers(row)?;
        let from = [pitch.snap(a)?, pitch.snap(b)?];
        let to = [pitch.snap(c)?, pitch.snap(d)?];
        Ok(Segment2::between(from, to))
    })
}

fn triangles(input: &Input, pitch: Pitch) -> Result<Vec<Facet<Dim3>>> {
    let vertices = all(&input.facets, numbers)?;
    solid::facets(&import(&vertices, &input.faces, Some(pitch))?)
}

fn span<S: AxisSpace>(cut: &S::Hyperplane) -> Result<S::Fragment> {
    S::span(cut, &S::universe()).ok_or_else(|| {
        let text = "the hyperplane misses the lattice of 2^53 steps";
        Error::new(ErrorKind::TooLarge, text)
    })
}

fn rooted<S: AxisSpace>(tree: &PartitionTree<S>, cut: &S::Hyperplane) -> Result<PartitionTree<S>> {
    partition_tree(tree, span::<S>(cut)?)
}

/// Both halves as sets of the whole space: the hyperplane in the root, the other side empty.
fn halves<S: AxisSpace>(
    tree: &PartitionTree<S>,
    cut: &S::Hyperplane,
) -> Result<[PartitionTree<S>; 2]> {
    let span = span::<S>(cut)?;
    let halves = split_tree(tree, &span)?;
    let sheet = std::sync::Arc::new(crate::tree::partition::Sheet {
        span,
        facets: halves.coplanar,
    });
    let other = std::sync::Arc::clone(&sheet);
    Ok([
        PartitionTree::cut(sheet, halves.minus, PartitionTree::EMPTY),
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
    // Inside the frame the image is right; a bounded set must not lose what lies beyond.
    if is_bounded(tree) && stats(&image).cuts != stats(tree).cuts {
        let text = "the moved or refined set does not fit the lattice of 2^53 steps";
        return Err(Error::new(ErrorKind::TooLarge, text));
    }
    Ok(image)
}
