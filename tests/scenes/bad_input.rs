//! Scene files that must be refused, each with line, key, value as written and what is allowed.

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

/// A part of the scene, what takes its place, and the message.
#[rustfmt::skip]
const OTHER_MISTAKES: &[(&str, &str, &str, &str)] = &[
    // A table or a key that is missing.
    (INTERACTING, "title = \"t\"\n", "", "1: title is missing: expected a text in quotes"),
    (INTERACTING, "[flow]\nshear_rate_per_s = 0.5\n", "", "1: flow is missing: expected a table [flow] with "),
    (INTERACTING, "shear_rate_per_s = 0.5", "", "2: flow.shear_rate_per_s is missing: shear_rate_per_s, gradient_per_s \
        or steps"),
    (INTERACTING, "count = 10\n", "", "4: particles.count is missing: expected a whole number from 1 to 100000000"),
    (INTERACTING, "alpha = 0.5\n", "", "10: interaction.alpha is missing: expected a finite number ≥ 0"),
    (INTERACTING, "periods = 1\n", "", "16: time.periods is missing: periods, strain or seconds must be given"),
    (EXTENSION, "[time]\nstrain = 2\noutputs_per_strain = 10\n", "",
     "1: time is missing: expected a table [time] with periods"),
    // An unknown key or table.
    (INTERACTING, "count", "cuont", "5: cuont = 10: unknown key `cuont`, expected one of `count`, `length_mm`"),
    (INTERACTING, "alpha", "α", "12: α = 0.5: "),
    (INTERACTING, "[particles]", "[particle]",
     "4: [particle]: unknown key `particle`, expected one of `title`, `flow`"),
    (INTERACTING, "title", "name = 1\ntitle", "1: name = 1: unknown key `name`, expected one of `title`"),
    (INTERACTING, "seed", "speed", "22: speed = 1: unknown key `speed`, expected `replicas` or `seed`"),
    (INTERACTING, "observables", "observable",
     "24: observable = [\"projections\"]: unknown key `observable`, expected"),
    // Something else where a table should be.
    (EXTENSION, "title = \"t\"\n", "title = \"t\"\noutput = 3\n", "2: output = 3 is not allowed: expected a table \
        [output]"),
    (EXTENSION, "[time]", "[[time]]", "9: time = "),
    // What does not go together.
    (INTERACTING, "shear_rate", "gradient_per_s = [[0,0,0],[1,0,0],[0,0,0]]\nshear_rate",
     "4: flow.shear_rate_per_s = 0.5 is not allowed: either shear_rate_per_s or gradient_per_s, not both"),
    (EXTENSION, "gradient_per_s = [[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "shear_rate_per_s = 1e-308",
     "3: flow.shear_rate_per_s = 1e-308 is not allowed: such that the run lasts a finite number of seconds"),
    (EXTENSION, "[[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "[[0, -5e-324, 0], [5e-324, 0, 0], [0, 0, 5e-324]]",
     "3: flow.gradient_per_s = [[0, -5e-324, 0], [5e-324, 0, 0], [0, 0, 5e-324]] is not allowed: such that the run"),
    (EXTENSION, "[[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "[[1e308, 0, 0], [0, -1e308, 0], [0, 0, 0]]",
     "3: flow.gradient_per_s = [[1e308, 0, 0], [0, -1e308, 0], [0, 0, 0]] is not allowed: such that the run"),
    (INTERACTING, "shear_rate_per_s = 0.5", "gradient_per_s = [\n  [1, 0, 0],\n  [0, -1, 0], [0, 0, 0.1]]",
     "3: flow.gradient_per_s = [ [1, 0, 0], [0, -1, 0], [0, 0, 0.1]] is not allowed: where rods interact, a gradient \
      with ∂u_1/∂x_1 + "),
    (INTERACTING, "periods = 1", "periods = 1\nstrain = 1",
     "17: time.periods = 1 is not allowed: either periods or strain, not both"),
    (INTERACTING, "periods = 1\nsteps_per_period = 20", "periods = 101\nsteps_per_period = 10000000",
     "17: time.periods = 101 is not allowed: at most 1e9 steps in all"),
    (INTERACTING, "periods = 1", "strain = 1",
     "18: time.steps_per_period = 20 is not allowed: goes with periods; strain takes steps_per_strain"),
    (INTERACTING, "steps_per_period = 20", "outputs_per_strain = 5",
     "18: time.outputs_per_strain = 5 is not allowed: goes with strain; periods take outputs_per_period"),
    (INTERACTING, "concentration_per_cm3 = 50", "concentration_per_cm3 = 1e-320",
     "11: interaction.concentration_per_cm3 = 1e-320 is not allowed: expected a number for which the control volume"),
    (EXTENSION, "strain = 2\noutputs_per_strain = 10", "periods = 2",
     "10: time.periods = 2 is not allowed: rods of this aspect ratio have no period in this flow: give strain"),
    (EXTENSION, "strain = 2", "strain = 2\noutputs_per_period = 5",
     "11: time.outputs_per_period = 5 is not allowed: goes with periods"),
    (EXTENSION, "strain = 2", "strain = 2\nsteps_per_period = 5",
     "11: time.steps_per_period = 5 is not allowed: goes with periods"),
    (EXTENSION, "[[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "[[0, -1, 0], [1, 0, 0], [0, 0, 0]]",
     "10: time.strain = 2 is not allowed: this flow has no strain rate: give periods"),
    (EXTENSION, "outputs_per_strain = 10", "outputs_per_strain = 10\n[output]\nobservables = [\"particle_stress\"]",
     "13: output.observables = [\"particle_stress\"] is not allowed: particle_stress needs plane Couette flow"),
    (INTERACTING, "[\"projections\"]", "[\"projections\", \"stress\"]",
     "1: liquid.viscosity_pa_s is missing: give it, for stress is in Pa"),
    (INTERACTING, "[particles]", "[liquid]\nviscosity_pa_s = 0\n[particles]",
     "5: liquid.viscosity_pa_s = 0 is not allowed: expected a finite number > 0"),
    (EXTENSION, "outputs_per_strain = 10", "outputs_per_strain = 10\n[output]\nobservables = [\"orbit_constant\"]",
     "13: output.observables = [\"orbit_constant\"] is not allowed: orbit_constant needs plane Couette flow"),
    // The same shear in other axes, in which eq. 13 holds no more.
    (EXTENSION, "[[-0.5, 0, 0], [0, 1, 0], [0, 0, -0.5]]", "[[0, 1, 0], [0, 0, 0], [0, 0, 0]]\n[output]\nobservables = \
        [\"orbit_constant\"]",
     "5: output.observables = [\"orbit_constant\"] is not allowed: orbit_constant needs plane Couette flow"),
    // Flows one after another.
    (REVERSED, "strain = 3, ", "", "3: flow.steps.strain is missing: expected a finite number > 0"),
    (REVERSED, "strain = 3", "strain = -3", "3: flow.steps.strain = -3 is not allowed: expected a finite number > 0"),
    (REVERSED, "rate_per_s = 1", "rate_per_s = 0", "3: flow.steps.shear_rate_per_s = 0 is not allowed: expected a \
        finite number other"),
    (REVERSED, "strain = 3, ", "strain = 3, shear_rate_per_s = 1, ", "3: flow.steps.shear_rate_per_s = 1 is not \
        allowed: either it or"),
    (REVERSED, "[-1, 0, 0]", "[-1, 0]", "3: flow.steps.gradient_per_s = [[0, 0, 0], [-1, 0], [0, 0, 0]] is not \
        allowed: expected three"),
    (REVERSED, "[-1, 0, 0]", "[0, 0, 0]", "3: flow.steps.gradient_per_s = [[0, 0, 0], [0, 0, 0], [0, 0, 0]] is not \
        allowed: expected three"),
    (REVERSED, "strain = 3", "strain = 3, periods = 1", "3: flow.steps.periods = 1 is not allowed: strain, shear_rate"),
    (REVERSED, "strain = 5", "strain = 6", "10: time.strain = 6 is not allowed: at most 5, the strain of all \
        flow.steps"),
    (REVERSED, "strain = 5", "periods = 1", "10: time.periods = 1 is not allowed: no periods where one flow follows"),
    (REVERSED, "rate_per_s = 1", "rate_per_s = 1e-310", "3: flow.steps = [{ shear_rate_per_s = 1e-310, strain = 2 }, "),
    (REVERSED, "[time]", "[interaction]\nalpha = 1\nconcentration_per_cm3 = 1\n[time]", "3: flow.steps = "),
    (REVERSED, "strain = 5", "strain = 5\n[output]\nobservables = [\"orbit_constant\"]",
     "12: output.observables = [\"orbit_constant\"] is not allowed: orbit_constant needs plane Couette flow"),
    // Boxes and lengths.
    (INTERACTING, "concentration_per_cm3 = 50", "",
     "10: interaction.concentration_per_cm3 is missing: concentration_per_cm3, box_mm or particles.volume_fraction must"),
    (INTERACTING, "concentration_per_cm3 = 50", "concentration_per_cm3 = 33.4\nbox_mm = [12, 5, 5]",
     "11: interaction.concentration_per_cm3 = 33.4 is not allowed: either it or box_mm, or both where they agree to \
      1e-3: 10 rods in [12.0, 5.0, 5.0] mm are 33.333"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [12, 5]",
     "11: interaction.box_mm = [12, 5] is not allowed: expected [H1, H2, H3], three finite numbers > 0"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [12, 5, 5, 5]", "11: interaction.box_mm = [12, 5, 5, 5] is not"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [12, 5, 0]", "11: interaction.box_mm = [12, 5, 0] is not"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [12, 5, nan]", "11: interaction.box_mm = [12, 5, nan] is not"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = \"cube\"", "11: interaction.box_mm = \"cube\" is not"),
    (INTERACTING, "concentration_per_cm3 = 50", "box_mm = [1e-300, 1e-300, 1e-300]",
     "11: interaction.box_mm = [1e-300, 1e-300, 1e-300] is not allowed: lengths for which the sides over the rods'"),
    (INTERACTING, "aspect_ratio_sd_percent = 3.6", "length_sd_percent = 33.4",
     "8: particles.length_sd_percent = 33.4 is not allowed: expected a number below 33.3333: with more, lengths ≤ 0"),
    (INTERACTING, "aspect_ratio_sd_percent = 3.6", "length_sd_percent = -1",
     "8: particles.length_sd_percent = -1 is not allowed: expected a finite number ≥ 0"),
    // Rods that diffuse.
    (INTERACTING, "aspect_ratio_sd_percent = 3.6", "rotary_diffusion_per_s = 0.1",
     "8: particles.rotary_diffusion_per_s = 0.1 is not allowed: 0, as rods with an [interaction] table do not diffuse"),
    (REVERSED, "aspect_ratio = 11.6", "aspect_ratio = 11.6\nrotary_diffusion_per_s = 0.1",
     "8: particles.rotary_diffusion_per_s = 0.1 is not allowed: 0, as rods in flow.steps do not diffuse"),
    // Times.
    (INTERACTING, "periods = 1", "periods = 1\nseconds = 2",
     "17: time.periods = 1 is not allowed: either periods or seconds, not both"),
    (EXTENSION, "strain = 2", "strain = 2\nseconds = 2",
     "10: time.strain = 2 is not allowed: either strain or seconds, not both"),
    (EXTENSION, "strain = 2", "seconds = 2",
     "11: time.outputs_per_strain = 10 is not allowed: goes with strain; seconds take outputs_per_second"),
    (INTERACTING, "outputs_per_period = 10", "outputs_per_second = 2",
     "19: time.outputs_per_second = 2 is not allowed: goes with seconds; periods take outputs_per_period"),
    (INTERACTING, "rods_at", "times = [0.5]\nrods_at",
     "19: time.outputs_per_period = 10 is not allowed: either it or output.times, not both"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.5, 1.5]",
     "16: output.times = [0.5, 1.5] is not allowed: up to 1e6 times within the run, which ends at time.periods = 1"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.5, 0.25]",
     "16: output.times = [0.5, 0.25] is not allowed: expected a list of finite numbers ≥ 0 that grow"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.125, 0.5]",
     "16: output.times = [0.125, 0.5] is not allowed: interacting rods need different times on their steps, k/100; 0.125 \
      is not one of them: set steps_per_period"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.5, 0.50000001]",
     "16: output.times = [0.5, 0.50000001] is not allowed: interacting rods need different times on their steps, k/100; \
      0.50000001 is not one of them"),
    (STEPPED, "= 100", "= 100\n[output]\ntimes = [0.5]\nrods_at = [0.25]",
     "17: output.rods_at = [0.25] is not allowed: different output times, of output.times; 0.25 is not one of them"),
    (STEPPED, "periods = 1\nsteps_per_period = 100", "steps_per_second = 2",
     "12: time.periods is missing: periods, strain or seconds must be given"),
    // What is no TOML.
    (INTERACTING, "alpha = 0.5", "alpha =", "12: alpha =: "),
    (INTERACTING, "alpha = 0.5", "alpha = 0.5.1", "12: alpha = 0.5.1: "),
    (INTERACTING, "alpha = 0.5", "alpha", "12: alpha: key with no value, expected `=`"),
    (INTERACTING, "alpha = 0.5", "alpha = 0.5\nalpha = 0.5", "13: alpha = 0.5: duplicate key"),
    (INTERACTING, "[time]", "[flow]", "16: [flow]: duplicate key"),
    (INTERACTING, "[time]", "[time", "16: [time: unclosed table, expected `]`"),
    (INTERACTING, "title = \"t\"", "title = \"t", "1: title = \"t: "),
];

#[test]
fn any_other_mistake_is_named_with_its_line() {
    for (scene, part, replacement, start) in OTHER_MISTAKES {
        assert!(scene.contains(part), "{part}");
        let refusal = refusal(&scene.replacen(part, replacement, 1));
        assert!(refusal.starts_with(&format!("dir/s.toml:{start}")), "{start}\n{refusal}");
        assert_eq!(refusal.lines().count(), 1, "{refusal}");
    }
}
