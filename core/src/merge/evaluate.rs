//! Evaluates Boolean expressions over solids, and unites a solid with itself.

use std::sync::Arc;

use super::arrangement::{arranged, is_simple_mesh, united, United, MIN_FACES_FOR_POOL};
use super::descent::counters::Counters;
use super::descent::descend::Descent;
use super::expression::{Expression, Term};
use super::lists::list::Sources;
use super::overlaps::overlaps_itself_at;
use super::profile::{Declined, Profile};
use super::rule::Rule;
use super::twins::without_twins;
use crate::arith::convert::as_number;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::plane::Lattice;
use crate::interrupt::handed_over;
use crate::mesh::grid::Pitch;
use crate::mesh::source::Source;
use crate::tree::node::Branch;
use crate::tree::solid::Solid;
use crate::tree::table::SourceTable;

/// If kernels solved this many elements (faces or parts of faces) to make an operand, the next operation on
/// it probably takes as long, a millisecond or more, and runs in the thread pool; waking the pool takes about
/// 50 µs.
const POOL_AFTER: u64 = 512;

/// Returns the value of a Boolean expression over solids, and counts of the work.
///
/// A point is inside the result exactly where the expression holds for the operands. If all operands are
/// reduced (each wall between inside and outside is listed once, and nothing else), so is the result. An operand
/// that turns out to overlap itself is resolved in the arrangement; for a descent it is united with itself, and
/// the descent restarts.
///
/// # Errors
/// `PitchMismatch` if the operands live on different lattices.
///
/// # Source
/// Naylor, Amanatides, Thibault 1990; `docs/design/descent.md`.
///
/// # Example
/// ```
/// use std::sync::Arc;
///
/// use bspcsg::merge::evaluate::evaluate;
/// use bspcsg::merge::expression::{Expression, Term};
/// use bspcsg::mesh::import::import;
/// use bspcsg::query::measure::volume;
/// use bspcsg::tree::solid::Solid;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let moved = vertices.map(|[x, y, z]| [x + 0.5, y, z]);
/// let of_mesh = |vertices| -> Result<Solid, bspcsg::error::Error> {
///     Ok(Solid::of_source(Arc::new(import(vertices, &faces, None)?), false))
/// };
/// let solids = [of_mesh(&vertices)?, of_mesh(&moved)?];
/// let both = vec![Term::Operand(0), Term::Operand(1), Term::And(vec![0, 1])];
/// let (common, _) = evaluate(&Expression::new(both)?, &solids)?;
/// // A tetrahedron of half the size, exactly.
/// let size = volume(&common)?;
/// assert_eq!(size.numerator * 48, size.denominator);
/// # Ok::<(), bspcsg::error::Error>(())
/// ```
pub fn evaluate(expression: &Expression, solids: &[Solid]) -> Result<(Solid, Counters)> {
    let pitch = common_pitch(expression, solids)?;
    let merged = without_twins(expression, solids);
    let expression = merged.as_ref().unwrap_or(expression);
    let mut operands: Vec<Solid> = solids.iter().map(bounding).collect();
    let mut profile = Profile::default();
    let reason = match evaluate_imported_meshes(expression, &operands, pitch, &mut profile) {
        Ok((solid, counters)) => return Ok((solid, counters.with(profile))),
        Err(reason) => reason,
    };
    profile.declined = Some(reason);
    let mut overlaps: Vec<usize> = reason.overlapping().into_iter().collect();
    let mut is_first = overlaps.is_empty();
    loop {
        unite_operands(&mut operands, &overlaps, &mut profile)?;
        let sources = Sources::new(joint_table(&operands));
        let is_open = |k: &usize| !operands[*k].is_reduced();
        let doubted = (0..operands.len()).filter(is_open).collect();
        let descent = Descent::new(&sources, Rule::Positive, true, operands.len());
        // Usually only one operand overlaps itself, so the first descent ends at the first one found. If
        // later descents ended as early, each of many such operands would cost a descent.
        let descent = descent.with_doubted(doubted, std::mem::take(&mut is_first));
        let roots = operands.iter().map(|s| s.root().clone()).collect();
        let run = |roots| descent.run(expression.clone(), roots);
        let visit = || {
            if operands.iter().any(|s| s.effort() >= POOL_AFTER) {
                handed_over(roots, run).unwrap_or_else(run)
            } else {
                run(roots)
            }
        };
        let cells = |_: &Result<Branch>| descent.counters.cells_visited();
        let root = profile.timed("descent", visit, cells)?;
        overlaps = descent.overlapping();
        if overlaps.is_empty() {
            let table = sources.table().clone();
            let named = operands.iter().map(Solid::used_sources).max().unwrap_or(0);
            let solid = Solid::new(root, pitch, table, false).without_unused_sources(named);
            let solid = solid
                .resulting_from(&operands)
                .with_effort(descent.counters.elements_solved());
            return Ok((solid, descent.counters.with(profile)));
        }
        if !overlaps.iter().any(is_open) {
            return Err(wrongly_reduced(&operands, &overlaps));
        }
    }
}

/// Replaces each operand with an index in `numbers` by its union with itself, unless it is known not to
/// overlap itself.
fn unite_operands(operands: &mut [Solid], numbers: &[usize], profile: &mut Profile) -> Result<()> {
    for k in numbers {
        let operand = &operands[*k];
        if !operand.is_reduced() {
            let unite = || normalize(operand, Rule::Positive);
            let faces = operand.whole_mesh().map_or(0, |s| s.face_count());
            operands[*k] = profile.timed("uniting", unite, |_| faces)?;
        }
    }
    Ok(())
}

/// Evaluates an expression over a few meshes as they were imported, by comparing all their faces at once; the
/// error is the reason why this is not possible.
fn evaluate_imported_meshes(
    expression: &Expression,
    operands: &[Solid],
    pitch: Pitch,
    profile: &mut Profile,
) -> std::result::Result<(Solid, Counters), Declined> {
    let sources = Sources::new(joint_table(operands));
    let faces: usize = operands
        .iter()
        .filter_map(Solid::whole_mesh)
        .map(|s| s.face_count())
        .sum();
    let run = |profile| arranged(expression, operands, &sources, profile);
    let found = if faces >= MIN_FACES_FOR_POOL {
        handed_over(profile, run).unwrap_or_else(run)
    } else {
        run(profile)
    }?;
    let counters = Counters::default();
    counters.count_leaf(found.compared);
    let named = operands.iter().map(Solid::used_sources).max().unwrap_or(0);
    let solid = Solid::new(found.root, pitch, sources.table().clone(), false);
    let unites = |(operand, is_united): (&Solid, bool)| {
        let operand = operand.clone();
        if is_united {
            operand.with_reduced(true)
        } else {
            operand
        }
    };
    let operands: Vec<Solid> = operands.iter().zip(found.resolved).map(unites).collect();
    let solid = solid
        .without_unused_sources(named)
        .resulting_from(&operands)
        .with_effort(counters.elements_solved());
    Ok((solid, counters))
}

/// Returns the solid, or the empty set if it is a mesh whose faces all lie in one plane.
fn bounding(solid: &Solid) -> Solid {
    let is_flat = |s: &Source| s.mesh().is_some_and(|m| m.are_in_one_plane(m.face_ids()));
    if solid.whole_mesh().is_some_and(|mesh| is_flat(mesh)) {
        return Solid::uniform(solid.pitch(), false);
    }
    solid.clone()
}

/// Returns `error`, or `BadSnapshot` if the error is internal and the solid overlaps itself although the
/// stored data it was read from claim the contrary.
pub fn blamed_on_snapshot(solid: &Solid, error: Error) -> Error {
    if error.kind() != ErrorKind::Internal || !solid.is_reduced_by_claim() {
        return error;
    }
    let doubted = solid.clone().with_reduced(false);
    match normalize(&doubted, Rule::Positive) {
        Ok(_) if doubted.is_reduced() => error,
        _ => false_claim(),
    }
}

fn false_claim() -> Error {
    let text =
        "the snapshot is wrong: it states that the faces of its solid do not overlap, but they do";
    Error::new(ErrorKind::BadSnapshot, text)
}

/// Returns the error for operands (`suspects` are their indices) that overlap themselves though they were
/// marked as reduced: a snapshot or the caller's claim about a mesh was wrong, or there is a defect.
fn wrongly_reduced(operands: &[Solid], suspects: &[usize]) -> Error {
    if suspects.iter().any(|k| operands[*k].is_reduced_by_claim()) {
        return false_claim();
    }
    let errors = suspects.iter().map(|k| wrong_source(&operands[*k], *k));
    let found = errors.flatten().next();
    found.unwrap_or_else(|| {
        Error::internal(format!(
            "of the reduced operands {suspects:?} one overlaps itself"
        ))
    })
}

/// Returns `NotReduced` naming the first mesh of an operand that overlaps itself; `None` if no mesh does.
fn wrong_source(operand: &Solid, number: usize) -> Option<Error> {
    for (slot, source) in operand.sources().iter().enumerate() {
        match overlaps_itself(source) {
            Ok(false) => {}
            Ok(true) => {
                let text = format!(
                    "operand {number} overlaps itself: its input mesh {slot} (source {}) was \
                     declared trusted, but has overlapping faces; do not declare this mesh trusted",
                    source.id()
                );
                return Some(Error::new(ErrorKind::NotReduced, text));
            }
            Err(error) => return Some(error),
        }
    }
    None
}

/// Returns true if the faces of a mesh cross or overlap each other, or enclose a region twice.
///
/// # Errors
/// `Internal`.
pub fn overlaps_itself(source: &Arc<Source>) -> Result<bool> {
    Ok(!is_simple(
        &Solid::of_source(Arc::clone(source), false),
        &[],
    )?)
}

/// Returns true if the faces of a solid neither overlap nor lie inside it. The first call computes this, and
/// begins with the points `suspects`, at which the surface seems to cross itself.
///
/// # Errors
/// `Internal`.
pub fn is_simple(solid: &Solid, suspects: &[Lattice]) -> Result<bool> {
    if let Some(known) = solid.known_simple() {
        return Ok(known);
    }
    if overlaps_itself_at(solid, suspects) {
        return Ok(*solid.simple().get_or_make(|| false));
    }
    if let Some(known) = simple_by_meshes(solid)? {
        return Ok(known);
    }
    if let Some(found) = is_simple_mesh(solid) {
        return Ok(*solid.simple().get_or_make(|| found));
    }
    normalize(solid, Rule::Positive)?;
    Ok(solid.is_reduced())
}

/// Returns the solid whose surface is exactly the boundary of the points that `rule` calls inside: each wall
/// once, without inner walls.
///
/// # Errors
/// `Internal`.
pub fn normalize(solid: &Solid, rule: Rule) -> Result<Solid> {
    if solid.is_reduced() {
        return Ok(solid.clone());
    }
    if rule != Rule::Positive {
        return unite(solid, rule);
    }
    if let Some(known) = union_with_itself(solid)? {
        return Ok(known);
    }
    let united = unite(solid, rule)?;
    Ok(solid.united().get_or_make(|| united).clone())
}

/// Returns the solid's union with itself if it is cached, or if a check of the meshes it was made of proves
/// that the solid does not overlap itself; otherwise `None`.
///
/// # Errors
/// `Internal`.
pub fn union_with_itself(solid: &Solid) -> Result<Option<Solid>> {
    if let Some(known) = solid.united().get() {
        return Ok(Some(known.clone()));
    }
    Ok((simple_by_meshes(solid)? == Some(true)).then(|| solid.clone()))
}

/// Returns whether the solid does not overlap itself, if this is known or follows from checking the meshes it
/// was made of; otherwise `None`.
fn simple_by_meshes(solid: &Solid) -> Result<Option<bool>> {
    if let Some(known) = solid.known_simple() {
        return Ok(Some(known));
    }
    let Some(meshes) = solid.unchecked_meshes() else {
        return Ok(None);
    };
    for mesh in meshes {
        if !is_simple(mesh, &[])? {
            return Ok(None);
        }
    }
    Ok(Some(*solid.simple().get_or_make(|| true)))
}

/// Computes the solid's union with itself, and caches whether the solid already was this union.
fn unite(solid: &Solid, rule: Rule) -> Result<Solid> {
    let root = match united(solid, rule) {
        Some(United::Same) => None,
        Some(United::Other(root)) => Some(root),
        Some(United::Shells(shells)) => Some(union(solid, shells)?),
        None => by_descent(solid, rule)?,
    };
    let is_simple = *solid.simple().get_or_make(|| root.is_none());
    match root.filter(|_| !is_simple) {
        Some(root) => {
            let table = solid.sources().clone();
            Ok(Solid::new(root, solid.pitch(), table, true))
        }
        None => Ok(solid.clone().with_reduced(true)),
    }
}

/// Returns the root of the union of closed shells, none of which overlaps itself.
fn union(solid: &Solid, shells: Vec<Branch>) -> Result<Branch> {
    let count = as_number(shells.len());
    let mut terms: Vec<Term> = (0..count).map(Term::Operand).collect();
    terms.push(Term::Or((0..count).collect()));
    let sources = Sources::new(solid.sources().clone());
    let descent = Descent::new(&sources, Rule::Positive, true, shells.len());
    descent.run(Expression::new(terms)?, shells)
}

/// Unites a solid with itself by a descent through cells and returns the root of the result; `None` if the
/// solid does not overlap itself.
fn by_descent(solid: &Solid, rule: Rule) -> Result<Option<Branch>> {
    let sources = Sources::new(solid.sources().clone());
    let descent = Descent::new(&sources, rule, false, 1);
    let expression = Expression::new(vec![Term::Operand(0)])?;
    let root = descent.run(expression, vec![solid.root().clone()])?;
    Ok((!descent.overlapping().is_empty()).then_some(root))
}

fn common_pitch(expression: &Expression, solids: &[Solid]) -> Result<Pitch> {
    let count = solids.len();
    if let Some(k) = expression
        .operands()
        .into_iter()
        .find(|k| *k as usize >= count)
    {
        let text =
            format!("the expression refers to operand {k}, but there are only {count} operands");
        return Err(Error::at(ErrorKind::Shape, vec![u64::from(k)], text));
    }
    let pitch = solids.first().map_or(Pitch::DEFAULT, Solid::pitch);
    if let Some(at) = solids.iter().position(|s| s.pitch() != pitch) {
        let text = format!(
            "operand {at} has the lattice step 10^{}, operand 0 has 10^{}; refine the coarser one",
            solids[at].pitch().exponent(),
            pitch.exponent()
        );
        return Err(Error::at(ErrorKind::PitchMismatch, vec![at as u64], text));
    }
    Ok(pitch)
}

/// Returns all sources of the operands, in the order in which operands first name them.
fn joint_table(solids: &[Solid]) -> SourceTable {
    let tables = solids.iter().map(Solid::sources);
    tables.fold(SourceTable::default(), |all, one| {
        if all.is_empty() {
            one.clone()
        } else {
            all.joined(one)
        }
    })
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::interrupt::{Call, CallerHooks};
    use crate::merge::scenes::{both, cuboid, made_of};

    static SHARES: AtomicUsize = AtomicUsize::new(0);

    const HOOKS: CallerHooks = CallerHooks {
        wants_to_stop: || false,
        hand_over: |task, share| {
            SHARES.fetch_add(1, Ordering::Relaxed);
            task.run(share);
        },
    };

    #[test]
    fn the_step_after_a_long_one_is_handed_over() {
        let shared = |solids: &[Solid; 2]| {
            let before = SHARES.load(Ordering::Relaxed);
            let work = || evaluate(&both(Term::Or), solids);
            let (_, counters) = Call::new().run_here(HOOKS, work).expect("not stopped");
            (counters.named(), SHARES.load(Ordering::Relaxed) - before)
        };
        let step = made_of(&[cuboid([1; 3], [9; 3]), cuboid([2; 3], [12; 3])], Term::Or);
        let [first, second] = [step.with_effort(0), cuboid([5; 3], [13; 3])];
        let (short, none) = shared(&[first.clone(), second.clone()]);
        let (long, one) = shared(&[first.with_effort(POOL_AFTER), second]);
        assert_eq!((none, one), (0, 1));
        assert_eq!(short, long);
    }

    #[test]
    fn a_result_knows_what_kernels_took() {
        let solids = [cuboid([1; 3], [9; 3]), cuboid([5; 3], [13; 3])];
        let (union, counters) = evaluate(&both(Term::Or), &solids).expect("not stopped");
        assert_eq!(solids[0].effort(), 0);
        assert_eq!(union.effort(), counters.elements_solved());
        assert_eq!(union.effort(), 12);
    }
}
