//! Operations that must not change a solid: snapshots, motions of the lattice, other numbers of threads; and
//! approximate volumes.

use std::sync::Arc;

use bspcsg::arith::Int;
use bspcsg::error::panics::caught;
use bspcsg::error::{ErrorKind, Result};
use bspcsg::extract::mesh::Mesh;
use bspcsg::extract::rounding::round;
use bspcsg::geometry::plane::Lattice;
use bspcsg::geometry::spaces::motion::Motion;
use bspcsg::merge::evaluate::{blamed_on_snapshot, evaluate, normalize};
use bspcsg::merge::expression::{Expression, Term};
use bspcsg::merge::rule::Rule;
use bspcsg::merge::SetOp;
use bspcsg::mesh::grid::Pitch;
use bspcsg::mesh::half_space::half_space;
use bspcsg::mesh::handle::VertexId;
use bspcsg::query::classify::classify;
use bspcsg::query::measure;
use bspcsg::store::snapshot::Snapshot;
use bspcsg::tree::solid::Solid;
use rayon::ThreadPoolBuilder;

use super::support::{
    applied, assert_same_set, assert_same_triangles, combined, located, manifold_mesh, volume,
    Numbers, Ratio, Shape, LIMIT,
};

/// Returns what must not depend on the number of threads: the bytes of the boundary and of the mesh.
fn fingerprint() -> (Vec<u8>, Vec<[u64; 3]>, Vec<[VertexId; 3]>) {
    let ball = |x: i64| Shape::sphere([x, 900, 900], 800.0, 3).solid();
    let tool = Shape::any_cuboid(&mut Numbers::new(8), 1500).solid();
    let operands = [ball(900), ball(1300), tool];
    let lines = vec![Term::Or(vec![0, 1]), Term::Not(2), Term::And(vec![3, 4])];
    let solid = combined(&operands, lines);
    let mesh = manifold_mesh(&solid, "threads");
    let bytes = Snapshot::of(&solid).to_bytes().expect("bytes");
    let vertices = mesh.vertices.iter().map(|p| p.map(f64::to_bits)).collect();
    (bytes, vertices, mesh.triangles)
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let with = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool").install(fingerprint)
    };
    let one = with(1);
    assert!(one == with(2), "two threads");
    assert!(one == with(8), "eight threads");
    assert!(one == with(1), "once more");
}

/// A solid with lattice vertices and constructed vertices, cut and whole faces, and a hole.
fn mixture(numbers: &mut Numbers) -> Solid {
    let a = Shape::any_cuboid(numbers, 40).solid();
    let b = Shape::any_tetrahedron(numbers, 40).solid();
    let c = Shape::any_tetrahedron(numbers, 40).solid();
    let lines = vec![Term::Or(vec![0, 1]), Term::Not(2), Term::And(vec![3, 4])];
    combined(&[a, b, c], lines)
}

#[test]
fn snapshots_keep_everything() {
    let mut numbers = Numbers::new(9);
    for round in 0..20 {
        let solid = mixture(&mut numbers);
        let bytes = Snapshot::of(&solid).to_bytes().expect("bytes");
        let again = Snapshot::solid_from_bytes(&bytes).expect("a solid");
        assert_same_triangles(&again, &solid, &format!("round {round}"));
        let tool = Shape::any_tetrahedron(&mut numbers, 40).solid();
        let [first, second] = [&solid, &again].map(|s| applied(SetOp::Difference, s, &tool));
        assert_eq!(volume(&first), volume(&second), "round {round}");
        assert_same_triangles(&first, &second, &format!("operated, round {round}"));
        let copy = Snapshot::of(&again).to_bytes().expect("bytes");
        assert_eq!(copy, bytes, "stored twice, round {round}");
    }
}

/// Damaged bytes are refused, or stand for some solid; decoding never panics.
#[test]
fn damaged_snapshots_do_no_harm() {
    let mut numbers = Numbers::new(15);
    let tool = Shape::any_tetrahedron(&mut numbers, 40).solid();
    let mut refused = 0;
    for _ in 0..400 {
        let mut bytes = Snapshot::of(&mixture(&mut numbers))
            .to_bytes()
            .expect("bytes");
        for _ in 0..=numbers.below(2) {
            let place = numbers.index(bytes.len());
            bytes[place] = bytes[place].wrapping_add(numbers.pick(&[1, 2, 64, 128, 255]));
        }
        match Snapshot::solid_from_bytes(&bytes) {
            Err(_) => refused += 1,
            Ok(solid) => {
                let lines = [0, 1].map(Term::Operand).into_iter();
                let terms = lines.chain([Term::Or(vec![0, 1])]).collect();
                let union = Expression::new(terms).expect("well formed");
                let operands = [solid.clone(), tool.clone()];
                let _ = evaluate(&union, &operands);
                let _ = (round::mesh(&solid), classify(&solid, &[[20; 3]]));
            }
        }
    }
    assert!(refused > 0);
}

/// The bytes of a solid, changed at random positions, with a correct checksum.
fn forged(solid: &Solid, numbers: &mut Numbers) -> Vec<u8> {
    let mut bytes = Snapshot::of(solid).to_bytes().expect("bytes");
    let sealed = bytes.len() - 4;
    for _ in 0..=numbers.below(2) {
        let place = 8 + numbers.index(sealed - 8);
        bytes[place] = bytes[place].wrapping_add(numbers.pick(&[1, 2, 64, 128, 255]));
    }
    let checksum = crc32fast::hash(&bytes[..sealed]);
    bytes[sealed..].copy_from_slice(&checksum.to_le_bytes());
    bytes
}

/// Uses a solid that was decoded; an internal error fails the test, other errors are returned.
fn used(solid: &Solid, tool: &Solid) -> Result<()> {
    let volume = || measure::volume(solid).map(drop);
    let near = || measure::volume_near(solid).map(drop);
    let mesh = || round::mesh(solid).map(drop);
    let place = || classify(solid, &[[20; 3], [5, 31, 8]]).map(drop);
    let normal = || normalize(solid, Rule::Positive).map(drop);
    let operated = || {
        let leaves = || [0, 1].map(Term::Operand).into_iter();
        for last in [
            Term::Or(vec![0, 1]),
            Term::And(vec![0, 1]),
            Term::Xor(vec![0, 1]),
        ] {
            let expression = Expression::new(leaves().chain([last]).collect())?;
            let (result, _) = evaluate(&expression, &[solid.clone(), tool.clone()])?;
            round::mesh(&result).map_err(|e| blamed_on_snapshot(&result, e))?;
        }
        Ok(())
    };
    for use_of in [
        &volume as &dyn Fn() -> Result<()>,
        &near,
        &mesh,
        &place,
        &normal,
        &operated,
    ] {
        let ended = caught(use_of).map_err(|e| blamed_on_snapshot(solid, e));
        match ended.map_err(|e| (e.kind(), e)) {
            Ok(())
            | Err((ErrorKind::BadSnapshot | ErrorKind::Unbounded | ErrorKind::PitchMismatch, _)) => {
            }
            Err((_, error)) => return Err(error),
        }
    }
    Ok(())
}

/// Forged bytes are refused, or stand for some solid that can be used.
#[test]
fn forged_snapshots_do_no_harm() {
    let mut numbers = Numbers::new(21);
    let rounds = std::env::var("BSPCSG_FORGED").map_or(300, |n| n.parse().expect("a number"));
    let (mut refused, mut taken) = (0, 0);
    for round in 0..rounds {
        let solid = match round % 4 {
            0 => Shape::any_cuboid(&mut numbers, 40).solid(),
            1 => with_plane(&mut numbers),
            _ => mixture(&mut numbers),
        };
        let tool = Shape::any_tetrahedron(&mut numbers, 40).solid();
        let bytes = forged(&solid, &mut numbers);
        match caught(|| Snapshot::solid_from_bytes(&bytes)) {
            Err(error) => {
                assert_eq!(
                    error.kind(),
                    ErrorKind::BadSnapshot,
                    "round {round}: {error}"
                );
                refused += 1;
            }
            Ok(solid) => {
                let ended = used(&solid, &tool);
                assert_eq!(ended, Ok(()), "round {round}: {bytes:?}");
                taken += 1;
            }
        }
    }
    assert!(refused > 0 && taken > 0, "{refused} refused, {taken} taken");
}

/// A solid with a half-space among its operands; it may be unbounded.
fn with_plane(numbers: &mut Numbers) -> Solid {
    let a = mixture(numbers);
    let normals: [[i128; 3]; 4] = [[1, 0, 0], [0, -1, 1], [1, 2, 3], [-3, 1, 2]];
    let (normal, offset) = (numbers.pick(&normals), numbers.below(40));
    let pitch = Pitch::new(0).expect("a pitch");
    let plane = half_space(normal, &Int::from_i128(offset.into()), pitch, None);
    let plane = plane.expect("a half-space");
    let plane = Solid::of_source(Arc::new(plane), true);
    applied(numbers.pick(&SetOp::ALL), &a, &plane)
}

fn moved(solid: &Solid, motion: &Motion, pitch: i64) -> Solid {
    let pitch = Pitch::new(pitch).expect("a pitch");
    let image = Snapshot::of(solid).moved(motion, pitch).expect("in range");
    image.solid().expect("a solid")
}

fn image_of(motion: &Motion, p: Lattice) -> Lattice {
    [0, 1, 2].map(|i| {
        let (axis, sign) = motion.axes[i];
        p[axis] * sign * motion.scale + motion.shift[i]
    })
}

/// Mirrors, permutations, shifts and refinements keep the volume and map the set as they should.
#[test]
fn motions_of_the_lattice_carry_solids_exactly() {
    let mut numbers = Numbers::new(10);
    let axes = [
        [(0, -1), (1, 1), (2, 1)],
        [(1, 1), (2, 1), (0, 1)],
        [(2, -1), (1, 1), (0, 1)],
        [(1, -1), (0, -1), (2, -1)],
    ];
    for round in 0..16 {
        let solid = mixture(&mut numbers);
        let (scale, pitch) = if round % 4 == 0 { (10, -1) } else { (1, 0) };
        let motion = Motion {
            axes: axes[round % 4],
            shift: numbers.point(1000).map(|c| (c - 500) * scale),
            scale,
        };
        let image = moved(&solid, &motion, pitch);
        let context = format!("{motion:?} in round {round}");
        manifold_mesh(&image, &context);
        assert_eq!(volume(&image), volume(&solid), "{context}");
        let points: Vec<Lattice> = (0..200).map(|_| numbers.point(40)).collect();
        let images: Vec<Lattice> = points.iter().map(|p| image_of(&motion, *p)).collect();
        assert_eq!(
            located(&image, &images),
            located(&solid, &points),
            "{context}"
        );
        let tool = Shape::any_tetrahedron(&mut numbers, 40).solid();
        let before = moved(&applied(SetOp::Union, &solid, &tool), &motion, pitch);
        let after = applied(SetOp::Union, &image, &moved(&tool, &motion, pitch));
        assert_eq!(volume(&before), volume(&after), "{context}");
        assert_same_set(&before, &after);
    }
}

/// The union of several shapes, which may overlap.
fn any_mixture(numbers: &mut Numbers, reach: i64) -> Shape {
    let one = |_| match numbers.below(2) {
        0 => Shape::any_tetrahedron(numbers, reach),
        _ => Shape::any_cuboid(numbers, reach),
    };
    (0..4).map(one).fold(Shape::default(), Shape::with)
}

/// Returns true if the mesh has a finding with this code.
fn found(mesh: &Mesh, code: &str) -> bool {
    mesh.findings.iter().any(|finding| finding.code == code)
}

/// Small cells at the border of the lattice, where the doubles of constructed points are wrong by steps:
/// there triangles may merge, and findings name them.
#[test]
fn results_are_the_same_at_the_border_of_the_lattice() {
    let mut numbers = Numbers::new(13);
    for shift in [LIMIT - 30, -LIMIT, 1 << 52] {
        for _ in 0..4 {
            let shapes = [0; 2].map(|_| any_mixture(&mut numbers, 30));
            let far = shapes.clone().map(|s| s.mapped(|p| p.map(|c| c + shift)));
            let [a, b] = shapes.map(|s| s.united());
            let [c, d] = far.each_ref().map(Shape::united);
            for op in SetOp::ALL {
                let (near, far) = (applied(op, &a, &b), applied(op, &c, &d));
                let context = format!("{op:?} of {far:?}");
                let (here, there) = (
                    manifold_mesh(&near, &context),
                    manifold_mesh(&far, &context),
                );
                let (most, least) = (here.triangles.len(), there.triangles.len());
                let merged = found(&there, "mended") && least < most;
                assert!(least == most || merged, "{most} {least} {context}");
                assert_eq!(volume(&far), volume(&near), "{context}");
            }
        }
    }
}

/// Approximate volumes and volumes modulo primes agree with exact ones.
#[test]
fn near_volumes_and_residues_agree_with_exact_ones() {
    let mut numbers = Numbers::new(14);
    for _ in 0..20 {
        let solid = mixture(&mut numbers);
        let exact = volume(&solid);
        let near = measure::volume_near(&solid).expect("bounded");
        let error = exact.minus(&Ratio::of(near)).times(1 << 60).times(1 << 60);
        assert!(error.is_between_zero_and_one(), "{error:?}");
        let residues = measure::volume_residues(&solid).expect("bounded");
        assert_eq!(residues, Some(exact.times(6).residues()));
    }
}
