//! Sets as labelled trees: their parts for the page, splitting and merging with every step.

use bspcsg::error::{Error, ErrorKind, Result};
use bspcsg::geometry::side::Half;
use bspcsg::geometry::spaces::affine::{Affine, Polytope};
use bspcsg::geometry::spaces::axis::AxisSpace;
use bspcsg::merge::generic::merge_trees::merge_watched;
use bspcsg::merge::generic::split_tree::split_tree_watched;
use bspcsg::merge::generic::trace::{Decision, Journal, MergeStep, NodeName};
use bspcsg::merge::op::SetOp;
use bspcsg::tree::partition::{enclosed, Facet, Label, PartitionTree, PivotPolicy, Plan};
use serde::Serialize;

use crate::scene::{corners, on_page_plane, room_of, walls, Walls};
use crate::units::lattice;

/// A tree as lists in preorder, minus before plus.
#[derive(Serialize)]
pub struct SetView {
    nodes: Vec<NodeView>,
    /// The places of the inner nodes.
    inner: Vec<usize>,
}

#[derive(Serialize)]
struct NodeView {
    /// The label of a leaf.
    label: Option<Label>,
    /// The facet whose hyperplane it is, of the first set or of the second.
    name: String,
    region: Walls,
    span: Vec<[f64; 3]>,
    hyperplane: [f64; 4],
}

/// A tree split by a hyperplane.
#[derive(Serialize)]
pub struct Splitting {
    second: SetView,
    sides: [SetView; 2],
    span: Vec<[f64; 3]>,
    steps: Vec<MergeStep>,
}

/// Two trees merged.
#[derive(Serialize)]
pub struct Merging {
    first: SetView,
    second: SetView,
    result: SetView,
    steps: Vec<MergeStep>,
    /// The region in which each step takes place.
    places: Vec<Walls>,
}

/// The facets of two sets, whose hyperplanes give nodes their names.
struct Names<S: AxisSpace> {
    facets: [Vec<Facet<S>>; 2],
}

impl<S: AxisSpace> Names<S> {
    fn of(&self, cut: &S::Hyperplane) -> String {
        let found = ["a", "b"]
            .iter()
            .zip(&self.facets)
            .find_map(|(set, facets)| {
                let is_own = |f: &Facet<S>| S::coincide(S::hyperplane(&f.fragment), cut).is_some();
                let place = facets.iter().position(is_own)?;
                Some(format!("{set}{}", place + 1))
            });
        found.unwrap_or_default()
    }
}

/// The boundary of a set: ends of intervals, a loop of corners, or faces.
pub struct Outline<'a> {
    /// Coordinates, one corner after the other.
    pub corners: &'a [f64],
    /// Loop or face i owns the corners `offsets[i]..offsets[i + 1]`.
    pub offsets: &'a [i32],
}

impl Outline<'_> {
    fn facets<S: AxisSpace + Affine>(&self) -> Result<Vec<Facet<S>>> {
        let points = lattice(self.corners, S::DIM);
        let wrong = || Error::new(ErrorKind::Shape, "the outline has a facet without extent");
        let mut found: Vec<S::Fragment> = Vec::new();
        for pair in self.offsets.windows(2) {
            let place = |k: i32| usize::try_from(k).unwrap_or(usize::MAX);
            let part = points
                .get(place(pair[0])..place(pair[1]))
                .ok_or_else(wrong)?;
            match S::DIM {
                1 => found.extend(ends::<S>(part)),
                2 => {
                    for (k, from) in part.iter().enumerate() {
                        let to = part[(k + 1) % part.len()];
                        found.push(S::fragment(&[*from, to]).ok_or_else(wrong)?);
                    }
                }
                _ => found.push(S::fragment(part).ok_or_else(wrong)?),
            }
        }
        let numbered = found.into_iter().zip(0..);
        Ok(numbered
            .map(|(fragment, source)| Facet { fragment, source })
            .collect())
    }
}

/// The ends of intervals: every other one has its inside above.
fn ends<S: Affine>(points: &[[i64; 3]]) -> Vec<S::Fragment> {
    let end = |(k, p): (usize, &[i64; 3])| {
        let end = S::fragment(&[*p])?;
        Some(if k % 2 == 0 { S::reversed(&end) } else { end })
    };
    points.iter().enumerate().filter_map(end).collect()
}

fn tree_of<S: AxisSpace>(facets: &[Facet<S>]) -> Result<PartitionTree<S>> {
    let plan = Plan {
        cuts: &[],
        axis_cuts: false,
        policy: PivotPolicy::First,
    };
    enclosed(facets.to_vec(), 0, |winding| winding > 0, &plan)
}

fn view<S: AxisSpace + Affine>(
    tree: &PartitionTree<S>,
    whole: Option<&Polytope<S>>,
    names: &Names<S>,
) -> SetView {
    let mut found = SetView {
        nodes: Vec::new(),
        inner: Vec::new(),
    };
    let mut pending = vec![(tree.clone(), whole.cloned())];
    while let Some((next, region)) = pending.pop() {
        let mut node = NodeView {
            label: next.label(),
            name: String::new(),
            region: region.as_ref().map_or_else(Vec::new, walls),
            span: Vec::new(),
            hyperplane: [0.0; 4],
        };
        if let PartitionTree::Cut(cut) = &next {
            let own = cut.hyperplane();
            node.name = names.of(own);
            node.hyperplane = on_page_plane::<S>(own);
            let span = region.as_ref().and_then(|r| r.span(own));
            node.span = span.as_ref().map_or_else(Vec::new, corners::<S>);
            found.inner.push(found.nodes.len());
            let [minus, plus] = region.map_or([None, None], |r| r.divided(own));
            pending.push((cut.child(Half::Plus), plus));
            pending.push((cut.child(Half::Minus), minus));
        }
        found.nodes.push(node);
    }
    found
}

/// Splits a set's tree by the hyperplane through `points`.
pub fn split<S: AxisSpace + Affine>(
    outline: &Outline,
    points: &[f64],
    room: &[f64],
) -> Result<Splitting> {
    let names = Names::<S> {
        facets: [outline.facets()?, Vec::new()],
    };
    let whole = room_of::<S>(room)?;
    let wrong = || Error::new(ErrorKind::Shape, "the hyperplane does not cross the room");
    let cut = S::fragment(&lattice(points, S::DIM)).ok_or_else(wrong)?;
    let cut = S::hyperplane(&cut);
    let tree = tree_of(&names.facets[0])?;
    let mut journal = Journal::new(&PartitionTree::EMPTY, &tree);
    let span = S::span(cut, &S::universe()).ok_or_else(wrong)?;
    let halves = split_tree_watched(&tree, &span, &mut journal)?;
    let [minus, plus] = whole.divided(cut);
    Ok(Splitting {
        second: view(&tree, Some(&whole), &names),
        sides: [
            view(&halves.minus, minus.as_ref(), &names),
            view(&halves.plus, plus.as_ref(), &names),
        ],
        span: whole.span(cut).as_ref().map_or_else(Vec::new, corners::<S>),
        steps: journal.into_steps(),
    })
}

/// Merges the trees of two sets.
pub fn merge<S: AxisSpace + Affine>(
    outlines: [&Outline; 2],
    operation: &str,
    room: &[f64],
) -> Result<Merging> {
    let names = Names::<S> {
        facets: [outlines[0].facets()?, outlines[1].facets()?],
    };
    let whole = room_of::<S>(room)?;
    let [a, b] = [tree_of(&names.facets[0])?, tree_of(&names.facets[1])?];
    let mut journal = Journal::new(&a, &b);
    let result = merge_watched(&a, &b, named(operation)?, &mut journal)?;
    let steps = journal.into_steps();
    Ok(Merging {
        places: places(&a, &whole, &steps),
        first: view(&a, Some(&whole), &names),
        second: view(&b, Some(&whole), &names),
        result: view(&result, Some(&whole), &names),
        steps,
    })
}

fn named(operation: &str) -> Result<SetOp> {
    Ok(match operation {
        "union" => SetOp::Union,
        "intersection" => SetOp::Intersection,
        "difference" => SetOp::Difference,
        "xor" => SetOp::SymmetricDifference,
        _ => return Err(Error::new(ErrorKind::Shape, "there is no such operation")),
    })
}

/// The region of the pair that each step works on.
fn places<S: AxisSpace + Affine>(
    a: &PartitionTree<S>,
    whole: &Polytope<S>,
    steps: &[MergeStep],
) -> Vec<Walls> {
    let inner = inner_nodes(a, whole);
    let shown = |region: &Option<Polytope<S>>| region.as_ref().map_or_else(Vec::new, walls);
    let mut waiting = vec![Some(whole.clone())];
    let mut now = None;
    let mut found = Vec::with_capacity(steps.len());
    for step in steps {
        match step {
            MergeStep::Pair { a, decision, .. } => {
                now = waiting.pop().flatten();
                if let (NodeName::First(number), Decision::Divide) = (a, decision) {
                    if let Some((cut, _)) = inner.get(number.index()) {
                        let [minus, plus] = now.as_ref().map_or([None, None], |r| r.divided(cut));
                        waiting.extend([plus, minus]);
                    }
                }
                found.push(shown(&now));
            }
            MergeStep::Join {
                node: NodeName::First(number),
                ..
            } => {
                let own = inner
                    .get(number.index())
                    .and_then(|(_, region)| region.clone());
                found.push(shown(&own));
            }
            _ => found.push(shown(&now)),
        }
    }
    found
}

type Divided<S> = (
    <S as bspcsg::geometry::spaces::space::Space>::Hyperplane,
    Option<Polytope<S>>,
);

/// The hyperplane and region of each inner node, in preorder.
fn inner_nodes<S: AxisSpace + Affine>(
    tree: &PartitionTree<S>,
    whole: &Polytope<S>,
) -> Vec<Divided<S>> {
    let mut found = Vec::new();
    let mut pending = vec![(tree.clone(), Some(whole.clone()))];
    while let Some((next, region)) = pending.pop() {
        if let PartitionTree::Cut(cut) = next {
            let own = cut.hyperplane().clone();
            let [minus, plus] = region.as_ref().map_or([None, None], |r| r.divided(&own));
            pending.push((cut.child(Half::Plus), plus));
            pending.push((cut.child(Half::Minus), minus));
            found.push((own, region));
        }
    }
    found
}
