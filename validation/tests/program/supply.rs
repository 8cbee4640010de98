//! What is built twice, and that nothing is unsafe. Licences and sources are cargo-deny's: validation/deny.toml.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

fn text(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

/// Name and version of every crate of the program, as cargo builds it on Linux.
fn crates() -> BTreeSet<[String; 2]> {
    let tree = Command::new(env!("CARGO"))
        .args(["tree", "--locked", "--prefix", "none", "--edges", "normal,build"])
        .args([
            "--target",
            "x86_64-unknown-linux-gnu",
            "--package",
            "shearbed-suite",
        ])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    let tree = String::from_utf8(tree.stdout).unwrap();
    let row = |line: &str| {
        let mut words = line.split(' ').map(str::to_owned);
        Some([words.next()?, words.next()?])
    };
    tree.lines().filter_map(row).collect()
}

/// Versions beside each other cost building time, and are said.
#[test]
fn what_is_built_in_several_versions_is_said() {
    let mut versions: BTreeMap<_, BTreeSet<_>> = BTreeMap::new();
    for [name, version] in crates() {
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
fn unsafe_is_forbidden_in_every_crate_and_the_oracles_know_nothing_of_the_others() {
    let table = |path: &str| text(path).parse::<toml::Table>().unwrap();
    let root = table("../Cargo.toml");
    assert_eq!(
        root["workspace"]["lints"]["rust"]["unsafe_code"].as_str(),
        Some("forbid")
    );
    let oracle = table("oracle/Cargo.toml");
    for manifest in [&root, &oracle, &table("Cargo.toml")] {
        assert_eq!(manifest["lints"]["workspace"].as_bool(), Some(true));
    }
    let asked_for = oracle["dependencies"].as_table().unwrap();
    assert!(asked_for.len() > 5 && !asked_for.keys().any(|name| name.starts_with("shearbed")));
    assert!(!oracle.contains_key("dev-dependencies"));
}
