//! Scenes of small solids that coincide often, made from a fuzzer's bytes.

use std::sync::Arc;

use arbitrary::{Arbitrary, Result, Unstructured};
use bspcsg::arith::Int;
use bspcsg::geometry::plane::Lattice;
use bspcsg::merge::expression::Term;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::half_space::half_space;
use bspcsg::query::classify::Location;
use bspcsg::tree::solid::Solid;

use super::support::{combined, Shape, LIMIT};
use super::winding::{location, Known};

/// Coordinates lie in `0..reach`: in small reaches everything meets everything.
const REACHES: [i64; 6] = [3, 5, 9, 40, 4000, 1 << 30];

/// Half-spaces have small normals; their offsets go through lattice points in small reaches.
const STEEPEST: i64 = 3;

/// The most that a scene may hold, so that an execution takes milliseconds.
const OPERANDS: usize = 4;
const PARTS: usize = 3;
const LINES: usize = 6;
const POINTS: usize = 24;

/// One operand: as the core takes it, and as it is known to be.
#[derive(Clone, Debug)]
pub struct Operand {
    /// The set.
    pub known: Known,
    shape: Option<Shape>,
    single: bool,
}

/// Operands, an expression over them, and points to ask about.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The operands.
    pub operands: Vec<Operand>,
    /// Lines after one for each operand; they name operands and earlier lines.
    pub lines: Vec<Term>,
    /// Corners of operands and points beside them.
    pub points: Vec<Lattice>,
}

impl Operand {
    /// The solid; one plain part is declared reduced, all else is not.
    #[must_use]
    pub fn solid(&self) -> Solid {
        match (&self.known, &self.shape) {
            (Known::Mesh(_), Some(shape)) if self.single => shape.solid(),
            (Known::Mesh(_), Some(shape)) => shape.unchecked(),
            (Known::Mesh(_), None) => Solid::uniform(whole_units(), false),
            (Known::HalfSpace(normal, offset), _) => {
                let (normal, offset) = plane_numbers(*normal, *offset);
                let source = half_space(normal, &offset, whole_units(), None);
                Solid::of_source(Arc::new(source.expect("a small normal")), true)
            }
        }
    }

    fn of_shape(shape: Shape, single: bool) -> Self {
        let corners = (0..shape.faces.len()).map(|f| shape.corners(f));
        Self {
            known: Known::Mesh(corners.collect()),
            shape: Some(shape),
            single,
        }
    }
}

impl Scene {
    /// The solids of all operands.
    #[must_use]
    pub fn solids(&self) -> Vec<Solid> {
        self.operands.iter().map(Operand::solid).collect()
    }

    /// Return what the expression makes of the solids.
    #[must_use]
    pub fn result(&self) -> Solid {
        combined(&self.solids(), self.lines.clone())
    }

    /// The value of the expression.
    #[must_use]
    pub fn value(&self, inside: &[bool]) -> bool {
        let mut values = inside.to_vec();
        for line in &self.lines {
            let at = |k: &u32| values[*k as usize];
            let value = match line {
                Term::Operand(k) => inside[*k as usize],
                Term::Not(a) => !at(a),
                Term::And(list) => list.iter().all(at),
                Term::Or(list) => list.iter().any(at),
                Term::Xor(list) => list.iter().filter(|k| at(k)).count() % 2 == 1,
            };
            values.push(value);
        }
        *values.last().expect("there are operands")
    }

    /// Locate a point relative to the result, if it can be told.
    #[must_use]
    pub fn location(&self, point: &Lattice) -> Option<Location> {
        let sets: Vec<Known> = self.operands.iter().map(|o| o.known.clone()).collect();
        location(&sets, |inside| self.value(inside), point)
    }
}

/// The numbers of a plane as the core takes them.
#[must_use]
pub fn plane_numbers(normal: [i64; 3], offset: i64) -> ([i128; 3], Int<3>) {
    (normal.map(i128::from), Int::from_i128(offset.into()))
}

/// The lattice of whole units.
#[must_use]
pub fn whole_units() -> Pitch {
    Pitch::new(0).expect("a pitch")
}

impl<'a> Arbitrary<'a> for Scene {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        let reach = *u.choose(&REACHES)?;
        let shift = if u.ratio(1, 16)? { LIMIT - reach } else { 0 };
        let count = u.int_in_range(1..=OPERANDS)?;
        let operands: Vec<Operand> = (0..count)
            .map(|_| operand(u, reach, shift))
            .collect::<Result<_>>()?;
        let lines = lines(u, count)?;
        let points = points(u, &operands, reach, shift)?;
        // Last, so that inputs which end before stay what they were.
        let operands = operands.into_iter().map(|o| untidy(u, o));
        Ok(Self {
            operands: operands.collect::<Result<_>>()?,
            lines,
            points,
        })
    }
}

/// The same set by a mesh that may be less tidy.
fn untidy(u: &mut Unstructured<'_>, operand: Operand) -> Result<Operand> {
    if operand.shape.is_none() || u.ratio(3, 4)? {
        return Ok(operand);
    }
    let shape = operand.shape.map(|shape| divided(u, shape)).transpose()?;
    Ok(Operand { shape, ..operand })
}

/// A shape with faces divided in an edge, but not those beyond it, or by a face without area.
fn divided(u: &mut Unstructured<'_>, mut shape: Shape) -> Result<Shape> {
    for _ in 0..u.int_in_range(1..=3)? {
        let face = u.choose_index(shape.faces.len())?;
        shape.faces[face].rotate_left(u.int_in_range(0..=2)?);
        let ([a, b, c], [p, q, _]) = (shape.faces[face], shape.corners(face));
        let sums = [0, 1, 2].map(|i| p[i] + q[i]);
        if sums.iter().any(|sum| sum % 2 != 0) {
            continue;
        }
        let middle = i64::try_from(shape.vertices.len()).expect("few");
        shape.vertices.push(sums.map(|sum| sum / 2));
        shape.faces[face] = [a, middle, c];
        shape.faces.push([middle, b, c]);
        if u.arbitrary()? {
            shape.faces.push([a, b, middle]);
        }
    }
    Ok(shape)
}

fn operand(u: &mut Unstructured<'_>, reach: i64, shift: i64) -> Result<Operand> {
    if shift == 0 && u.ratio(1, 8)? {
        let normal = [0; 3].map(|_| u.int_in_range(-STEEPEST..=STEEPEST));
        let [x, y, z] = normal;
        let normal = [x?, y?, z?];
        let through = point(u, reach)?;
        let offset = (0..3).map(|i| normal[i] * through[i]).sum();
        if normal != [0; 3] {
            return Ok(Operand {
                known: Known::HalfSpace(normal, offset),
                shape: None,
                single: true,
            });
        }
    }
    let mut parts: Vec<Shape> = Vec::new();
    let mut plain = true;
    for _ in 0..u.int_in_range(1..=PARTS)? {
        let mut part = part(u, reach, &parts)?;
        if u.ratio(1, 8)? {
            part = part.inverted();
            plain = false;
        }
        parts.push(part);
    }
    let single = plain && parts.len() == 1;
    let whole = parts.into_iter().fold(Shape::default(), Shape::with);
    let shifted = whole.mapped(|p| p.map(|c| c + shift));
    Ok(Operand::of_shape(shifted, single))
}

/// A tetrahedron, a box, a pyramid, or a copy of an earlier part, moved by a step or not.
fn part(u: &mut Unstructured<'_>, reach: i64, earlier: &[Shape]) -> Result<Shape> {
    let kind = u.int_in_range(0..=3)?;
    if kind == 3 && !earlier.is_empty() {
        let axis = u.int_in_range(0..=2)?;
        let step = u.int_in_range(0..=1)?;
        let moved = move |mut p: Lattice| {
            p[axis] = (p[axis] + step).min(reach);
            p
        };
        let copy = u.choose(earlier)?.clone();
        let inside = copy.vertices.iter().all(|p| p[axis] + step <= reach);
        return Ok(if inside { copy.mapped(moved) } else { copy });
    }
    if kind == 0 {
        let corners = [point(u, reach)?, point(u, reach)?, point(u, reach)?];
        if let Some(shape) =
            Shape::tetrahedron([corners[0], corners[1], corners[2], point(u, reach)?])
        {
            return Ok(shape);
        }
    }
    let [p, q] = [point(u, reach - 1)?, point(u, reach - 1)?];
    let low = [0, 1, 2].map(|i| p[i].min(q[i]));
    let high = [0, 1, 2].map(|i| p[i].max(q[i]) + 1);
    if kind == 2 {
        let [[a, b, _], [d, e, h]] = [low, high];
        let shape = Shape::tetrahedron([low, [d, b, low[2]], [a, e, low[2]], [a, b, h]]);
        return Ok(shape.unwrap_or_else(|| Shape::cuboid(low, high)));
    }
    Ok(Shape::cuboid(low, high))
}

fn point(u: &mut Unstructured<'_>, reach: i64) -> Result<Lattice> {
    Ok([
        u.int_in_range(0..=reach - 1)?,
        u.int_in_range(0..=reach - 1)?,
        u.int_in_range(0..=reach - 1)?,
    ])
}

fn lines(u: &mut Unstructured<'_>, operands: usize) -> Result<Vec<Term>> {
    let mut lines = Vec::new();
    for k in 0..u.int_in_range(1..=LINES)? {
        let last = u32::try_from(operands + k - 1).expect("few");
        let mut pick = || u.int_in_range(0..=last);
        let pair = vec![pick()?, pick()?];
        lines.push(match u.int_in_range(0..=6)? {
            0 => Term::Not(pair[0]),
            1 | 2 => Term::And(pair),
            3 | 4 => Term::Or(pair),
            5 => Term::Xor(pair),
            _ => Term::Or((0..=last).collect()),
        });
    }
    Ok(lines)
}

/// Corners, middles of edges and centres of faces where they are on the lattice, and any points.
fn points(
    u: &mut Unstructured<'_>,
    operands: &[Operand],
    reach: i64,
    shift: i64,
) -> Result<Vec<Lattice>> {
    let shapes: Vec<&Shape> = operands.iter().filter_map(|o| o.shape.as_ref()).collect();
    let mut points = Vec::new();
    for _ in 0..u.int_in_range(2..=POINTS)? {
        let kind = u.int_in_range(0..=3)?;
        if kind == 3 || shapes.is_empty() {
            points.push(point(u, reach)?.map(|c| c + shift));
            continue;
        }
        let shape = u.choose(&shapes)?;
        let face = u.choose_index(shape.faces.len())?;
        let [a, b, c] = shape.corners(face);
        points.push(match kind {
            0 => a,
            1 => [0, 1, 2].map(|i| (a[i] + b[i]).div_euclid(2)),
            _ => [0, 1, 2].map(|i| (a[i] + b[i] + c[i]).div_euclid(3)),
        });
    }
    Ok(points)
}
