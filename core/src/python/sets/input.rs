//! Reads the input that a set is made from: names, rows of doubles, hyperplanes.

use crate::error::{Error, ErrorKind, Result};
use crate::geometry::spaces::axis::AxisSpace;
use crate::geometry::spaces::dim1::{Dim1, Direction, Point1};
use crate::geometry::spaces::dim2::{Dim2, Lattice2, Segment2};
use crate::geometry::spaces::dim3::Dim3;
use crate::geometry::spaces::motion::Motion;
use crate::merge::plane::Outlines;
use crate::merge::SetOp;
use crate::mesh::grid::Pitch;
use crate::mesh::import::import;
use crate::python::hyperplanes::{shape, Row};
use crate::query::region::solid;
use crate::tree::partition::{enclosed, Facet, PartitionTree, PivotPolicy, Plan};

/// A rule that says which winding numbers are inside.
pub type Rule = fn(i32) -> bool;

/// The rule that chooses hyperplanes of facets as cuts, and whether axis-parallel cuts come before them.
pub type Policy = (PivotPolicy, bool);

/// The input that a set is made from.
#[derive(Debug)]
pub struct Input {
    /// Points with orientations (1D), ends of segments (2D), or vertices (3D).
    pub facets: Vec<Vec<f64>>,
    /// Triangles as vertex numbers, for a set in space.
    pub faces: Vec<[i64; 3]>,
    /// Hyperplanes that are used as cuts first.
    pub cuts: Vec<Row>,
    /// The rule that says which winding numbers are inside.
    pub rule: Rule,
    /// The rule that divides regions after the given cuts.
    pub policy: Policy,
}

/// Returns the winding rule with this name.
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

/// Returns the policy with this name.
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

/// Returns the set operation with this name.
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

/// Returns an error if two pitches differ.
pub fn same_lattice(a: Pitch, b: Pitch) -> Result<()> {
    if a == b {
        return Ok(());
    }
    let text = format!(
        "the sets have different lattice steps, 10^{} and 10^{}; make both with the same pitch",
        a.exponent(),
        b.exponent()
    );
    Err(Error::new(ErrorKind::PitchMismatch, text))
}

/// Returns the motion of the lattice given by signed axis numbers from 1 and a shift.
pub fn lattice_map(dimension: usize, axes: &[i64], shift: &[i64]) -> Result<Motion> {
    let found = Motion::of_axes(axes, shift).filter(|_| axes.len() == dimension);
    found.ok_or_else(|| shape("the axes and the shift do not map the lattice to itself"))
}

/// Converts each row; returns the first error, if there is one.
pub fn all<N, T>(rows: &[Vec<N>], make: impl Fn(&[N]) -> Result<T>) -> Result<Vec<T>> {
    rows.iter().map(|row| make(row)).collect()
}

fn numbers<const N: usize>(row: &[f64]) -> Result<[f64; N]> {
    row.try_into()
        .map_err(|_| shape(format!("a row must have {N} numbers, not {}", row.len())))
}

/// Makes the set inside facets.
pub fn inside_of<S: AxisSpace>(
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

/// Converts rows to facets, each with the number of its row; a row that gives no facet is left out.
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

/// Converts rows (x, ±1) to facets: +1 where the inside begins, −1 where it ends.
pub fn points(input: &Input, pitch: Pitch) -> Result<Vec<Facet<Dim1>>> {
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

/// Converts rows (x, y, x', y') to segments with the inside on the left, without those that snapping shrinks
/// to a point.
pub fn segments(input: &Input, pitch: Pitch) -> Result<Vec<Facet<Dim2>>> {
    facets(input, |row| {
        let [a, b, c, d] = numbers(row)?;
        let from = [pitch.snap(a)?, pitch.snap(b)?];
        let to = [pitch.snap(c)?, pitch.snap(d)?];
        Ok(Segment2::between(from, to))
    })
}

/// Converts rows (x, y, x', y'), segments of closed outlines with the inside on the left.
pub fn outlines(rows: &[[f64; 4]], pitch: Pitch) -> Result<Outlines> {
    let mut outlines = Outlines::default();
    let mut known = ([f64::NAN; 2], [0; 2]);
    for (source, &[a, b, c, d]) in (0..).zip(rows) {
        let added = corner([a, b], known, pitch).and_then(|from| {
            known = ([c, d], corner([c, d], known, pitch)?);
            outlines.push(from, known.1, 1)
        });
        added.map_err(|e| Error::at(e.kind(), vec![source], e.message()))?;
    }
    Ok(outlines)
}

/// Snaps a corner to the lattice; `known` is the end of the previous segment with its lattice point, because
/// most segments begin there.
#[allow(
    clippy::float_cmp,
    reason = "the same corner is given by the same doubles"
)]
fn corner(at: [f64; 2], known: ([f64; 2], Lattice2), pitch: Pitch) -> Result<Lattice2> {
    if at == known.0 {
        return Ok(known.1);
    }
    Ok([pitch.snap(at[0])?, pitch.snap(at[1])?])
}

/// Converts a closed mesh to facets.
pub fn triangles(input: &Input, pitch: Pitch) -> Result<Vec<Facet<Dim3>>> {
    let vertices = all(&input.facets, numbers)?;
    solid::facets(&import(&vertices, &input.faces, Some(pitch))?)
}
