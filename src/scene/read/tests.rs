//! Tests how much of a text is searched and shown.

use super::*;
use crate::scene::SceneProblem;
use crate::scene::document::LOOKED_THROUGH;

const SCENE: &str = "title = \"t\"\nflow = { shear_rate_per_s = 1 }\ntime = { periods = 1 }\n[particles]\ncount = 10\n\
    length_mm = 1\naspect_ratio = 5\norientation = \"isotropic\"\n";

/// The problems of a text, their messages, and the number of bytes searched for them.
fn refused(text: &str) -> (Vec<SceneProblem>, String, usize) {
    LOOKED_THROUGH.set(0);
    let error = parse("s.toml", text).unwrap_err();
    let words = error.to_string();
    let Error::Text { problems, .. } = error else { panic!("{words}") };
    (problems, words, LOOKED_THROUGH.get())
}

/// Tested with keys in separate lines, and with all keys in one line.
#[test]
fn of_many_unknown_keys_the_first_have_a_line_each_and_the_rest_one() {
    let keys: Vec<_> = (0..40_000).map(|k| format!("k{k} = 1")).collect();
    let in_lines = format!("{SCENE}{}\n", keys.join("\n"));
    let in_one = SCENE.replace("shear_rate_per_s = 1", &format!("shear_rate_per_s = 1, {}", keys.join(", ")));
    for (text, first, next) in [(in_lines, 9, 29), (in_one, 2, 2)] {
        let (problems, error, looked_through) = refused(&text);
        assert_eq!(problems.len(), MOST_UNKNOWN + 1);
        assert_eq!(problems[0].line, Some(first));
        assert!(problems[0].message.contains("unknown key `k0`"), "{error}");
        let rest = format!("\ns.toml:{next}: 39980 more unknown keys from here on");
        assert!(error.ends_with(&rest), "{error}");
        // The whole text once for the lines, and a part of each line that is shown.
        assert!(looked_through < text.len() + 1000 * MOST_UNKNOWN, "{looked_through}");
    }
    // As many unknown keys as are reported singly.
    let few = keys[..MOST_UNKNOWN].join("\n");
    let (problems, error, _) = refused(&format!("{SCENE}{few}"));
    assert_eq!(problems.len(), MOST_UNKNOWN);
    assert!(!error.contains("more unknown"), "{error}");
}

#[test]
fn of_a_refused_list_the_first_value_at_fault_is_named() {
    for (key, end) in [
        ("times = [0, 2, 1, 1]", "numbers ≥ 0 that grow; the first wrong one is number 3: 1"),
        ("times = [0, \"a\", -1]", "; the first wrong one is number 2: \"a\""),
        ("rods_at = [-1, 0]", "; the first wrong one is number 1: -1"),
        ("observables = [\"projections\", \"projections\"]", "; the first wrong one is number 2: \"projections\""),
        ("times = 3", "numbers ≥ 0 that grow"),
        ("observables = []", "each once"),
    ] {
        let (problems, ..) = refused(&format!("{SCENE}\n[output]\n{key}\n"));
        assert!(problems.iter().any(|problem| problem.message.ends_with(end)), "{problems:?}");
    }
}

#[test]
fn of_a_long_line_or_value_the_start_is_shown() {
    let long = "x".repeat(5000);
    for spoilt in [
        SCENE.replace("count = 10", &format!("count = \"{long}\"")),
        SCENE.replace("count = 10", &format!("count = {long}")),
        SCENE.replace("count = 10", &format!("count = 10\n{long} = 1")),
        SCENE.replace("count = 10", &format!("count = 10 10 # {long}")),
        SCENE.replace("\"isotropic\"", &format!("{{ file = \"{long}\", phi_deg = 1 }}")),
        format!("{SCENE}# é{}\n[particles]", "é".repeat(5000)),
        SCENE.replace("title = \"t\"", &format!("title = [\"{long}\"]")),
    ] {
        let (problems, ..) = refused(&spoilt);
        for problem in problems {
            assert!(problem.message.chars().count() < 1500, "{}", problem.message);
            assert!(!problem.message.contains(&long[..500]), "{}", problem.message);
        }
    }
    // A short value is shown whole.
    let (_, error, _) = refused(&SCENE.replace("count = 10", "count = \"x\""));
    assert!(error.contains("particles.count = \"x\" is not allowed"), "{error}");
}

/// A concentration, a duration or times that are set replace those of the text, whatever the key; of two that are set
/// none gives way.
#[test]
fn what_is_set_replaces_what_the_text_gives_by_another_key() {
    use crate::scene::{document::Document, of_document, set};
    let text = "title = 't'\n[flow]\nshear_rate_per_s = 1\n[particles]\ncount = 5\nlength_mm = 1\naspect_ratio = 10\n\
                orientation = 'isotropic'\n[interaction]\nconcentration_per_cm3 = 20\nalpha = 0.5\n\
                [time]\nperiods = 1\nsteps_per_period = 60\noutputs_per_period = 60\n";
    let with = |settings: &[(&str, toml::Value)]| {
        let mut document = Document::parse("t.toml", text)?;
        settings.iter().try_for_each(|(key, value)| set(&mut document, key, value.clone()))?;
        of_document(&document)
    };
    let fraction = ("particles.volume_fraction", 1e-4.into());
    let scene = with(std::slice::from_ref(&fraction)).unwrap();
    assert_eq!(scene.concentration_key(), "particles.volume_fraction");
    assert!(crate::Plan::new(&scene).is_ok());
    let sides = vec![toml::Value::Float(6.0); 3].into();
    assert_eq!(with(&[("interaction.box_mm", sides)]).unwrap().concentration_key(), "interaction.box_mm");
    let both = with(&[fraction, ("interaction.concentration_per_cm3", 30.into())]);
    assert!(both.is_err() || crate::Plan::new(&both.unwrap()).is_err());
    let time = with(&[("time.strain", 3.0.into())]).unwrap().time;
    assert_eq!(time, crate::scene::Time::strain(3.0));
    // The same unit keeps its steps.
    let time = with(&[("time.periods", 3.0.into())]).unwrap().time;
    assert_eq!((time.duration, time.steps_per_unit, time.outputs_per_unit), (3.0, Some(60), Some(60)));
    assert!(with(&[("time.strain", 3.0.into()), ("time.seconds", 3.0.into())]).is_err());
    assert!(with(&[("time.steps_per_period", 30.into()), ("time.strain", 3.0.into())]).is_err());
    let times = ("output.times", toml::Value::from(vec![0.5, 1.0]));
    let scene = with(std::slice::from_ref(&times)).unwrap();
    assert_eq!((scene.time.steps_per_unit, scene.time.outputs_per_unit), (Some(60), None));
    let both = with(&[times, ("time.outputs_per_period", 60.into())]).unwrap();
    assert!(crate::Plan::new(&both).is_err());
    // Times of the text are in the unit of its duration.
    let listed = text.replace("outputs_per_period = 60\n", "[output]\ntimes = [0.5, 1]\n");
    let set_in = |text: &str, settings: &[(&str, toml::Value)]| {
        let mut document = Document::parse("t.toml", text)?;
        settings.iter().try_for_each(|(key, value)| set(&mut document, key, value.clone()))?;
        of_document(&document).map(|scene| scene.output.times)
    };
    let with = |settings: &[(&str, toml::Value)]| set_in(&listed, settings);
    assert_eq!(with(&[("time.outputs_per_period", 20.into())]).unwrap(), [] as [f64; 0]);
    let (seconds, times) = (("time.seconds", 100.0.into()), ("output.times", toml::Value::from(vec![7.0])));
    let why = with(std::slice::from_ref(&seconds)).unwrap_err().to_string();
    assert!(why.contains("t.toml:16: output.times = [0.5, 1] is not allowed: it goes with time.periods"), "{why}");
    let rods = text.to_owned() + "[output]\nrods_at = [0.5]\n";
    let why = set_in(&rods, std::slice::from_ref(&seconds)).unwrap_err().to_string();
    assert!(why.contains("t.toml:17: output.rods_at = [0.5] is not allowed: it goes with time.periods"), "{why}");
    assert_eq!(with(&[seconds.clone(), times.clone()]).unwrap(), [7.0]);
    assert_eq!(with(&[times, seconds]).unwrap(), [7.0]);
    assert_eq!(with(&[("time.periods", 3.0.into())]).unwrap(), [0.5, 1.0]);
    assert_eq!(with(&[("interaction.alpha", 1.0.into())]).unwrap(), [0.5, 1.0]);
}

/// A key that is taken out is gone, with or without a place in the text.
#[test]
fn a_key_is_taken_out() {
    use crate::scene::document::Document;
    let mut document = Document::parse("t.toml", "title = 't'\n[a]\nb = 1\nc = 2\n").unwrap();
    document.set("a.d", 3.into()).unwrap();
    let keys = |document: &Document| {
        let keys = |table: toml::Table| table.into_iter().map(|(key, _)| key).collect::<Vec<_>>();
        [keys(document.root().whole()), keys(document.root().table("a").unwrap().whole())].concat()
    };
    assert_eq!(keys(&document), ["a", "title", "b", "c", "d"]);
    ["a.b", "a.d", "a.x", "x.y", "title.z"].iter().for_each(|key| document.remove(key));
    assert_eq!(keys(&document), ["a", "title", "c"]);
    document.remove("title");
    assert_eq!(keys(&document), ["a", "c"]);
}

/// Each regime begins where it says, here with rods of 1 cm.
#[test]
fn a_regime_begins_at_its_border() {
    let regime = |n: f64| {
        let text = format!(
            "title = 't'\n[flow]\nshear_rate_per_s = 1\n[particles]\ncount = 5\nlength_mm = 10\naspect_ratio = 10\n\
             orientation = 'isotropic'\n[interaction]\nconcentration_per_cm3 = {n:?}\nalpha = 0.5\n\
             [time]\nperiods = 1\n"
        );
        crate::scene::parse("t.toml", &text).unwrap().regime().unwrap()
    };
    assert_eq!([0.099, 0.1, 0.999].map(regime), ["dilute", "not far below 1", "not far below 1"]);
    assert_eq!([1.0, 9.9, 10.0].map(regime), ["semi-dilute", "semi-dilute", "concentrated"]);
}
