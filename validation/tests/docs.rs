//! Committed documents are fresh: those that come from the registry, and the list of dependencies.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;
use validation::input::{scene_keys, scenes};
use validation::program::{dependencies, tried};

/// Compares a committed file with what is made now, or writes it.
fn fresh(file: &str, expected: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, expected).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == expected,
        "{file} is stale: UPDATE_DOCS=1 cargo test -p shearbed-suite --test docs"
    );
}

#[test]
fn the_catalogue_is_fresh() {
    fresh("../docs/catalogue.md", &validation::cases::catalogue::markdown());
}

#[test]
fn the_table_of_keys_and_the_schema_of_scenes_are_fresh() {
    let head = "# The keys of a scene\n\nMade from the core's table of keys (`src/scene/keys.rs`), as are what is checked, `shearbed scenes --keys` and\n\
                [scene.json](../validation/schemas/scene.json), a JSON Schema. What goes together is in the README.\n\n";
    fresh("../docs/scene.md", &format!("{head}{}", scene_keys::markdown()));
    let schema = serde_json::to_string_pretty(&scene_keys::schema()).unwrap();
    fresh("schemas/scene.json", &format!("{schema}\n"));
}

/// Every built-in scene holds to the schema; a value that the program refuses by its key alone does not.
#[test]
fn the_schema_is_the_programs() {
    let schema = jsonschema::validator_for(&scene_keys::schema()).unwrap();
    let json = |text: &str| serde_json::to_value(text.parse::<toml::Table>().unwrap()).unwrap();
    for scene in scenes::ALL {
        assert!(schema.is_valid(&json(scene.text)), "{}", scene.name);
    }
    let text = scenes::find("fig4-n50").unwrap().text;
    for line in text.lines().filter(|line| line.contains(" = ")) {
        let (key, _) = line.split_once(" = ").unwrap();
        for wrong in ["-1", "[]", "{ a = 1 }", "1e999"] {
            let text = text.replace(line, &format!("{key} = {wrong}"));
            let Ok(table) = text.parse::<toml::Table>() else {
                continue;
            };
            let refused = shearbed::scene_file::parse("t", &text).is_err();
            let schema_refuses = !serde_json::to_value(table).is_ok_and(|value| schema.is_valid(&value));
            assert_eq!(schema_refuses, refused, "{key} = {wrong}");
        }
    }
}

/// The name of each crate that a manifest asks for, and where it is used.
fn asked_for(manifest: &str) -> BTreeMap<String, &'static str> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(manifest);
    let table: toml::Table = std::fs::read_to_string(path).unwrap().parse().unwrap();
    let mut found = BTreeMap::new();
    for (section, place) in [("dev-dependencies", "tests"), ("dependencies", "program")] {
        for (name, entry) in table
            .get(section)
            .and_then(toml::Value::as_table)
            .into_iter()
            .flatten()
        {
            let optional = entry.get("optional").and_then(toml::Value::as_bool) == Some(true);
            found.insert(name.clone(), if optional { "feature `mpi`" } else { place });
        }
    }
    found.retain(|name, _| !name.starts_with("shearbed"));
    found
}

/// The program has the page in it, and a package has no file from beside its folder.
#[test]
fn the_page_of_dependencies_is_the_programs() {
    fresh("../docs/dependencies.md", dependencies::DOCUMENT);
}

#[test]
fn the_report_and_the_page_say_the_same_of_what_was_tried() {
    let page =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/strength.md")).unwrap();
    assert!(
        page.contains(tried::DOCUMENT),
        "docs/strength.md begins with the table of validation/src/tried.md"
    );
    let table = tried::table();
    assert!(table.rows.len() > 5 && table.rows.iter().all(|row| row.len() == table.columns.len()));
}

#[test]
fn every_dependency_has_a_line_and_the_crates_are_counted() {
    let mut expected = asked_for("../Cargo.toml");
    for (name, place) in asked_for("Cargo.toml")
        .into_iter()
        .chain(asked_for("oracle/Cargo.toml"))
    {
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

    // What cargo builds for the program, each version once; the three crates of this project are not of others.
    let tree = Command::new(env!("CARGO"))
        .args([
            "tree",
            "--locked",
            "--package",
            "shearbed-suite",
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
    assert_eq!(dependencies::crates(), Some(crates.len() - 3));
}
