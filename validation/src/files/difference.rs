//! Finds the first difference between two records.

use serde_json::Value;

/// The first path at which two records differ, such as `scene.particles.count`, and both values; null for a missing
/// value.
pub(crate) fn difference(one: &Value, other: &Value) -> Option<(String, Value, Value)> {
    at("", one, other)
}

fn at(path: &str, one: &Value, other: &Value) -> Option<(String, Value, Value)> {
    let below = |key: &str| match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    };
    match (one, other) {
        (Value::Object(a), Value::Object(b)) => (a.keys().chain(b.keys()))
            .find_map(|key| at(&below(key), a.get(key).unwrap_or(&Value::Null), b.get(key).unwrap_or(&Value::Null))),
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            (0..a.len()).find_map(|k| at(&below(&(k + 1).to_string()), &a[k], &b[k]))
        }
        _ if one == other => None,
        _ => Some((path.to_owned(), one.clone(), other.clone())),
    }
}
