//! Every target holds on its seeds and on damaged copies of them, and on what it once failed on,
//! without libFuzzer.

use std::fs;
use std::path::Path;

use super::support;

#[path = "../../fuzz/src/scene.rs"]
mod scene;
#[expect(dead_code, reason = "libFuzzer's targets write seeds as files")]
#[path = "../../fuzz/src/seeds.rs"]
mod seeds;
#[path = "../../fuzz/src/targets/mod.rs"]
mod targets;
#[path = "../../fuzz/src/winding.rs"]
mod winding;

use seeds::seeds;

fn holds_around_its_seeds(name: &str, target: fn(&[u8])) {
    for (number, seed) in seeds(name).into_iter().enumerate() {
        target(&seed);
        for round in 0..8 {
            let mut damaged = seed.clone();
            let place = (number * 131 + round * 977) % damaged.len();
            damaged[place] = damaged[place].wrapping_mul(5).wrapping_add(71);
            damaged.truncate(seed.len() - round * seed.len() / 16);
            target(&damaged);
        }
    }
}

fn holds_on_what_is_kept(name: &str, target: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/kept");
    for entry in fs::read_dir(folder.join(name)).expect("a folder of the target") {
        target(&fs::read(entry.expect("an entry").path()).expect("a file"));
    }
}

#[test]
fn snapshot() {
    holds_around_its_seeds("snapshot", targets::snapshot);
    holds_on_what_is_kept("snapshot", targets::snapshot);
}

#[test]
fn import() {
    holds_around_its_seeds("import", targets::import);
    holds_on_what_is_kept("import", targets::import);
}

#[test]
fn program() {
    holds_around_its_seeds("program", targets::program);
}

#[test]
fn section() {
    holds_around_its_seeds("section", targets::section);
    holds_on_what_is_kept("section", targets::section);
}

#[test]
fn evaluate() {
    holds_around_its_seeds("evaluate", targets::evaluate);
}

// Found: a solid read back from its snapshot had a quad split along the other diagonal.
#[test]
fn extract() {
    holds_around_its_seeds("extract", targets::extract);
    holds_on_what_is_kept("extract", targets::extract);
}
