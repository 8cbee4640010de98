//! Scene files that must be refused, each with line, key, value as written and what is allowed.

mod mistakes;
mod whole;

use crate::refusal;
use shearbed::Plan;

const INTERACTING: &str = r#"title = "t"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 10
length_mm = 0.72
aspect_ratio = 11.6
aspect_ratio_sd_percent = 3.6
orientation = "isotropic"
[interaction]
concentration_per_cm3 = 50
alpha = 0.5
m = 3
update = "rotation"
min_contact_arm = 0.0
[time]
periods = 1
steps_per_period = 20
outputs_per_period = 10
[ensemble]
replicas = 2
seed = 1
[output]
observables = ["projections"]
rods_at = [0, 0.5]
"#;

const EXTENSION: &str = r#"title = "t"
[flow]
gradient_per_s = [[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]
[particles]
count = 10
length_mm = 0.72
aspect_ratio = 11.6
orientation = "isotropic"
[time]
strain = 2
outputs_per_strain = 10
"#;

/// Interacting rods without a number of outputs, whose last key is in `[time]`.
const STEPPED: &str = r#"title = "t"
[flow]
shear_rate_per_s = 1
[particles]
count = 9
length_mm = 1
aspect_ratio = 15
orientation = "isotropic"
[interaction]
concentration_per_cm3 = 9
alpha = 0.5
[time]
periods = 1
steps_per_period = 100
"#;

const REVERSED: &str = r#"title = "t"
[flow]
steps = [{ shear_rate_per_s = 1, strain = 2 }, { strain = 3, gradient_per_s = [[0, 0, 0], [-1, 0, 0], [0, 0, 0]] }]
[particles]
count = 10
length_mm = 0.72
aspect_ratio = 11.6
orientation = "isotropic"
[time]
strain = 5
"#;

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

/// Each key, what its errors say is allowed, and values that are not.
#[rustfmt::skip]
const KEYS: &[(&str, &str, &[&str])] = &[
    ("title", "expected a text in quotes", &["3", "true", "[]", "{ }", "1979-05-27"]),
    ("flow.shear_rate_per_s", "expected a finite number > 0", NOT_POSITIVE),
    ("flow.gradient_per_s", "expected three rows of three finite numbers", NOT_A_GRADIENT),
    ("flow.steps", "expected 1 to 1000 tables [[flow.steps]], each with strain", &["[]", "3", "[1]", "{ }", "[[]]"]),
    ("particles.count", "expected a whole number from 1 to 100000000", NOT_A_COUNT),
    ("particles.count", "expected a whole number from 1 to 100000000", &["100000001"]),
    ("particles.length_mm", "expected a finite number > 0", NOT_POSITIVE),
    ("particles.aspect_ratio", "expected a number from 1e-100 to 1e100", NOT_POSITIVE),
    ("particles.aspect_ratio", "expected a number from 1e-100 to 1e100", &["1e-101", "1e101"]),
    ("particles.aspect_ratio", "interacting rods need a number > 1", &["1", "1.0", "0.5"]),
    ("particles.aspect_ratio_sd_percent", "expected a finite number ≥ 0", NEGATIVE),
    ("particles.aspect_ratio_sd_percent", "expected a number below 30.4598 with a mean of 11.6: with more, r_e ≤ \
        1", &["30.5", "100", "1e300"]),
    ("particles.orientation", "expected \"isotropic\" or { phi_deg = a finite number, theta_deg = ", NOT_A_DIRECTION),
    ("interaction.concentration_per_cm3", "expected a finite number > 0", NOT_POSITIVE),
    ("interaction.alpha", "expected a finite number ≥ 0", NEGATIVE),
    ("interaction.m", "expected a finite number > 0", NOT_POSITIVE),
    ("interaction.update", "expected \"rotation\", \"angles\" or \"kick\"", &["\"Angles\"", "\"\"", "1", "true"]),
    ("interaction.min_contact_arm", "expected a finite number ≥ 0", NEGATIVE),
    ("time.periods", "expected a finite number ≥ 0", NEGATIVE),
    ("time.periods", "at most 1e6 outputs in all", &["1e9", "1e308"]),
    ("time.strain", "expected a finite number ≥ 0", NEGATIVE),
    ("time.strain", "at most 1e6 outputs in all", &["1e7"]),
    ("time.steps_per_period", "expected a whole number from 1 to 10000000", NOT_A_COUNT),
    ("time.outputs_per_period", "expected a whole number from 1 to 10000000", NOT_A_COUNT),
    ("time.outputs_per_period", "interacting rods need a divisor of steps_per_period = 20", &["3", "40"]),
    ("time.outputs_per_strain", "expected a whole number from 1 to 10000000", NOT_A_COUNT),
    ("ensemble.replicas", "expected a whole number from 1 to 10000000", NOT_A_COUNT),
    ("ensemble.replicas", "expected a whole number from 1 to 10000000", &["10000001"]),
    ("ensemble.seed", "expected a whole number from 0 to 9223372036854775807", &["-1", "1.0", "\"1\""]),
    ("ensemble.seed", "expected a whole number from 0 to 9223372036854775807", &["9223372036854775808"]),
    ("output.rods_at", "expected a list of finite numbers ≥ 0 that grow", &["0.1", "[-1]", "[nan]", "[0.2, \
        0.1]", "[\"0\"]", "[inf]", "{ }"]),
    ("output.rods_at", "different output times, k/10 up to 1", &["[0.15]", "[1.1]", "[0, 1e300]", "[0.5, 0.5000001]"]),
    ("output.observables", "expected a list of one or more of \"projections\", \"planar", NOT_OBSERVABLES),
];

#[rustfmt::skip]
const NOT_POSITIVE: &[&str] = &[
    "0", "-0.0", "-1", "nan", "-nan", "inf", "-inf", "1e400", "-1e400", "\"1\"", "true", "[]", "[1]", "{ }",
];
#[rustfmt::skip]
const NEGATIVE: &[&str] = &[
    "-1", "-1e-300", "nan", "inf", "-inf", "1e400", "\"1\"", "true", "[]", "{ }",
];
#[rustfmt::skip]
const NOT_A_COUNT: &[&str] = &[
    "0", "-1", "1.5", "1.0", "nan", "inf", "1e3", "18446744073709551616",
    "99999999999999999999999999999999999999999", "\"1\"", "true", "[]", "{ }",
];
#[rustfmt::skip]
const NOT_A_GRADIENT: &[&str] = &[
    "1", "\"1\"", "[]", "[[0, 0, 0], [1, 0, 0]]", "[[0, 0, 0], [1, 0], [0, 0, 0]]",
    "[0, 0, 0, 1, 0, 0, 0, 0, 0]", "[[0, 0, 0], [nan, 0, 0], [0, 0, 0]]",
    "[[0, 0, 0], [\"1\", 0, 0], [0, 0, 0]]", "[[0, 0, inf], [1, 0, 0], [0, 0, 0]]",
    "[[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 0, 0]]",
];
#[rustfmt::skip]
const NOT_A_DIRECTION: &[&str] = &[
    "\"random\"", "3", "[0, 90]", "{ }", "{ phi_deg = 0 }", "{ theta_deg = 0 }",
    "{ phi_deg = 0, theta_deg = \"90\" }", "{ phi_deg = 0, theta_deg = 90, psi_deg = 0 }",
    "{ phi_deg = nan, theta_deg = 90 }", "{ phi_deg = inf, theta_deg = 90 }",
    "{ phi_deg = 0, theta_deg = nan }", "{ phi_deg = 0, theta_deg = -1 }", "{ phi_deg = 0, theta_deg = 180.1 }",
];
#[rustfmt::skip]
const NOT_OBSERVABLES: &[&str] = &[
    "[]", "\"projections\"", "3", "[3]", "[\"projection\"]", "[\"mean_angle\", \"\"]",
    "[\"projections\", \"mean_angle\", \"projections\"]",
];

#[test]
fn a_bad_value_is_named_with_line_key_and_what_is_allowed() {
    for (key, allowed, values) in KEYS {
        // A table that no key allows is refused like any other value, and not as unknown.
        let table = ["{ x = 1 }"].iter().filter(|_| allowed.starts_with("expected") && !allowed.contains("below"));
        for value in values.iter().chain(table) {
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
            assert!(KEYS.iter().any(|(spoiled, ..)| *spoiled == key), "{key}");
        }
    }
}
