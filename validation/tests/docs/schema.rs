//! The JSON Schema of scenes.

use validation::input::{scene_keys, scenes};

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
