//! docs/src/developer/dependencies.md is true, and the oracles ask for nothing of what they judge. Licences and sources
//! are cargo-deny's: validation/deny.toml.

use super::order::all_sources;
use crate::common::bounded::Bounded;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

fn text(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)).unwrap()
}

fn manifest(path: &str) -> toml::Table {
    text(path).parse().unwrap()
}

/// Name, version and features of every crate that packages of this workspace are built from on Linux.
fn tree(packages: &[&str], edges: &str) -> BTreeSet<[String; 3]> {
    let tree = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--prefix", "none", "--format", "{p} |{f}", "--edges", edges])
        .args(["--target", "x86_64-unknown-linux-gnu"])
        .args(packages.iter().flat_map(|package| ["--package", package]))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .ended();
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    let tree = String::from_utf8(tree.stdout).unwrap();
    let row = |line: &str| {
        let mut words = line.split(' ').map(str::to_owned);
        let features = line.split_once('|')?.1.trim_end_matches(" (*)");
        Some([words.next()?, words.next()?, features.to_owned()])
    };
    tree.lines().filter_map(row).collect()
}

/// Name and version of every crate of the program.
fn crates() -> BTreeSet<[String; 2]> {
    tree(&["shearbed-cli"], "normal,build").into_iter().map(|[name, version, _]| [name, version]).collect()
}

/// `cargo test` uses what `cargo run -- validate` has built: a package of the tests that asks for another feature of a
/// crate of the program would have nearly everything built a second time.
#[test]
fn the_tests_ask_for_no_other_features_than_the_program() {
    let packages = ["shearbed-cli", "shearbed-validation", "shearbed", "shearbed-oracle"];
    let program = tree(&packages, "normal,build");
    let tests = tree(&packages, "normal,build,dev");
    assert!(tests.len() > program.len());
    let others: Vec<_> = program.difference(&tests).collect();
    assert!(others.is_empty(), "{others:?}");
    // Control: criterion does.
    let benches = tree(&["shearbed-validation", "shearbed", "shearbed-benches"], "normal,build,dev");
    assert!(program.difference(&benches).any(|[name, ..]| name == "either"));
}

/// The crates of others that a manifest asks for, and where they are needed.
fn asked_for(path: &str) -> BTreeMap<String, &'static str> {
    let table = manifest(path);
    let mut found = BTreeMap::new();
    for (section, place) in [("dev-dependencies", "tests"), ("dependencies", "program")] {
        for (name, entry) in table.get(section).and_then(toml::Value::as_table).into_iter().flatten() {
            let optional = entry.get("optional").and_then(toml::Value::as_bool) == Some(true);
            found.insert(name.clone(), if optional { "feature `mpi`" } else { place });
        }
    }
    found.retain(|name, _| !name.starts_with("shearbed"));
    found
}

#[test]
fn every_dependency_has_a_line_and_the_crates_are_counted() {
    let page = text("../docs/src/developer/dependencies.md");
    let mut listed = BTreeMap::new();
    for row in page.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<_> = row.split('|').map(str::trim).collect();
        for name in cells[1].split(", ") {
            let before = listed.insert(name.trim_matches('`').to_owned(), cells[3].to_owned());
            assert_eq!(before, None, "{name} twice");
        }
        assert!(!cells[2].is_empty(), "{row}");
    }
    let mut expected: BTreeMap<String, String> = BTreeMap::new();
    for package in ["..", "oracle", "methods", ".", "cli", "benches"] {
        let path = format!("{package}/Cargo.toml");
        for (name, place) in asked_for(&path) {
            let known = expected.entry(name).or_insert_with(|| place.to_owned());
            if place == "program" {
                *known = place.to_owned();
            }
        }
    }
    assert_eq!(listed, expected);
    // The five crates of this project are not of others.
    let of_others = crates().len() - 5;
    assert!(page.contains(&format!("\n{of_others} crates of others")), "{of_others}");
}

/// Versions beside each other cost building time, and are said.
#[test]
fn what_is_built_in_several_versions_is_said() {
    let mut versions: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
    for [name, version] in crates() {
        versions.entry(name).or_default().insert(version);
    }
    let several: Vec<_> = versions.iter().filter(|(_, all)| all.len() > 1).map(|(name, _)| name.as_str()).collect();
    let document = text("../docs/src/developer/dependencies.md");
    let (_, said) = document.split_once("Built in more than one version: ").unwrap();
    let (said, _) = said.split_once('.').unwrap();
    let said: Vec<_> = said.split('`').skip(1).step_by(2).collect();
    assert_eq!(said, several);
}

#[test]
fn the_oracles_ask_for_nothing_of_what_they_judge() {
    let oracle = manifest("oracle/Cargo.toml");
    for (table, least) in [("dependencies", 6), ("dev-dependencies", 1)] {
        let asked_for = oracle[table].as_table().unwrap();
        assert!(asked_for.len() >= least && !asked_for.keys().any(|name| name.starts_with("shearbed")), "{table}");
    }
}

/// Cargo lets no built-in profile inherit from another: what an installed program optimises is written twice.
#[test]
fn a_release_optimises_what_the_default_build_does() {
    let profiles = &manifest("../Cargo.toml")["profile"];
    let [dev, release] = ["dev", "release"].map(|name| profiles[name]["package"].as_table().unwrap());
    let levels = |all: &toml::Table| all.iter().map(|(k, v)| (k.clone(), v["opt-level"].clone())).collect::<Vec<_>>();
    assert_eq!(levels(dev), levels(release));
    assert!(dev.len() > 20);
}

/// A file that is built in and no source would change results, and neither the commit's `-dirty` nor the digest by
/// which the gate knows a report of the same sources.
#[test]
fn every_file_that_is_built_in_is_a_source() {
    let build = text("build.rs");
    let listed = build.split("const SOURCES").nth(1).unwrap().split("];").next().unwrap();
    let sources: Vec<_> = listed.split('"').skip(1).step_by(2).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap();
    let is_source = |path: &Path| sources.iter().any(|source| path.starts_with(root.join(source)));
    let mut seen = 0;
    for file in sources.iter().flat_map(|source| all_sources(&root.join(source))) {
        let text = std::fs::read_to_string(&file).unwrap();
        for after in text.split("include_").skip(1) {
            let name = ["str!(\"", "bytes!(\""].iter().find_map(|start| after.strip_prefix(start)?.split('"').next());
            let Some(name) = name.filter(|name| !name.ends_with("README.md")) else { continue };
            let path = file.parent().unwrap().join(name).canonicalize().unwrap();
            assert!(is_source(&path), "{}: {name}", file.display());
            seen += 1;
        }
    }
    assert!(seen > 20 && !is_source(&root.join("README.md")));
}
