//! Checks that facets are closed, so that the intervals of a ray inside them are defined.

use super::facet::Facet;
use crate::error::{Error, ErrorKind, Result};
use crate::mesh::grid::Pitch;
use crate::mesh::import::import;

/// Refuses facets that are not closed on the lattice; `number` gives a facet's index in the input.
///
/// Triangles must cancel along the lines of their edges, as many segments must end at each point as begin
/// there, and the number of points on the line must be even.
///
/// # Errors
/// `NotClosed` with the indices in the input of facets at the border.
pub fn require_closed<const D: usize>(
    facets: &[Facet<D>],
    number: impl Fn(u32) -> u32,
) -> Result<()> {
    match D {
        1 => points(facets),
        2 => segments(facets, number),
        _ => triangles(facets, number),
    }
}

fn points<const D: usize>(facets: &[Facet<D>]) -> Result<()> {
    let count = facets.len();
    if count.is_multiple_of(2) {
        return Ok(());
    }
    let text = format!("{count} points of the line do not bound a set: their number must be even");
    Err(Error::new(ErrorKind::NotClosed, text))
}

fn segments<const D: usize>(facets: &[Facet<D>], number: impl Fn(u32) -> u32) -> Result<()> {
    let facets = (0..).zip(facets);
    let ends = facets.flat_map(|(facet, corners)| {
        let end = |k: usize, step: i64| (corners[k].map(|c| c as i64), step, facet);
        [end(0, 1), end(1, -1)]
    });
    let mut ends: Vec<([i64; D], i64, u32)> = ends.collect();
    ends.sort_unstable();
    for run in ends.chunk_by(|a, b| a.0 == b.0) {
        if run.iter().map(|end| end.1).sum::<i64>() != 0 {
            let place = run.iter().map(|end| u64::from(number(end.2)));
            let text = "the segments are not closed: in each point as many must end as begin there";
            return Err(Error::at(ErrorKind::NotClosed, place.collect(), text));
        }
    }
    Ok(())
}

fn triangles<const D: usize>(facets: &[Facet<D>], number: impl Fn(u32) -> u32) -> Result<()> {
    if facets.is_empty() {
        return Ok(());
    }
    let corner = |p: &[f64; D]| [p[0], p[1], p[2]];
    let vertices: Vec<_> = facets.iter().flatten().map(corner).collect();
    let face = |k: i64| [3 * k, 3 * k + 1, 3 * k + 2];
    let faces: Vec<_> = (0..facets.len() as i64).map(face).collect();
    // The corners are integers already.
    let steps = Pitch::new(0)?;
    match import(&vertices, &faces, Some(steps)) {
        Err(e) if e.kind() == ErrorKind::NotClosed => Err(at_input(number, &e)),
        other => other.map(|_| ()),
    }
}

fn at_input(number: impl Fn(u32) -> u32, error: &Error) -> Error {
    let number = |place: &u64| u64::from(number(*place as u32));
    let places = error.place().iter().map(number).collect();
    Error::at(error.kind(), places, error.message())
}
