//! Tests that the rows of the tables of keys hold.

use super::*;
use crate::model::jeffery::strain_per_period;
use crate::scene;

/// The shortest scene with every required key, and the key `path` with `value` in its table.
fn text(path: &str, value: &str) -> String {
    let (table, name) = path.rsplit_once('.').unwrap_or(("", path));
    let mut text = "title = \"t\"\n".to_owned();
    for Table { key: of, .. } in &TABLES {
        let mut own: Vec<(&str, &str)> = match of.path {
            "flow" => vec![("shear_rate_per_s", "1")],
            "particles" => {
                vec![("count", "10"), ("length_mm", "1"), ("aspect_ratio", "5"), ("orientation", "\"isotropic\"")]
            }
            "interaction" => vec![("concentration_per_cm3", "1"), ("alpha", "1")],
            "time" => vec![("periods", "1")],
            _ => Vec::new(),
        };
        if of.path == table {
            own.retain(|(known, _)| *known != name);
            own.push((name, value));
        }
        text += &format!("[{}]\n", of.path);
        own.iter().for_each(|(key, value)| text += &format!("{key} = {value}\n"));
    }
    text
}

#[test]
fn a_default_is_what_a_scene_without_the_key_has() {
    let without = scene::parse("t", &text("", "")).unwrap();
    for key in keys() {
        if let Absent::Default(value) = key.absent
            && key.path != "time.outputs_per_strain"
        {
            assert_eq!(scene::parse("t", &text(key.path, value)).unwrap(), without, "{}", key.path);
        }
    }
    let by_strain = scene::parse("t", &text("", "").replace("periods", "strain")).unwrap();
    assert_eq!(scene::Scene { interaction: None, ..by_strain.clone() }.outputs_per_unit(), 10);
    // Four steps resolve the motion of rods that collide.
    assert_eq!(by_strain.outputs_per_unit(), 4);
}

/// A flip takes a strain of about 2 at any r_e: outputs farther apart miss it.
#[test]
fn default_outputs_follow_the_strain() {
    let colliding = |r: f64| scene::parse("t", &text("particles.aspect_ratio", &r.to_string())).unwrap();
    let of = |r: f64| scene::Scene { interaction: None, ..colliding(r) }.outputs_per_unit();
    let default = [1.0, 5.0, 11.6, 11.8, 11.9, 14.2, 20.0, 50.0, 1e6].map(of);
    assert_eq!(default, [100, 200, 400, 400, 400, 450, 650, 1000, 1000]);
    for r in [2.0, 11.84, 12.0, 30.0, 100.0, 238.0] {
        // There are 1000 outputs at most.
        let allowed = f64::max(0.2, strain_per_period(r) / 1000.0);
        assert!(strain_per_period(r) / of(r) as f64 <= allowed, "{r}");
        // T/2 is the time of an output, and outputs are at steps.
        let (scene, outputs) = (colliding(r), colliding(r).outputs_per_unit());
        assert!(scene.steps_per_unit().is_multiple_of(outputs) && outputs.is_multiple_of(2), "{r}: {outputs}");
        let allowed = f64::max(0.4, strain_per_period(r) / 1000.0);
        assert!(strain_per_period(r) / outputs as f64 <= allowed, "{r}: {outputs}");
    }
    assert_eq!([11.6, 14.2, 15.0, 20.0].map(|r| colliding(r).outputs_per_unit()), [200, 300, 350, 600]);
}

/// A number of hundreds of digits is a power of ten in a message.
#[test]
fn numbers_are_short() {
    for (number, text) in [
        (0.0, "0"),
        (11.6, "11.6"),
        (-1e-5, "-0.00001"),
        (9e-6, "9e-6"),
        (9e15, "9000000000000000"),
        (-1e16, "-1e16"),
        (1e300, "1e300"),
        (f64::INFINITY, "inf"),
    ] {
        assert_eq!(crate::scene::document::decimal(number), text);
    }
}

/// In TOML a number with a fraction of 0 is no integer.
#[test]
fn values_are_written_as_toml() {
    let numbers = [20.0, -3.0, 0.25, 1e15, 1e16, 1e-9].map(toml::Value::Float);
    assert_eq!(
        numbers.each_ref().map(crate::scene::document::as_toml),
        ["20.0", "-3.0", "0.25", "1000000000000000.0", "1e16", "1e-9"]
    );
    assert_eq!(crate::scene::document::as_toml(&toml::Value::Integer(20)), "20");
}
