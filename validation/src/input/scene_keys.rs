//! The keys of a scene file from the core's table: for the terminal, for the manual, and as a JSON Schema.

use serde_json::{Map, Value, json};
use shearbed::Observable;
use shearbed::scene::{Absent, Holds, Key, MAX_FLOW_STEPS, TABLES, keys};

/// Each key with its meaning, unit, allowed values, and the value if it is not given.
pub fn rows() -> impl Iterator<Item = [String; 5]> {
    keys().map(|key| {
        let absent = match key.absent {
            Absent::Required => "must be given".to_owned(),
            Absent::Default(value) => value.to_owned(),
            Absent::Other(words) => words.to_owned(),
            _ => String::new(),
        };
        [key.path.into(), key.meaning.into(), key.unit.into(), key.holds.to_string(), absent]
    })
}

/// The keys as plain text.
pub fn text() -> String {
    let line = |[path, meaning, unit, holds, absent]: [String; 5]| {
        let unit = if unit.is_empty() { unit } else { format!(" [{unit}]") };
        format!("{path}{unit}: {meaning}\n    {holds}; without it: {absent}\n")
    };
    rows().map(line).collect()
}

/// The keys as a Markdown table.
pub fn markdown() -> String {
    let line = |row: [String; 5]| format!("| `{} |\n", row.join(" | ").replacen(" |", "` |", 1));
    let head = "| key | meaning | unit | allowed | without it |\n| --- | --- | --- | --- | --- |\n";
    head.to_owned() + &rows().map(line).collect::<String>()
}

/// A JSON Schema of whole scenes.
pub fn schema() -> Value {
    let title = keys().take_while(|key| !key.path.contains('.'));
    let tables = TABLES.iter().map(|table| (&table.key, Some(object(table.keys.iter().map(|key| (key, None))))));
    let mut whole = object(title.map(|key| (key, None)).chain(tables));
    whole["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    whole["title"] = "A scene of shearbed".into();
    whole
}

/// The schema of an object with these keys; a table comes with the schema of its own object.
fn object<'a>(keys: impl Iterator<Item = (&'a Key, Option<Value>)>) -> Value {
    let (mut properties, mut required) = (Map::new(), Vec::new());
    for (key, table) in keys {
        let name = key.path.rsplit('.').next().unwrap_or_default();
        let mut value = table.unwrap_or_else(|| holds(&key.holds));
        value["description"] = match key.unit {
            "" => key.meaning.into(),
            unit => format!("{}, in {unit}", key.meaning).into(),
        };
        properties.insert(name.to_owned(), value);
        if key.absent == Absent::Required {
            required.push(name);
        }
    }
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn gradient() -> Value {
    let row = json!({ "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 });
    json!({ "type": "array", "items": row, "minItems": 3, "maxItems": 3 })
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
        Holds::Gradient => gradient(),
        Holds::Steps => {
            let step = |rate: &str, holds: Value| {
                json!({
                    "type": "object",
                    "properties": { rate: holds, "strain": { "type": "number", "exclusiveMinimum": 0 } },
                    "required": [rate, "strain"],
                    "additionalProperties": false
                })
            };
            let steps = [step("shear_rate_per_s", json!({ "type": "number" })), step("gradient_per_s", gradient())];
            json!({ "type": "array", "minItems": 1, "maxItems": MAX_FLOW_STEPS, "items": { "oneOf": steps } })
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
