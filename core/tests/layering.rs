//! The layers of the crate point one way: a module uses only what lies below it, and no file uses
//! itself by way of others.
//!
//! Read from the sources: every path that starts at `crate::`, `super::` or `self::` names what it
//! reaches into.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// From the bottom to the top.
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

fn rank(layer: &str) -> Option<usize> {
    LAYERS.iter().position(|&name| name == layer)
}

/// The names that follow `crate::` or enough `super::` in `source`, the groups taken apart.
///
/// `depth` is the number of modules between the file's own module and the crate root.
fn reached(source: &str, depth: usize) -> Vec<String> {
    let code = without_comments(source);
    let climb = "super::".repeat(depth);
    let mut names = Vec::new();
    for root in ["crate::", climb.as_str()] {
        for (at, _) in code.match_indices(root) {
            let starts_path =
                !code[..at].ends_with(|c: char| c.is_alphanumeric() || "_:$".contains(c));
            if starts_path {
                names.extend(first_segments(&code[at + root.len()..]));
            }
        }
    }
    names
}

fn without_comments(source: &str) -> String {
    source
        .lines()
        .map(|line| line.find("//").map_or(line, |at| &line[..at]))
        .collect::<Vec<_>>()
        .join("\n")
}

/// `a::b` gives `a`; `{a::{b, c}, d}` gives `a` and `d`.
fn first_segments(path: &str) -> Vec<String> {
    let Some(group) = path.strip_prefix('{') else {
        return vec![identifier(path)];
    };
    let mut level = 0;
    let mut names = Vec::new();
    let mut start = 0;
    for (at, c) in group.char_indices() {
        match c {
            '{' => level += 1,
            ',' if level == 0 => {
                names.push(identifier(group[start..at].trim_start()));
                start = at + 1;
            }
            '}' if level == 0 => {
                names.push(identifier(group[start..at].trim_start()));
                break;
            }
            '}' => level -= 1,
            _ => {}
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

fn identifier(text: &str) -> String {
    text.chars()
        .take_while(|c| c.is_alphanumeric() || *c == '_')
        .collect()
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

/// The layer of a file and how many modules its own module lies below the root.
fn place(relative: &Path) -> (String, usize) {
    let parts: Vec<String> = relative
        .components()
        .map(|part| part.as_os_str().to_string_lossy().into_owned())
        .collect();
    let layer = parts[0].trim_end_matches(".rs").to_owned();
    let is_folder_page = parts.last().is_some_and(|name| name == "mod.rs");
    (layer, parts.len() - usize::from(is_folder_page))
}

/// The paths after `prefix` in code without comments, groups taken apart.
fn paths_after(code: &str, prefix: &str) -> Vec<String> {
    let starts = code.match_indices(prefix).map(|(at, _)| at);
    let is_start =
        |at: &usize| !code[..*at].ends_with(|c: char| c.is_alphanumeric() || "_:$".contains(c));
    let ends = starts.filter(is_start).map(|at| at + prefix.len());
    ends.flat_map(|at| taken_apart(&code[at..])).collect()
}

/// `a::{b::C, d}` gives `a::b::C` and `a::d`.
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

/// The module of a file: `tree/node.rs` is `tree::node`, `tree/mod.rs` is `tree`.
fn module_of(relative: &Path) -> String {
    let text = relative
        .with_extension("")
        .to_string_lossy()
        .replace('/', "::");
    text.strip_suffix("::mod")
        .map_or(text.clone(), str::to_owned)
}

/// For each module those that it uses, tests inside modules left out.
fn uses(root: &Path) -> BTreeMap<String, BTreeSet<String>> {
    let mut files = Vec::new();
    rust_files(root, &mut files);
    let module = |file: &PathBuf| module_of(file.strip_prefix(root).expect("found below the root"));
    let known: BTreeSet<String> = files.iter().map(module).collect();
    let owner = |path: &str| {
        let mut path = path.to_owned();
        while !known.contains(&path) {
            path = path.rsplit_once("::")?.0.to_owned();
        }
        Some(path)
    };
    let used = |file: &PathBuf| {
        let own = module(file);
        let source = fs::read_to_string(file).expect("a source file can be read");
        let code = without_comments(&source);
        let code = code.split("#[cfg(test)]\nmod tests {").next().unwrap_or("");
        let mut above: Vec<&str> = own.split("::").collect();
        let mut paths = paths_after(code, "crate::");
        let within = paths_after(code, "self::").into_iter();
        paths.extend(within.map(|path| format!("{own}::{path}")));
        let mut climb = String::new();
        while above.pop().is_some() {
            climb += "super::";
            let inside = above.join("::");
            let climbed = paths_after(code, &climb).into_iter();
            let outside = climbed.filter(|path| !path.starts_with("super::"));
            paths.extend(outside.map(|path| format!("{inside}::{path}")));
        }
        let all = paths.iter().filter_map(|path| owner(path));
        let others = all.filter(|other| *other != own).collect();
        (own, others)
    };
    files.iter().map(used).collect()
}

#[test]
fn no_file_uses_itself_by_way_of_others() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut open = uses(&root);
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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    rust_files(&root, &mut files);
    files.sort();
    let mut faults = Vec::new();
    let mut checked = 0;
    for file in files.iter().filter(|file| !file.ends_with("lib.rs")) {
        let relative = file.strip_prefix(&root).expect("found below the root");
        let (layer, depth) = place(relative);
        let own =
            rank(&layer).unwrap_or_else(|| panic!("{} belongs to no layer", relative.display()));
        let source = fs::read_to_string(file).expect("a source file can be read");
        checked += 1;
        for name in reached(&source, depth) {
            if rank(&name).is_some_and(|other| other > own) {
                faults.push(format!("{} uses {name}", relative.display()));
            }
        }
    }
    assert!(checked > 0, "no source file was found");
    assert!(faults.is_empty(), "upward uses:\n{}", faults.join("\n"));
}

#[test]
fn every_way_to_name_a_layer_is_seen() {
    assert_eq!(reached("use crate::tree::Node;", 2), ["tree"]);
    assert_eq!(
        reached("use crate::{mesh::{A, B}, arith};", 2),
        ["mesh", "arith"]
    );
    assert_eq!(
        reached("use crate::{\n    mesh::A,\n    tree,\n};", 2),
        ["mesh", "tree"]
    );
    assert_eq!(reached("let x = super::super::tree::f();", 2), ["tree"]);
    assert_eq!(reached("use super::node::Node;", 2), Vec::<String>::new());
    assert_eq!(
        reached("// crate::python is above\n", 2),
        Vec::<String>::new()
    );
    assert_eq!(reached("pub(crate) use super::merge::x;", 1), ["merge"]);
}

#[test]
fn groups_of_paths_are_taken_apart() {
    let expected = ["a::B", "a::c::D", "a::c::e"];
    assert_eq!(taken_apart("a::{B, c::{D, e}};"), expected);
    assert_eq!(paths_after("use super::a::b;", "super::"), ["a::b"]);
    assert_eq!(module_of(Path::new("tree/node.rs")), "tree::node");
    assert_eq!(module_of(Path::new("tree/mod.rs")), "tree");
}

#[test]
fn a_file_knows_its_layer() {
    assert_eq!(place(Path::new("error.rs")), ("error".to_owned(), 1));
    assert_eq!(place(Path::new("tree/mod.rs")), ("tree".to_owned(), 1));
    assert_eq!(place(Path::new("tree/node.rs")), ("tree".to_owned(), 2));
    assert_eq!(
        place(Path::new("tree/node/walk.rs")),
        ("tree".to_owned(), 3)
    );
}
