//! Scene files that must be refused, each with line, key, value as written and what is allowed.

mod mistakes;
mod whole;

use crate::refusal;
use serde::Deserialize;
use shearbed::Plan;
use std::collections::BTreeMap;
use std::slice::from_ref;

const INTERACTING: &str = include_str!("bad_input/interacting.toml");
const EXTENSION: &str = include_str!("bad_input/extension.toml");
/// Interacting rods without a number of outputs, whose last key is in `[time]`.
const STEPPED: &str = include_str!("bad_input/stepped.toml");
const REVERSED: &str = include_str!("bad_input/reversed.toml");
const STIRRED: &str = include_str!("bad_input/stirred.toml");

/// The file's text with `table.key` set to `value`, and the line of the key. `None` where the text lacks it.
fn set(text: &str, path: &str, value: &str) -> Option<(String, usize)> {
    let (table, key) = path.split_once('.').unwrap_or(("", path));
    let mut inside = table.is_empty();
    let mut found = None;
    let mut lines = Vec::new();
    for (k, line) in text.lines().enumerate() {
        if line.starts_with('[') {
            inside = line == format!("[{table}]");
        }
        if inside && line.starts_with(&format!("{key} =")) {
            found = Some(k + 1);
            lines.push(format!("{key} = {value}"));
        } else {
            lines.push(line.to_owned());
        }
    }
    Some((lines.join("\n"), found?))
}

/// The rows of `keys.toml`.
#[derive(Deserialize)]
struct Keys {
    keys: Vec<Vec<String>>,
    lists: BTreeMap<String, Vec<String>>,
}

fn keys() -> Keys {
    toml::from_str(include_str!("bad_input/keys.toml")).unwrap()
}

#[test]
fn a_bad_value_is_named_with_line_key_and_what_is_allowed() {
    let Keys { keys, lists } = keys();
    for row in &keys {
        let [key, allowed, values @ ..] = &row[..] else { panic!("{row:?}") };
        let values = values.iter().flat_map(|value| lists.get(value).map_or(from_ref(value), Vec::as_slice));
        // A table that no key allows is refused like any other value, and not as unknown.
        let with_table = allowed.starts_with("expected") && !allowed.contains("below");
        for value in values.map(String::as_str).chain(with_table.then_some("{ x = 1 }")) {
            let spoiled = [INTERACTING, EXTENSION, REVERSED].iter().find_map(|text| set(text, key, value));
            let (text, line) = spoiled.expect("one of the scenes has the key");
            let start = format!("dir/s.toml:{line}: {key} = {value} is not allowed: {allowed}");
            let refusal = refusal(&text);
            assert!(refusal.starts_with(&start), "{start}\n{refusal}");
            assert_eq!(refusal.lines().count(), 1, "{refusal}");
        }
    }
}

#[test]
fn every_key_of_a_scene_is_spoiled_above() {
    let rows = keys().keys;
    let tables = [INTERACTING, EXTENSION, REVERSED].map(|text| {
        assert!(Plan::parse("s.toml", text).is_ok(), "{text}");
        text.parse::<toml::Table>().unwrap()
    });
    for (table, content) in tables.iter().flatten() {
        let keys = match content {
            toml::Value::Table(keys) => keys.keys().map(|key| format!("{table}.{key}")).collect(),
            _ => vec![table.clone()],
        };
        for key in keys {
            assert!(rows.iter().any(|row| row[0] == key), "{key}");
        }
    }
}
