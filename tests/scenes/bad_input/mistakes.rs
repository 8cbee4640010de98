//! Mistakes that are no wrong value of one key: what is missing, unknown, at odds with another key, or no TOML.

use super::{EXTENSION, INTERACTING, REVERSED, STEPPED, STIRRED};
use crate::refusal;
use shearbed::Plan;
use std::collections::BTreeMap;

#[test]
fn any_other_mistake_is_named_with_its_line() {
    let mistakes: BTreeMap<String, Vec<[String; 4]>> = toml::from_str(include_str!("mistakes.toml")).unwrap();
    for [scene, part, replacement, start] in &mistakes["mistakes"] {
        let scene = match scene.as_str() {
            "interacting" => INTERACTING,
            "extension" => EXTENSION,
            "stepped" => STEPPED,
            "reversed" => REVERSED,
            "stirred" => STIRRED,
            other => panic!("{other}"),
        };
        assert!(scene.contains(part) && Plan::parse("s.toml", scene).is_ok(), "{part}");
        let refusal = refusal(&scene.replacen(part, replacement, 1));
        assert!(format!("{refusal}\n").starts_with(&format!("dir/s.toml:{start}")), "{start}\n{refusal}");
        assert_eq!(refusal.lines().count(), 1, "{refusal}");
    }
}
