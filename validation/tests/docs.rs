//! Committed documents are fresh: those that come from the registry, and the list of dependencies.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;
use validation::dependencies;

#[test]
fn the_catalogue_is_fresh() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/catalogue.md");
    let expected = validation::catalogue::markdown();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, &expected).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == expected,
        "docs/catalogue.md is stale: UPDATE_DOCS=1 cargo test -p validation --test docs"
    );
}

/// The name of each crate that a manifest asks for, and where it is used.
fn asked_for(manifest: &str) -> BTreeMap<String, &'static str> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(manifest);
    let table: toml::Table = std::fs::read_to_string(path).unwrap().parse().unwrap();
    let mut found = BTreeMap::new();
    for (section, place) in [("dev-dependencies", "tests"), ("dependencies", "program")] {
        for (name, entry) in table[section].as_table().unwrap() {
            let optional = entry.get("optional").and_then(toml::Value::as_bool) == Some(true);
            found.insert(name.clone(), if optional { "feature `mpi`" } else { place });
        }
    }
    found.remove("shearbed");
    found
}

#[test]
fn every_dependency_has_a_line_and_the_crates_are_counted() {
    let mut expected = asked_for("../Cargo.toml");
    for (name, place) in asked_for("Cargo.toml") {
        let known = expected.entry(name).or_insert(place);
        if place == "program" {
            *known = place;
        }
    }
    let mut listed = BTreeMap::new();
    for row in dependencies::table().rows {
        for name in row[0].split(", ") {
            let place = row[2].clone();
            assert_eq!(
                listed.insert(name.trim_matches('`').to_owned(), place),
                None,
                "{name} twice"
            );
        }
        assert!(!row[1].is_empty());
    }
    let expected: BTreeMap<_, _> = expected
        .into_iter()
        .map(|(name, place)| (name, place.to_owned()))
        .collect();
    assert_eq!(listed, expected);

    // What cargo builds for the program, each version once; the two crates of this project are not of others.
    let tree = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--locked",
            "--package",
            "validation",
            "--edges",
            "normal,build",
            "--prefix",
            "none",
        ])
        .args(["--format", "{p}", "--target", "x86_64-unknown-linux-gnu"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    let tree = String::from_utf8(tree.stdout).unwrap();
    let crates: BTreeSet<Vec<_>> = tree
        .lines()
        .map(|line| line.split(' ').take(2).collect())
        .collect();
    assert_eq!(dependencies::crates(), Some(crates.len() - 2));
}
