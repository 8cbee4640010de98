//! Committed documents that are made from the program are fresh.

use std::path::Path;
use validation::input::{scene_keys, scenes};

/// Compares a committed file with what is made now, or writes it.
fn fresh(file: &str, expected: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(&path, expected).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == expected, "{file} is stale: UPDATE_DOCS=1 cargo test -p shearbed-suite --test docs");
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
            let refused = shearbed::scene::parse("t", &text).is_err();
            let schema_refuses = !serde_json::to_value(table).is_ok_and(|value| schema.is_valid(&value));
            assert_eq!(schema_refuses, refused, "{key} = {wrong}");
        }
    }
}
