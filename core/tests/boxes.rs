//! Chains and expressions of boxes on a coarse lattice, against sets of unit cubes.
//!
//! Faces lie in common planes, edges in faces, and remains of earlier steps partly meet new boxes.

use bspcsg::geometry::plane::{normal, Lattice};
use bspcsg::merge::expression::Term;
use bspcsg::merge::SetOp;
use bspcsg::tree::solid::Solid;

use super::support::{applied, combined, inside, manifold_mesh, volume, Numbers, Ratio, Shape};

/// The number of cubes along an edge of the region.
const SIDE: i64 = 11;

/// A set of cubes of side 2, the first at the origin.
#[derive(Clone)]
struct Cubes(Vec<bool>);

fn places() -> impl Iterator<Item = Lattice> {
    (0..SIDE.pow(3)).map(|i| [i / (SIDE * SIDE), i / SIDE % SIDE, i % SIDE])
}

impl Cubes {
    fn of(low: Lattice, high: Lattice) -> Self {
        let within = |p: Lattice| (0..3).all(|i| (low[i]..high[i]).contains(&p[i]));
        Self(places().map(within).collect())
    }

    fn combined(&self, op: SetOp, other: &Self) -> Self {
        let value = |(a, b): (&bool, &bool)| match op {
            SetOp::Union => a | b,
            SetOp::Intersection => a & b,
            SetOp::Difference => *a && !b,
            SetOp::SymmetricDifference => a ^ b,
        };
        Self(self.0.iter().zip(&other.0).map(value).collect())
    }

    fn check(&self, solid: &Solid, context: &str) {
        let centers: Vec<Lattice> = places().map(|p| p.map(|c| 2 * c + 1)).collect();
        assert_eq!(inside(solid, &centers), self.0, "{context}");
        let count = self.0.iter().filter(|c| **c).count();
        let count = i64::try_from(count).expect("few cubes");
        assert_eq!(volume(solid), Ratio::whole(8 * count), "{context}");
        manifold_mesh(solid, context);
    }
}

/// A box of at least `least` cubes along each edge; some boxes have vertices inside their sides.
fn any_box(numbers: &mut Numbers, least: i64) -> (Solid, Cubes) {
    let low = [0; 3].map(|_| numbers.below(SIDE - least + 1));
    let high = low.map(|c| c + least + numbers.below(SIDE - least - c + 1));
    let shape = Shape::cuboid(low.map(|c| 2 * c), high.map(|c| 2 * c));
    let shape = match numbers.below(2) {
        0 => shape,
        _ => divided(&shape),
    };
    (shape.solid(), Cubes::of(low, high))
}

/// The same solid with each triangle divided at a lattice point strictly inside it, if one is near its
/// centre: no other face's plane contains that point.
fn divided(shape: &Shape) -> Shape {
    let mut vertices = shape.vertices.clone();
    let mut faces = Vec::new();
    for face in &shape.faces {
        let corners = face.map(|v| shape.vertices[usize::try_from(v).expect("a vertex")]);
        let [a, b, c] = &corners;
        let centre = [0, 1, 2].map(|i| (a[i] + b[i] + c[i]) / 3);
        let whole = normal(a, b, c);
        let around = [
            normal(a, b, &centre),
            normal(b, c, &centre),
            normal(c, a, &centre),
        ];
        let inside = |n: &[i128; 3]| (0..3).any(|i| n[i] * whole[i] > 0);
        if around.iter().all(inside) {
            let middle = i64::try_from(vertices.len()).expect("few vertices");
            vertices.push(centre);
            let [a, b, c] = *face;
            faces.extend([[a, b, middle], [b, c, middle], [c, a, middle]]);
        } else {
            faces.push(*face);
        }
    }
    Shape { vertices, faces }
}

#[test]
fn chains_of_boxes_are_sets_of_cubes() {
    let mut numbers = Numbers::new(11);
    for round in 0..24 {
        let (mut solid, mut cubes) = any_box(&mut numbers, 5);
        for step in 0..24 {
            let (tool, tool_cubes) = any_box(&mut numbers, 1);
            let op = match numbers.below(5) {
                0 => SetOp::SymmetricDifference,
                1 | 2 => SetOp::Difference,
                _ => SetOp::Union,
            };
            solid = applied(op, &solid, &tool);
            cubes = cubes.combined(op, &tool_cubes);
            cubes.check(&solid, &format!("round {round}, step {step}, {op:?}"));
        }
    }
}

// Found: the kernel of axis-parallel faces declined boxes of more than 64 intervals.
#[test]
fn expressions_of_many_boxes_are_sets_of_cubes() {
    let mut numbers = Numbers::new(12);
    for round in 0..24 {
        let count = 12 + 4 * (round % 8);
        let boxes: Vec<_> = (0..count).map(|_| any_box(&mut numbers, 1)).collect();
        let solids: Vec<Solid> = boxes.iter().map(|b| b.0.clone()).collect();
        let mut lines = Vec::new();
        let mut cubes = boxes[0].1.clone();
        let mut last = 0;
        for i in 1..count {
            let line = count + u32::try_from(lines.len()).expect("few lines");
            let of_box = &boxes[i as usize].1;
            if i % 3 == 0 {
                lines.extend([Term::Not(i), Term::And(vec![last, line])]);
                cubes = cubes.combined(SetOp::Difference, of_box);
                last = line + 1;
            } else {
                lines.push(Term::Or(vec![last, i]));
                cubes = cubes.combined(SetOp::Union, of_box);
                last = line;
            }
        }
        cubes.check(&combined(&solids, lines), &format!("round {round}"));
    }
}
