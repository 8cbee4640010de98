//! Where the code of others comes from, under which licences, and what is built twice.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

/// Licences that ask for no more than their text and names: compatible with MIT or Apache-2.0.
const ALLOWED: [&str; 10] = [
    "MIT",
    "MIT-0",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "ISC",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

fn text(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// Name, version and licence of every crate that cargo builds on these edges, on Linux.
fn crates(edges: &str, root: &[&str]) -> BTreeSet<[String; 3]> {
    let tree = Command::new(env!("CARGO"))
        .args([
            "tree", "--locked", "--prefix", "none", "--format", "{p}|{l}", "--edges", edges,
        ])
        .args(["--target", "x86_64-unknown-linux-gnu"])
        .args(root)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    let tree = String::from_utf8(tree.stdout).unwrap();
    let row = |line: &str| {
        let (package, licence) = line.split_once('|')?;
        let (name, rest) = package.split_once(' ')?;
        let version = rest.split(' ').next()?;
        let licence = licence.trim_end_matches(" (*)");
        Some([name, version, licence].map(str::to_owned))
    };
    tree.lines().filter_map(row).collect()
}

/// Whether one of the licences that a crate is under at choice is allowed, for each part of it.
fn allowed(expression: &str) -> bool {
    let one = |licence: &str| ALLOWED.contains(&licence.trim());
    let part = |part: &str| {
        let part = part.trim().trim_start_matches('(').trim_end_matches(')');
        part.split(" OR ").flat_map(|choice| choice.split('/')).any(one)
    };
    expression.split(" AND ").all(part)
}

#[test]
fn licences_are_read() {
    for yes in [
        "MIT",
        "MIT/Apache-2.0",
        "GPL-3.0 OR MIT",
        "(MIT OR Apache-2.0) AND Unicode-3.0",
    ] {
        assert!(allowed(yes), "{yes}");
    }
    for no in [
        "",
        "GPL-3.0",
        "MIT AND GPL-3.0",
        "(GPL-2.0 OR LGPL-3.0) AND MIT",
        "MPL-2.0/GPL-2.0",
    ] {
        assert!(!allowed(no), "{no}");
    }
}

#[test]
fn every_licence_is_allowed() {
    let all = crates("normal,build,dev", &["--workspace", "--all-features"]);
    assert!(all.len() > 100, "{}", all.len());
    let not: Vec<_> = all.iter().filter(|[.., licence]| !allowed(licence)).collect();
    assert!(not.is_empty(), "{not:?}");
}

#[test]
fn every_crate_of_others_is_from_the_registry_with_its_checksum() {
    let lock: toml::Table = text("../Cargo.lock").parse().unwrap();
    let own = ["shearbed", "shearbed-suite"];
    for package in lock["package"].as_array().unwrap() {
        let name = package["name"].as_str().unwrap();
        let source = package.get("source").and_then(toml::Value::as_str);
        match source {
            None => assert!(own.contains(&name), "{name} has no source"),
            Some(source) => {
                assert_eq!(
                    source, "registry+https://github.com/rust-lang/crates.io-index",
                    "{name}"
                );
                assert!(package.get("checksum").is_some(), "{name} has no checksum");
            }
        }
    }
}

/// Versions beside each other cost building time, and are said.
#[test]
fn what_is_built_in_several_versions_is_said() {
    let mut versions: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
    for [name, version, _] in crates("normal,build", &["--package", "shearbed-suite"]) {
        versions.entry(name).or_default().insert(version);
    }
    let several: Vec<_> = versions
        .iter()
        .filter(|(_, all)| all.len() > 1)
        .map(|(name, _)| name.as_str())
        .collect();
    let document = text("../docs/dependencies.md");
    let (_, said) = document.split_once("Built in more than one version: ").unwrap();
    let (said, _) = said.split_once('.').unwrap();
    let said: Vec<_> = said.split('`').skip(1).step_by(2).collect();
    assert_eq!(said, several);
}

#[test]
fn unsafe_is_forbidden_in_both_crates() {
    let table = |path: &str| text(path).parse::<toml::Table>().unwrap();
    let root = table("../Cargo.toml");
    assert_eq!(
        root["workspace"]["lints"]["rust"]["unsafe_code"].as_str(),
        Some("forbid")
    );
    for manifest in [root, table("Cargo.toml")] {
        assert_eq!(manifest["lints"]["workspace"].as_bool(), Some(true));
    }
}
