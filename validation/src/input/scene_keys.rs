//! The keys of a scene file, from the core's one table: for the terminal, for the documents, and as a JSON Schema.

use serde_json::{Map, Value, json};
use shearbed::Observable;
use shearbed::scene::{Absent, Holds, KEYS, Key, TABLES};

/// Each key with what it means, its unit, what it may hold, and what it is where it is not given.
pub fn rows() -> impl Iterator<Item = [String; 5]> {
    KEYS.iter().map(|key| {
        let absent = match key.absent {
            Absent::Refused => "must be given".to_owned(),
            Absent::Default(value) => value.to_owned(),
            Absent::Other(words) => words.to_owned(),
        };
        [key.path.into(), key.meaning.into(), key.unit.into(), key.holds.to_string(), absent]
    })
}

/// As plain lines, a key each.
pub fn text() -> String {
    let line = |[path, meaning, unit, holds, absent]: [String; 5]| {
        let unit = if unit.is_empty() { unit } else { format!(" [{unit}]") };
        format!("{path}{unit}: {meaning}\n    {holds}; without it: {absent}\n")
    };
    rows().map(line).collect()
}

/// As a table in Markdown.
pub fn markdown() -> String {
    let line = |row: [String; 5]| format!("| `{} |\n", row.join(" | ").replacen(" |", "` |", 1));
    let head = "| key | meaning | unit | allowed | without it |\n| --- | --- | --- | --- | --- |\n";
    head.to_owned() + &rows().map(line).collect::<String>()
}

/// As a JSON Schema of whole scenes.
pub fn schema() -> Value {
    let of_table = |table: &str| {
        let inner = |key: &&Key| key.path.rsplit_once('.').map_or("", |(above, _)| above) == table;
        let within: Vec<_> = KEYS.iter().chain(&TABLES).filter(inner).collect();
        (within, table.to_owned())
    };
    let mut whole = object(of_table("").0, &|table| object(of_table(table).0, &|_| Value::Null));
    whole["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    whole["title"] = "A scene of shearbed".into();
    whole
}

fn object(keys: Vec<&Key>, table: &dyn Fn(&str) -> Value) -> Value {
    let name = |key: &Key| key.path.rsplit('.').next().unwrap_or_default().to_owned();
    let required: Vec<_> =
        keys.iter().filter(|key| key.absent == Absent::Refused).map(|key| name(key)).collect();
    let properties: Map<_, _> = keys
        .iter()
        .map(|key| {
            let mut value = match key.holds {
                Holds::Table(_) => table(key.path),
                _ => holds(&key.holds),
            };
            value["description"] = match key.unit {
                "" => key.meaning.into(),
                unit => format!("{}, in {unit}", key.meaning).into(),
            };
            (name(key), value)
        })
        .collect();
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn holds(holds: &Holds) -> Value {
    match *holds {
        Holds::Whole { least, most } => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Holds::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Holds::NotNegative => json!({ "type": "number", "minimum": 0 }),
        Holds::Between { least, most } => json!({ "type": "number", "minimum": least, "maximum": most }),
        Holds::Sides => json!({
            "type": "array", "minItems": 3, "maxItems": 3, "items": { "type": "number", "exclusiveMinimum": 0 }
        }),
        Holds::Gradient => {
            let row = json!({ "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 });
            json!({ "type": "array", "items": row, "minItems": 3, "maxItems": 3 })
        }
        Holds::Orientation => json!({ "oneOf": [
            { "const": "isotropic" },
            {
                "type": "object",
                "properties": {
                    "phi_deg": { "type": "number" },
                    "theta_deg": { "type": "number", "minimum": 0, "maximum": 180 }
                },
                "required": ["phi_deg", "theta_deg"],
                "additionalProperties": false
            }
        ] }),
        Holds::Rods => json!({
            "type": "object",
            "properties": { "file": { "type": "string" }, "crc32": { "type": "string" } },
            "required": ["file"],
            "additionalProperties": false
        }),
        Holds::OneOf(words) => json!({ "enum": words }),
        Holds::Observables => {
            let names = Observable::ALL.map(|observable| observable.name());
            json!({ "type": "array", "items": { "enum": names }, "minItems": 1, "uniqueItems": true })
        }
        Holds::Times => {
            json!({ "type": "array", "items": { "type": "number", "minimum": 0 }, "uniqueItems": true })
        }
        _ => json!({ "type": "string" }),
    }
}
