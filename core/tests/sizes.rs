//! Large and tiny operands give the same bytes outside of a pool and in pools of any size.
//!
//! Above certain lengths lists are shared among threads, counted, or sorted differently. The lengths here
//! lie on both sides of these limits.

use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::mesh::handle::VertexId;
use bspcsg::store::snapshot::Snapshot;
use bspcsg::tree::solid::Solid;
use rayon::ThreadPoolBuilder;

use super::support::{applied, manifold_mesh, normalized, volume, Numbers, Ratio, Shape};

/// The radius of balls, and the distance between parts, in lattice steps.
const RADIUS: i64 = 1 << 20;

/// The radius of balls as a double.
const BALL: f64 = (1u32 << 20) as f64;

/// The bytes that must not depend on threads: the tree, and the doubles and triangles of the mesh.
type Bytes = (Vec<u8>, Vec<[u64; 3]>, Vec<[VertexId; 3]>);

fn bytes(solid: &Solid, context: &str) -> Bytes {
    let mesh = manifold_mesh(solid, context);
    let tree = Snapshot::of(solid).to_bytes().expect("bytes");
    let vertices = mesh.vertices.iter().map(|p| p.map(f64::to_bits)).collect();
    (tree, vertices, mesh.triangles)
}

/// The bytes and the volumes of the reduced operand and of all four operations with a tool.
fn results(large: &Shape, tool: &Shape, context: &str) -> Vec<(Bytes, Ratio)> {
    let large = normalized(&large.unchecked(), Rule::Positive);
    let tool = tool.solid();
    let values = SetOp::ALL.map(|op| applied(op, &large, &tool));
    let all = [large].into_iter().chain(values);
    all.map(|solid| (bytes(&solid, context), volume(&solid)))
        .collect()
}

fn assert_same_in_pools(large: &Shape, tool: &Shape, context: &str) {
    let outside = results(large, tool, context);
    let volumes: Vec<&Ratio> = outside.iter().map(|(_, volume)| volume).collect();
    let [whole, joint, common, rest, either] = volumes[..] else {
        panic!("five results");
    };
    assert_eq!(rest.plus(common), *whole, "{context}");
    assert_eq!(joint.minus(common), *either, "{context}");
    for threads in [1, 4] {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let inside = pool
            .expect("a pool")
            .install(|| results(large, tool, context));
        assert!(inside == outside, "{context} in a pool of {threads}");
    }
}

/// A grid of boxes that do not touch.
fn boxes(count: i64) -> Shape {
    let side = (1..=count).find(|s| s * s >= count).expect("a square");
    let place = |k: i64| [k / side * 2 * RADIUS, k % side * 2 * RADIUS, 0];
    let part = |k| Shape::cuboid(place(k), place(k).map(|c| c + RADIUS));
    (0..count).map(part).fold(Shape::default(), Shape::with)
}

/// A box around a vertex of a surface, with edges between one step and the size of the surface.
fn tool(numbers: &mut Numbers, large: &Shape) -> Shape {
    let corner = large.vertices[numbers.index(large.vertices.len())];
    let size = 1i64 << numbers.below(20);
    let low = corner.map(|c| c - numbers.below(2) * size);
    Shape::cuboid(low, low.map(|c| c + size + numbers.below(2)))
}

#[test]
fn tiny_tools_on_balls() {
    let mut numbers = Numbers::new(21);
    for levels in [2, 3, 5] {
        let ball = Shape::sphere([0; 3], BALL, levels);
        for round in 0..if levels == 5 { 1 } else { 3 } {
            let tool = tool(&mut numbers, &ball);
            assert_same_in_pools(&ball, &tool, &format!("ball {levels}, round {round}"));
        }
    }
}

#[test]
fn few_of_many_parts() {
    let mut numbers = Numbers::new(22);
    // Parts of 12 faces: just below and above 64, 512, 2000 and 2^14 faces.
    for count in [5, 6, 42, 43, 166, 167, 1366] {
        let parts = boxes(count);
        let tool = tool(&mut numbers, &parts);
        assert_same_in_pools(&parts, &tool, &format!("{count} boxes"));
    }
}

#[test]
fn plates_through_many_parts() {
    // 16, 64 and 256 boxes, and one more each time, are cut in one plane.
    for count in [16, 17, 64, 65, 256, 257] {
        let parts = boxes(count);
        let far = 64 * RADIUS;
        let plate = Shape::cuboid([-far, -far, RADIUS / 2], [far, far, RADIUS / 2 + 1]);
        assert_same_in_pools(&parts, &plate, &format!("plate through {count} boxes"));
    }
}
