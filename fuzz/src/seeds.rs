//! Bytes to start from: snapshots of mixed solids, and numbers for all else.

use bspcsg::merge::expression::Term;
use bspcsg::store::snapshot::Snapshot;

use super::support::{combined, Numbers, Shape};

/// Names the folder that a target writes its seeds to, after which it ends.
pub const ASKED: &str = "BSPCSG_FUZZ_SEEDS";

/// The number of seeds that a target starts from.
const COUNT: u64 = 40;

/// Bytes of scenes with four operands and all their points.
const LENGTH: usize = 600;

/// The seeds of a target.
#[must_use]
pub fn seeds(target: &str) -> Vec<Vec<u8>> {
    let make = if target == "snapshot" {
        stored
    } else {
        numbers
    };
    (0..COUNT).map(make).collect()
}

/// Writes the seeds of a target and ends the process, if the environment asks for that.
///
/// # Panics
/// If they cannot be written.
pub fn write_if_asked(target: &str) {
    let Some(folder) = std::env::var_os(ASKED) else {
        return;
    };
    for (number, bytes) in seeds(target).into_iter().enumerate() {
        let path = std::path::Path::new(&folder).join(format!("seed-{number:02}"));
        std::fs::write(path, bytes).expect("the folder can be written to");
    }
    std::process::exit(0);
}

fn numbers(seed: u64) -> Vec<u8> {
    let mut numbers = Numbers::new(seed);
    let byte = |_| u8::try_from(numbers.below(256)).expect("a byte");
    (0..LENGTH).map(byte).collect()
}

/// A solid with lattice and constructed corners, cut and whole faces, and a hole.
fn stored(seed: u64) -> Vec<u8> {
    let mut numbers = Numbers::new(seed);
    let reach = [5, 40, 1 << 30][numbers.index(3)];
    let a = Shape::any_cuboid(&mut numbers, reach).solid();
    let b = Shape::any_tetrahedron(&mut numbers, reach).solid();
    let c = Shape::any_tetrahedron(&mut numbers, reach).solid();
    let lines = vec![Term::Or(vec![0, 1]), Term::Not(2), Term::And(vec![3, 4])];
    let solid = combined(&[a, b, c], lines);
    Snapshot::of(&solid).to_bytes().expect("bytes")
}
