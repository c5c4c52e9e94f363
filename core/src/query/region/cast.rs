//! Finds the intervals of a line inside a region of the plane.

use crate::error::Result;
use crate::geometry::side::{Half, Split};
use crate::geometry::spaces::dim2::{Dim2, Line2, Point2, Segment2, Square};
use crate::geometry::spaces::space::Space;
use crate::interrupt::poll;
use crate::tree::partition::{classify, Cut, Label, Location, PartitionTree};

/// Returns the maximal segments of a line in a region's interior, in the order of its direction (−b, a).
///
/// A segment along the boundary is not inside. A single boundary point on the line separates two segments.
/// The ends of an unbounded segment lie on the frame's border.
///
/// # Errors
/// `Internal` for a broken tree.
pub fn cast(tree: &PartitionTree<Dim2>, line: &Line2) -> Result<Vec<[Point2; 2]>> {
    let Some(whole) = Dim2::span(line, &Square) else {
        return Ok(Vec::new());
    };
    let mut found: Vec<Segment2> = Vec::new();
    let mut pending = vec![(tree.clone(), whole)];
    while let Some((tree, piece)) = pending.pop() {
        poll();
        let cut = match tree {
            PartitionTree::Leaf(Label::In) => {
                found.push(piece);
                continue;
            }
            PartitionTree::Leaf(Label::Out) => continue,
            PartitionTree::Cut(cut) => cut,
        };
        match Dim2::split(&piece, cut.hyperplane()) {
            Split::Minus => pending.push((cut.child(Half::Minus), piece)),
            Split::Plus => pending.push((cut.child(Half::Plus), piece)),
            Split::Both { minus, plus } => {
                pending.push((cut.child(Half::Minus), minus));
                pending.push((cut.child(Half::Plus), plus));
            }
            Split::Coplanar(_) => found.extend(inside_of_both(&cut, &piece)?),
        }
    }
    Ok(connected(tree, &whole, found))
}

/// Returns the parts of a segment in a cut that have the set on both sides of the cut.
fn inside_of_both(cut: &Cut<Dim2>, piece: &Segment2) -> Result<Vec<Segment2>> {
    let mut found = Vec::new();
    for (part, minus) in cut.child(Half::Minus).labels_beside(*piece)? {
        if minus == Label::In {
            let beyond = cut.child(Half::Plus).labels_beside(part)?;
            let inside = beyond.into_iter().filter(|(_, plus)| *plus == Label::In);
            found.extend(inside.map(|(part, _)| part));
        }
    }
    Ok(found)
}

/// Sorts segments along the line, and joins two if the point between them is inside, too.
fn connected(
    tree: &PartitionTree<Dim2>,
    whole: &Segment2,
    mut pieces: Vec<Segment2>,
) -> Vec<[Point2; 2]> {
    pieces.sort_by(|a, b| whole.order_along(&a.points()[0], &b.points()[0]));
    let mut stretches: Vec<[Point2; 2]> = Vec::new();
    for piece in pieces {
        let [from, to] = *piece.points();
        match stretches.last_mut() {
            Some(last) if last[1].order(&from).is_eq() && classify(tree, &from) == Location::In => {
                last[1] = to;
            }
            _ => stretches.push([from, to]),
        }
    }
    stretches
}
