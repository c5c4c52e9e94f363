//! Checks the layers of the crate: a module uses only modules below it, and no file uses itself through
//! others.
//!
//! Reads the sources: every path that starts at `crate::`, `super::` or `self::` names a module that is
//! used.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The layers of the crate, from the bottom to the top.
const LAYERS: [&str; 11] = [
    "error",
    "interrupt",
    "arith",
    "geometry",
    "mesh",
    "tree",
    "merge",
    "extract",
    "store",
    "query",
    "python",
];

const TESTS: &str = "#[cfg(test)]\nmod tests {";

/// The modules of the crate and their code, without comments.
fn modules() -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&root, &mut files);
    let read = |file: &PathBuf| {
        let source = fs::read_to_string(file).expect("a source file can be read");
        let relative = file.strip_prefix(&root).expect("found below the root");
        (module_of(relative), without_comments(&source))
    };
    files.iter().map(read).collect()
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the source folder can be read") {
        let path = entry.expect("its entries too").path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|suffix| suffix == "rs") {
            found.push(path);
        }
    }
}

/// The module of a file: `tree/node.rs` is `tree::node`, `tree/mod.rs` is `tree`.
fn module_of(relative: &Path) -> String {
    let path = relative.with_extension("");
    let text = path.to_string_lossy().replace(['/', '\\'], "::");
    text.strip_suffix("::mod").unwrap_or(&text).to_owned()
}

fn without_comments(source: &str) -> String {
    let code = |line: &str| line.split("//").next().unwrap_or("").to_owned();
    source.lines().map(code).collect::<Vec<_>>().join("\n")
}

/// For each module the other modules that its code names.
fn uses(modules: &BTreeMap<String, String>) -> BTreeMap<String, BTreeSet<String>> {
    let owner = |mut path: &str| {
        while !modules.contains_key(path) {
            path = path.rsplit_once("::")?.0;
        }
        Some(path.to_owned())
    };
    let used = |(own, code): (&String, &String)| {
        let others = paths_of(own, code);
        let others = others.iter().filter_map(|path| owner(path));
        (own.clone(), others.filter(|other| other != own).collect())
    };
    modules.iter().map(used).collect()
}

/// The paths in a module's code, written from the root of the crate.
fn paths_of(own: &str, code: &str) -> Vec<String> {
    let mut paths = paths_after(code, "crate::");
    let within = paths_after(code, "self::").into_iter();
    paths.extend(within.map(|path| format!("{own}::{path}")));
    let mut above: Vec<&str> = own.split("::").collect();
    let mut climb = String::new();
    while above.pop().is_some() {
        climb += "super::";
        let climbed = paths_after(code, &climb).into_iter();
        let outside = climbed.filter(|path| !path.starts_with("super::"));
        paths.extend(outside.map(|path| [above.as_slice(), &[path.as_str()]].concat().join("::")));
    }
    paths
}

/// The paths after `prefix` in code without comments, with groups expanded.
fn paths_after(code: &str, prefix: &str) -> Vec<String> {
    let starts = code.match_indices(prefix).map(|(at, _)| at);
    let is_start =
        |at: &usize| !code[..*at].ends_with(|c: char| c.is_alphanumeric() || "_:$".contains(c));
    let ends = starts.filter(is_start).map(|at| at + prefix.len());
    ends.flat_map(|at| taken_apart(&code[at..])).collect()
}

/// Expands the groups of a path: `a::{b::C, d}` gives `a::b::C` and `a::d`.
fn taken_apart(path: &str) -> Vec<String> {
    let is_plain = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let plain = &path[..path.find(|c| !is_plain(c)).unwrap_or(path.len())];
    let Some(group) = path[plain.len()..].strip_prefix('{') else {
        return vec![plain.to_owned()];
    };
    let mut level = 0;
    let mut members = vec![0];
    for (at, c) in group.char_indices() {
        match c {
            '{' => level += 1,
            ',' if level == 0 => members.push(at + 1),
            '}' if level == 0 => break,
            '}' => level -= 1,
            _ => {}
        }
    }
    let member = |at: usize| taken_apart(group[at..].trim_start());
    let names = members.into_iter().flat_map(member);
    names.map(|name| format!("{plain}{name}")).collect()
}

#[test]
fn no_file_uses_itself_by_way_of_others() {
    let mut files = modules();
    // Tests inside a file may use modules that are built on the file.
    for code in files.values_mut() {
        code.truncate(code.find(TESTS).unwrap_or(code.len()));
    }
    let mut open = uses(&files);
    assert!(open.values().map(BTreeSet::len).sum::<usize>() > 500);
    loop {
        let done: BTreeSet<String> = open
            .iter()
            .filter(|(_, used)| used.is_empty())
            .map(|(module, _)| module.clone())
            .collect();
        if done.is_empty() {
            break;
        }
        open.retain(|module, _| !done.contains(module));
        for used in open.values_mut() {
            used.retain(|module| !done.contains(module));
        }
    }
    assert!(open.is_empty(), "circles among or below: {open:#?}");
}

#[test]
fn no_layer_reaches_upwards() {
    let rank = |module: &str| {
        let layer = module.split("::").next();
        let found = LAYERS.iter().position(|&name| Some(name) == layer);
        found.unwrap_or_else(|| panic!("{module} belongs to no layer"))
    };
    let mut files = modules();
    files.remove("lib").expect("the root of the crate");
    let mut faults = Vec::new();
    for (module, used) in uses(&files) {
        let above = used.iter().filter(|other| rank(other) > rank(&module));
        faults.extend(above.map(|other| format!("{module} uses {other}")));
    }
    assert!(faults.is_empty(), "upward uses:\n{}", faults.join("\n"));
}

#[test]
fn every_way_to_name_a_module_is_seen() {
    let expected = ["a::B", "a::c::D", "a::c::e"];
    assert_eq!(taken_apart("a::{B, c::{D, e}};"), expected);
    let paths = |code| paths_of("mesh::a", &without_comments(code));
    assert_eq!(paths("use crate::tree::Node;"), ["tree::Node"]);
    let several = ["mesh::A", "mesh::B", "arith"];
    assert_eq!(
        paths("use crate::{\n    mesh::{A, B},\n    arith};"),
        several
    );
    assert_eq!(paths("let x = super::super::tree::f();"), ["tree::f"]);
    assert_eq!(paths("pub(crate) use super::b::C;"), ["mesh::b::C"]);
    assert_eq!(paths("use self::b::C;"), ["mesh::a::b::C"]);
    assert_eq!(paths("// crate::python is above\n"), Vec::<String>::new());
    assert_eq!(module_of(Path::new("tree/node.rs")), "tree::node");
    assert_eq!(module_of(Path::new("tree/mod.rs")), "tree");
}
