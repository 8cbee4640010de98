//! Every number of a run's tables, found by the heading of its column and compared with the closed form of one free rod
//! (Jeffery 1922; A.4 and A.5 of Lee & Springer 1982).

use crate::common::shearbed;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::Path;
use validation::oracle::closed_form::{angles_at, orbit_constant_from_angles, period_s};

const R: f64 = 11.6;
const RATE_PER_S: f64 = 0.5;
const START_DEG: [f64; 2] = [31.0, 67.0];

/// Three rods alike, in plane Couette flow.
const COUETTE: &str = r#"title = "Rods alike"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 3
length_mm = 0.72
aspect_ratio = 11.6
orientation = { phi_deg = 31, theta_deg = 67 }
[time]
periods = 1.5
outputs_per_period = 12
[output]
observables = ["projections", "planar_projections", "mean_angle", "orbit_constant", "orientation_tensor", "orientation_tensor_4", "particle_stress"]
rods_at = [0.25, 1]
"#;

/// A shear of the same rate in which axis 1 is along the vorticity and axis 3 along the gradient, told in strain.
const OTHER_AXES: &str = r#"title = "Rods alike, other axes"
[flow]
gradient_per_s = [[0, 0, 0], [0, 0, 0.5], [0, 0, 0]]
[particles]
count = 3
length_mm = 0.72
aspect_ratio = 11.6
orientation = { phi_deg = 31, theta_deg = 67 }
[time]
strain = 100
outputs_per_strain = 1
[output]
observables = ["projections", "planar_projections", "mean_angle", "orientation_tensor", "orientation_tensor_4"]
rods_at = [40]
"#;

/// Where the rods are, and how long it took.
struct State {
    time_s: f64,
    p: [f64; 3],
    c_b: f64,
}

fn direction([phi, theta]: [f64; 2]) -> [f64; 3] {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// The closed form at `time_s`, of rods that start along `p` with axis 1 along the gradient.
fn turned(p: [f64; 3], time_s: f64) -> State {
    let (phi0, theta0) = (p[1].atan2(p[0]), p[2].acos());
    let (phi, theta) = angles_at(phi0, theta0, R, time_s / period_s(RATE_PER_S, R));
    let c = orbit_constant_from_angles(phi, theta, R);
    State {
        time_s,
        p: direction([phi, theta]),
        c_b: c / (1.0 + c),
    }
}

fn couette(time_s: f64) -> State {
    turned(direction(START_DEG.map(f64::to_radians)), time_s)
}

/// Jeffery's equation keeps its form where two axes are exchanged.
fn other_axes(time_s: f64) -> State {
    let exchanged = |[p1, p2, p3]: [f64; 3]| [p3, p2, p1];
    let state = turned(exchanged(direction(START_DEG.map(f64::to_radians))), time_s);
    State {
        p: exchanged(state.p),
        ..state
    }
}

/// What stands under a heading; `None` where there is no closed form by this name.
fn expected(heading: &str, state: &State) -> Option<f64> {
    let [p1, p2, p3] = state.p;
    let product = |axes: &str| {
        let axes = axes
            .chars()
            .map(|axis| axis.to_digit(10).map(|axis| axis as usize - 1));
        axes.map(|axis| axis.map(|axis| state.p[axis]))
            .product::<Option<f64>>()
    };
    Some(match heading {
        "t_over_T" => state.time_s / period_s(RATE_PER_S, R),
        "time_s" => state.time_s,
        "strain" => RATE_PER_S * state.time_s,
        "aspect_ratio" => R,
        "collided" => 0.0,
        "p1" => p1,
        "p2" => p2,
        "p3" => p3,
        "x1" => p1.abs(),
        "x2" => p2.abs(),
        "x3" => p3.abs(),
        "x1x2" => p1.hypot(p2),
        "x2x3" => p2.hypot(p3),
        "x1x3" => p1.hypot(p3),
        // Folded into [0, π/2].
        "phi" => FRAC_PI_2 - p1.abs().atan2(p2.abs()),
        "c_b" => state.c_b,
        "s12_per_mu_fiber_g" => p1 * p1 * p2 * p2,
        "n1_per_mu_fiber_g" => p1 * p2 * (p2 * p2 - p1 * p1),
        "n2_per_mu_fiber_g" => p1 * p2 * (p1 * p1 - p3 * p3),
        _ => match heading.split_at_checked(1)? {
            // Rods are alike: nothing scatters but the last digits.
            _ if heading.ends_with("_se") => 0.0,
            ("a", axes) => product(axes)?,
            _ => {
                let from: f64 = heading.strip_prefix("density_from_")?.parse().ok()?;
                let bin = (20.0 * from).round() / 20.0;
                if (bin..bin + 0.05).contains(&state.c_b) {
                    20.0
                } else {
                    0.0
                }
            }
        },
    })
}

/// Angles of 2·10⁻¹⁵ r_e (the closed form) and of 4ε r_e (degrees), twice for both sides, in products of four.
const ALLOWED: f64 = 4.0 * 2.0 * R * (2e-15 + 4.0 * f64::EPSILON);
/// Standard errors of equal rods: the root of what rounding leaves of a difference of squares.
const SCATTER: f64 = 1e-7;

/// What is off, and how many numbers there are. `time_s` is the time of each row.
fn wrong(table: &str, time_s: impl Fn(usize) -> f64, state: fn(f64) -> State) -> (Vec<String>, usize) {
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let headings: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let (mut wrong, mut numbers) = (Vec::new(), 0);
    for (k, row) in reader.records().enumerate() {
        let state = state(time_s(k));
        for (heading, cell) in headings.iter().zip(&row.unwrap()) {
            // Free rods have no place; which replica and rod it is, is for the tests of rods.csv.
            if ["replica", "rod", "x1_mm", "x2_mm", "x3_mm"].contains(&heading.as_str()) {
                continue;
            }
            let expected = expected(heading, &state).unwrap_or_else(|| panic!("{heading}: unknown"));
            let off = (cell.parse::<f64>().unwrap() - expected).abs();
            let allowed = if heading.ends_with("_se") {
                SCATTER
            } else {
                ALLOWED * expected.abs().max(1.0)
            };
            numbers += 1;
            // A number that is none is off.
            if off.is_nan() || off > allowed {
                wrong.push(format!("{heading} in row {k}: {cell}, expected {expected}"));
            }
        }
    }
    (wrong, numbers)
}

/// The tables that a scene's run writes.
fn tables(scene: &str) -> BTreeMap<String, String> {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("alike.toml"), scene).unwrap();
    let ended = shearbed(dir.path(), "run alike.toml --out out --quiet");
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let files = fs::read_dir(dir.path().join("out"))
        .unwrap()
        .map(|file| file.unwrap().path());
    let stem = |path: &Path| path.file_stem().unwrap().to_str().unwrap().to_owned();
    files
        .filter(|path| path.extension().is_some_and(|end| end == "csv"))
        .map(|path| (stem(&path), fs::read_to_string(&path).unwrap()))
        .collect()
}

#[test]
fn every_number_of_plane_couette_flow_is_that_of_the_closed_form() {
    let tables = tables(COUETTE);
    assert_eq!(tables.len(), 8);
    let period_s = period_s(RATE_PER_S, R);
    for (name, table) in &tables {
        // Of rods.csv three rows are of one time.
        let at = |k: usize| match name.as_str() {
            "rods" => [0.25, 1.0][k / 3] * period_s,
            _ => k as f64 / 12.0 * period_s,
        };
        let (wrong, numbers) = wrong(table, at, couette);
        assert!(wrong.is_empty(), "{name}: {wrong:?}");
        let rows = if name == "rods" { 6 } else { 19 };
        assert!(
            numbers >= 5 * rows && numbers.is_multiple_of(rows),
            "{name}: {numbers}"
        );
    }
}

#[test]
fn every_number_of_a_shear_of_other_axes_is_that_of_the_closed_form() {
    let tables = tables(OTHER_AXES);
    assert_eq!(tables.len(), 6);
    for (name, table) in &tables {
        let at = |k: usize| match name.as_str() {
            "rods" => 40.0 / RATE_PER_S,
            _ => k as f64 / RATE_PER_S,
        };
        let (wrong, numbers) = wrong(table, at, other_axes);
        assert!(wrong.is_empty(), "{name}: {wrong:?}");
        let rows = if name == "rods" { 3 } else { 101 };
        assert!(
            numbers >= 4 * rows && numbers.is_multiple_of(rows),
            "{name}: {numbers}"
        );
    }
}

#[test]
fn a_table_with_a_mistake_does_not_pass() {
    let tables = tables(COUETTE);
    let table = &tables["orientation_tensor"];
    let period_s = period_s(RATE_PER_S, R);
    let seen = |table: &str| !wrong(table, |k| k as f64 / 12.0 * period_s, couette).0.is_empty();
    let renamed = |from: &str, to: &str| {
        let (head, rows) = table.split_once('\n').unwrap();
        format!(
            "{}\n{rows}",
            head.replace(from, "kept").replace(to, from).replace("kept", to)
        )
    };
    assert!(!seen(table));
    for (from, to) in [
        ("time_s", "strain"),
        ("t_over_T", "strain"),
        ("a11,a11_se", "a22,a22_se"),
        ("a12", "a13"),
        ("a33,", "a33_se,"),
    ] {
        assert_ne!(renamed(from, to), *table, "{from}, {to}");
        assert!(seen(&renamed(from, to)), "{from} and {to} exchanged");
    }
    let mut lines: Vec<_> = table.lines().collect();
    lines.swap(2, 3);
    assert!(seen(&lines.join("\n")), "two rows exchanged");
    lines.swap(2, 3);
    lines.remove(5);
    assert!(seen(&lines.join("\n")), "a row left out");
    let rods = &tables["rods"];
    let seen = |table: &str| {
        !wrong(table, |k| [0.25, 1.0][k / 3] * period_s, couette)
            .0
            .is_empty()
    };
    assert!(!seen(rods));
    assert!(seen(&rods.replacen("p1,p2", "p2,p1", 1)));
    assert!(seen(&rods.replacen("time_s,strain", "strain,time_s", 1)));
}
