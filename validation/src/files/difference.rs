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

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn words(one: &Value, other: &Value) -> String {
        let (path, one, other) = difference(one, other).unwrap();
        format!("{path}: {one}, {other}")
    }

    #[test]
    fn the_first_difference_is_named() {
        let a = json!({ "version": "1", "over": ["x=1", "y=1"], "scene": { "m": 3.0 } });
        assert_eq!(difference(&a, &a.clone()), None);
        let mut b = a.clone();
        b["over"][1] = json!("y=2");
        assert_eq!(words(&a, &b), r#"over.2: "y=1", "y=2""#);
        b["over"][0] = json!("x=2");
        assert_eq!(words(&a, &b), r#"over.1: "x=1", "x=2""#);
        b["over"] = json!(["x=1"]);
        assert_eq!(words(&a, &b), r#"over: ["x=1","y=1"], ["x=1"]"#);
        let mut b = a.clone();
        b["scene"] = json!({});
        assert_eq!(words(&a, &b), "scene.m: 3.0, null");
        assert_eq!(words(&b, &a), "scene.m: null, 3.0");
    }
}
