//! Scenes, taken out of the tree, stored and moved.

use arbitrary::{Arbitrary, Unstructured};
use bspcsg::geometry::plane::Lattice;
use bspcsg::geometry::spaces::motion::Motion;
use bspcsg::merge::rule::Rule;
use bspcsg::store::snapshot::Snapshot;

use super::super::scene::whole_units;
use super::super::scene::Scene;
use super::super::support::{assert_same_triangles, located, manifold_mesh, normalized, volume};
use super::checks::{assert_same, kept, manifold_or_unbounded};

/// A scene's result: stored, moved and mirrored it stays the same, and its mesh makes it again.
pub fn extract(data: &[u8]) {
    let mut u = Unstructured::new(data);
    let Ok(scene) = Scene::arbitrary(&mut u) else {
        return;
    };
    let context = format!("{scene:?}");
    let result = normalized(&scene.result(), Rule::Positive);
    let again = kept(&result, &context);
    assert_same(&again, &result, &context);
    if !manifold_or_unbounded(&result, &context) {
        return;
    }
    assert_same_triangles(&again, &result, &context);
    assert_eq!(volume(&again), volume(&result), "{context}");
    let (Ok(turn), Ok(sign)) = (u.int_in_range(0..=2usize), u.int_in_range(0..=7usize)) else {
        return;
    };
    let axes = [0, 1, 2].map(|i| ((i + turn) % 3, if sign >> i & 1 == 1 { -1 } else { 1 }));
    let motion = Motion {
        axes,
        shift: [1, -2, 3],
        scale: 1,
    };
    let moved = Snapshot::of(&result).moved(&motion, whole_units());
    let Ok(image) = moved.and_then(|s| s.solid()) else {
        return;
    };
    manifold_mesh(&image, &context);
    assert_eq!(volume(&image), volume(&result), "{motion:?} of {context}");
    let points: Vec<Lattice> = scene.points.iter().map(|p| image_of(&motion, p)).collect();
    assert_eq!(
        located(&image, &points),
        located(&result, &scene.points),
        "{motion:?} of {context}"
    );
}

fn image_of(motion: &Motion, p: &Lattice) -> Lattice {
    [0, 1, 2].map(|i| p[motion.axes[i].0] * motion.axes[i].1 + motion.shift[i])
}
