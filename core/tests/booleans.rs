//! Set operations on small solids end to end, with exact volumes.

use std::sync::Arc;

use bspcsg::extract::boundary::collect::has_no_boundary;
use bspcsg::extract::joining::patches::Patches;
use bspcsg::extract::rounding::round;
use bspcsg::merge::evaluate::evaluate;
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::mesh::handle::Slot;
use bspcsg::mesh::import::import;
use bspcsg::query::measure::volume;
use bspcsg::tree::solid::Solid;

fn cuboid(low: [f64; 3], high: [f64; 3]) -> Solid {
    let corner = |i: usize| [0, 1, 2].map(|k| if i >> k & 1 == 1 { high[k] } else { low[k] });
    let vertices: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let faces = [
        [0, 2, 3],
        [0, 3, 1],
        [4, 5, 7],
        [4, 7, 6],
        [0, 1, 5],
        [0, 5, 4],
        [2, 6, 7],
        [2, 7, 3],
        [0, 4, 6],
        [0, 6, 2],
        [1, 3, 7],
        [1, 7, 5],
    ];
    let source = import(&vertices, &faces, None).expect("a cuboid is closed");
    Solid::of_source(Arc::new(source), true)
}

fn combine(terms: Vec<Term>, solids: &[Solid]) -> Solid {
    let expression = Expression::new(terms).expect("well formed");
    evaluate(&expression, solids).expect("evaluates").0
}

fn union(a: &Solid, b: &Solid) -> Solid {
    let terms = vec![Term::Operand(0), Term::Operand(1), Term::Or(vec![0, 1])];
    combine(terms, &[a.clone(), b.clone()])
}

fn intersection(a: &Solid, b: &Solid) -> Solid {
    let terms = vec![Term::Operand(0), Term::Operand(1), Term::And(vec![0, 1])];
    combine(terms, &[a.clone(), b.clone()])
}

fn difference(a: &Solid, b: &Solid) -> Solid {
    let terms = vec![
        Term::Operand(0),
        Term::Operand(1),
        Term::Not(1),
        Term::And(vec![0, 2]),
    ];
    combine(terms, &[a.clone(), b.clone()])
}

fn volume_of(solid: &Solid) -> String {
    let v = volume(solid).expect("bounded");
    format!("{}/{}", v.numerator, v.denominator)
}

#[test]
fn overlapping_cubes() {
    let a = cuboid([0.0; 3], [1.0; 3]);
    let b = cuboid([0.5; 3], [1.5; 3]);
    assert_eq!(volume_of(&a), "1/1");
    assert_eq!(volume_of(&intersection(&a, &b)), "1/8");
    assert_eq!(volume_of(&union(&a, &b)), "15/8");
    assert_eq!(volume_of(&difference(&a, &b)), "7/8");
    assert_eq!(
        round::mesh(&union(&a, &b)).expect("mesh").triangles.len(),
        36
    );
}

#[test]
fn face_contact_makes_one_box() {
    let a = cuboid([0.0; 3], [1.0; 3]);
    let b = cuboid([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]);
    let mesh = round::mesh(&union(&a, &b)).expect("mesh");
    assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (8, 12));
}

#[test]
fn faces_of_different_patches_are_not_joined() {
    let a = cuboid([0.0; 3], [1.0; 3]);
    let b = cuboid([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]);
    let both = union(&a, &b);
    let patches = |of_b: u32| Patches::new(vec![Some(vec![7; 12]), Some(vec![of_b; 12])]);
    let mesh = |of_b| round::mesh_of_patches(&both, &patches(of_b)).expect("mesh");
    assert_eq!((mesh(7).vertices.len(), mesh(7).triangles.len()), (8, 12));
    assert_eq!((mesh(8).vertices.len(), mesh(8).triangles.len()), (12, 20));
    let one_each = Patches::new(vec![Some((0..12).collect()), None]);
    let cut = difference(&a, &cuboid([-1.0, 0.25, 0.25], [2.0, 0.75, 0.75]));
    let mesh = round::mesh_of_patches(&cut, &one_each).expect("mesh");
    for (triangle, [slot, face]) in mesh.triangles.iter().zip(&mesh.origins) {
        let source = cut.sources().get(Slot(*slot)).mesh().expect("a mesh");
        let corners = source.faces[*face as usize].map(|v| source.doubles[v.index()]);
        for v in triangle {
            let p = mesh.vertices[v.index()];
            let inside = |i: usize| {
                let bounds = corners.map(|c| c[i]);
                let low = bounds.iter().copied().fold(f64::INFINITY, f64::min);
                let high = bounds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                (low..=high).contains(&p[i])
            };
            assert!((0..3).all(inside));
        }
    }
}

#[test]
fn identical_cubes_cancel() {
    let a = cuboid([0.0; 3], [1.0; 3]);
    assert!(has_no_boundary(&difference(&a, &a.clone())));
    let b = cuboid([0.0; 3], [1.0; 3]);
    assert!(has_no_boundary(&difference(&a, &b)));
    assert_eq!(volume_of(&union(&a, &b)), "1/1");
}

#[test]
fn cut_and_put_back() {
    let a = cuboid([0.0; 3], [3.0; 3]);
    let r = cuboid([-1.0, 0.3, 0.7], [1.5, 1.9, 2.2]);
    let back = union(&difference(&a, &r), &intersection(&a, &r));
    let mesh = round::mesh(&back).expect("mesh");
    assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (8, 12));
    assert_eq!(volume_of(&back), "27/1");
}
