//! The leaf kernel for cells in which every face is perpendicular to an axis.
//!
//! The planes of the faces make a grid of the cell. An operand is inside in whole regions of it, so
//! that sets of regions are bits, expressions are evaluated a word at a time, and faces in one plane
//! need no special care. What a face keeps is found on the rectangles of its plane.

mod extent;
mod facet;
mod grid;
mod keep;
mod labels;
mod pieces;

use super::kept::Kept;
use crate::geometry::cell::Cell;
use crate::merge::expression::Expression;
use crate::merge::lists::list::{List, Sources};
use extent::Extent;
use facet::Facets;
use grid::Grid;
use keep::Scene;

/// Words of all operands' columns, at most: two megabytes, which stay in a cache.
const MOST: usize = 1 << 18;

/// What stays of the operands' boundaries in a cell, and the winding number at its corner; `None`
/// if a face is not perpendicular to an axis, an operand overlaps itself, or the grid is too fine.
pub fn evaluate(
    cell: &Cell,
    expression: &Expression,
    lists: &[(u32, &List)],
    sources: &Sources,
) -> Option<(Vec<Kept>, i32)> {
    let facets = Facets::new(cell, lists, sources)?;
    let grid = Grid::new(cell, &facets)?;
    if lists.len() * grid.columns() > MOST {
        return None;
    }
    let extents: Vec<Extent> = facets.all.iter().map(|f| f.extent(&grid)).collect();
    let fields = fields(&grid, &facets, &extents, lists)?;
    let value = value(expression, lists, &fields, grid.columns());
    let scene = Scene {
        cell,
        grid: &grid,
        facets: &facets,
        extents: &extents,
        fields: &fields,
        value: &value,
    };
    let kept = scene.keep()?;
    Some((kept, i32::from(value[0] & 1 != 0)))
}

/// Where each operand is inside.
fn fields(
    grid: &Grid,
    facets: &Facets,
    extents: &[Extent],
    lists: &[(u32, &List)],
) -> Option<Vec<Vec<u64>>> {
    let mut start = 0;
    let field = |(operand, (_, list)): (usize, &(u32, &List))| {
        let end = facets.all.partition_point(|f| f.operand <= operand);
        let own = std::mem::replace(&mut start, end)..end;
        let facets = facets.all[own.clone()].iter().zip(&extents[own]);
        labels::field(grid, facets, list.corner)
    };
    lists.iter().enumerate().map(field).collect()
}

/// Where an expression is true.
fn value(
    expression: &Expression,
    lists: &[(u32, &List)],
    fields: &[Vec<u64>],
    columns: usize,
) -> Vec<u64> {
    let last = lists.last().map_or(0, |l| l.0 as usize);
    let mut places = vec![0; last + 1];
    for (place, (number, _)) in lists.iter().enumerate() {
        places[*number as usize] = place;
    }
    let scratch = &mut Vec::new();
    let word = |i: usize, scratch: &mut _| {
        expression.words(|k: u32| fields[places[k as usize]][i], scratch)
    };
    (0..columns).map(|i| word(i, scratch)).collect()
}
