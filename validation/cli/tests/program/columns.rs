//! Every number of a run's tables, found by the heading of its column and compared with the closed form of one free rod
//! (Jeffery 1922; A.4 and A.5 of Lee & Springer 1982).

use crate::common::{empty_folder, names, read};
use shearbed_validation::oracle::closed_form::{angles_at, orbit_constant_from_angles, period_s};
use std::collections::BTreeMap;

const R: f64 = 11.6;
const RATE_PER_S: f64 = 0.5;
const START_DEG: [f64; 2] = [31.0, 67.0];

/// Three rods alike.
const RODS: &str = r#"title = "Rods alike"
[particles]
count = 3
length_mm = 0.72
aspect_ratio = 11.6
orientation = { phi_deg = 31, theta_deg = 67 }
"#;

/// A flow of [`RODS`], and what its run writes.
struct Run {
    scene: &'static str,
    /// Tables, the rows of each but rods.csv, and the fewest numbers of a row.
    tables: usize,
    rows: usize,
    numbers: usize,
    /// Between two rows.
    step_s: f64,
    /// When rods.csv has the rods.
    rods_at_s: Vec<f64>,
    state: fn(f64) -> State,
}

/// Plane Couette flow.
fn of_couette() -> Run {
    let period_s = period_s(RATE_PER_S, R);
    Run {
        scene: r#"[flow]
shear_rate_per_s = 0.5
[time]
periods = 1.5
outputs_per_period = 12
[output]
observables = ["projections", "planar_projections", "mean_angle", "cos_2phi",
    "orbit_constant", "orientation_tensor", "orientation_tensor_4", "particle_stress"]
rods_at = [0.25, 1]
"#,
        tables: 9,
        rows: 19,
        numbers: 5,
        step_s: period_s / 12.0,
        rods_at_s: vec![0.25 * period_s, period_s],
        state: couette,
    }
}

/// A shear of the same rate in which axis 1 is along the vorticity and axis 3 along the gradient, with times in strain.
fn of_other_axes() -> Run {
    Run {
        scene: r#"[flow]
gradient_per_s = [[0, 0, 0], [0, 0, 0.5], [0, 0, 0]]
[time]
strain = 100
outputs_per_strain = 1
[output]
observables = ["projections", "planar_projections", "mean_angle", "orientation_tensor", "orientation_tensor_4"]
rods_at = [40]
"#,
        tables: 6,
        rows: 101,
        numbers: 4,
        step_s: 1.0 / RATE_PER_S,
        rods_at_s: vec![40.0 / RATE_PER_S],
        state: other_axes,
    }
}

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
    State { time_s, p: direction([phi, theta]), c_b: c / (1.0 + c) }
}

fn couette(time_s: f64) -> State {
    turned(direction(START_DEG.map(f64::to_radians)), time_s)
}

/// Jeffery's equation keeps its form where two axes are exchanged.
fn other_axes(time_s: f64) -> State {
    let exchanged = |[p1, p2, p3]: [f64; 3]| [p3, p2, p1];
    let state = turned(exchanged(direction(START_DEG.map(f64::to_radians))), time_s);
    State { p: exchanged(state.p), ..state }
}

/// What stands under a heading; `None` where there is no closed form by this name.
fn expected(heading: &str, state: &State) -> Option<f64> {
    let [p1, p2, p3] = state.p;
    let product = |axes: &str| {
        let axes = axes.chars().map(|axis| axis.to_digit(10).map(|axis| axis as usize - 1));
        axes.map(|axis| axis.map(|axis| state.p[axis])).product::<Option<f64>>()
    };
    Some(match heading {
        "t_over_T" => state.time_s / period_s(RATE_PER_S, R),
        "time_s" => state.time_s,
        "strain" => RATE_PER_S * state.time_s,
        "aspect_ratio" => R,
        "length_mm" => 0.72,
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
        "phi" => p2.abs().atan2(p1.abs()),
        "cos_2phi" => (2.0 * p2.atan2(p1)).cos(),
        "c_b" => state.c_b,
        "s12_per_mu_fiber_g" => p1 * p1 * p2 * p2,
        "n1_per_mu_fiber_g" => p1 * p2 * (p2 * p2 - p1 * p1),
        "n2_per_mu_fiber_g" => p1 * p2 * (p1 * p1 - p3 * p3),
        // Rods are alike: nothing scatters.
        _ if heading.ends_with("_se") => 0.0,
        _ => match heading.strip_prefix("density_from_") {
            Some(from) => {
                let bin = (20.0 * from.parse::<f64>().ok()?).round() / 20.0;
                if (bin..bin + 0.05).contains(&state.c_b) { 20.0 } else { 0.0 }
            }
            None => product(heading.strip_prefix('a')?)?,
        },
    })
}

/// Angles of 2·10⁻¹⁵ r_e (the closed form) and of 4ε r_e (degrees), twice for both sides, in products of four.
const ALLOWED: f64 = 4.0 * 2.0 * R * (2e-15 + 4.0 * f64::EPSILON);

impl Run {
    /// The tables, by their names.
    fn written(&self) -> BTreeMap<String, String> {
        let dir = empty_folder();
        dir.write("alike.toml", RODS.to_owned() + self.scene);
        dir.runs("run alike.toml --out out --quiet");
        let out = dir.at("out");
        // Derived values are tested with their method.
        let is_derived = |name: &String| ["extremes.csv", "derived.csv"].contains(&name.as_str());
        let tables = names(&out).into_iter().filter(|name| name.ends_with(".csv") && !is_derived(name));
        tables.map(|name| (name.clone(), read(&out.join(name)))).collect()
    }

    /// What is off in a table, and how many numbers there are.
    fn wrong(&self, name: &str, table: &str) -> (Vec<String>, usize) {
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let headings: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
        let (mut wrong, mut numbers) = (Vec::new(), 0);
        for (k, row) in reader.records().enumerate() {
            // Of rods.csv three rows are of one time.
            let state = (self.state)(match name {
                "rods.csv" => self.rods_at_s[k / 3],
                _ => k as f64 * self.step_s,
            });
            for (heading, cell) in headings.iter().zip(&row.unwrap()) {
                // Free rods have no place; which replica and rod it is, is for the tests of rods.csv.
                if ["replica", "rod", "x1_mm", "x2_mm", "x3_mm"].contains(&heading.as_str()) {
                    continue;
                }
                let expected = expected(heading, &state).unwrap_or_else(|| panic!("{heading}: unknown"));
                let off = (cell.parse::<f64>().unwrap() - expected).abs();
                let allowed = if heading.ends_with("_se") { 0.0 } else { ALLOWED * expected.abs().max(1.0) };
                numbers += 1;
                // A number that is none is off.
                if off.is_nan() || off > allowed {
                    wrong.push(format!("{heading} in row {k}: {cell}, expected {expected}"));
                }
            }
        }
        (wrong, numbers)
    }

    fn check(&self) {
        let tables = self.written();
        assert_eq!(tables.len(), self.tables);
        for (name, table) in &tables {
            let (wrong, numbers) = self.wrong(name, table);
            assert!(wrong.is_empty(), "{name}: {wrong:?}");
            let rows = match name.as_str() {
                "rods.csv" => 3 * self.rods_at_s.len(),
                _ => self.rows,
            };
            assert!(numbers >= self.numbers * rows && numbers.is_multiple_of(rows), "{name}: {numbers}");
        }
    }
}

#[test]
fn every_number_of_plane_couette_flow_is_that_of_the_closed_form() {
    of_couette().check();
}

#[test]
fn every_number_of_a_shear_of_other_axes_is_that_of_the_closed_form() {
    of_other_axes().check();
}

#[test]
fn a_table_with_a_mistake_does_not_pass() {
    let run = of_couette();
    let tables = run.written();
    let table = &tables["orientation_tensor.csv"];
    let seen = |table: &str| !run.wrong("orientation_tensor.csv", table).0.is_empty();
    let renamed = |from: &str, to: &str| {
        let (head, rows) = table.split_once('\n').unwrap();
        format!("{}\n{rows}", head.replace(from, "kept").replace(to, from).replace("kept", to))
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
    let rods = &tables["rods.csv"];
    let seen = |table: &str| !run.wrong("rods.csv", table).0.is_empty();
    assert!(!seen(rods));
    assert!(seen(&rods.replacen("p1,p2", "p2,p1", 1)));
    assert!(seen(&rods.replacen("time_s,strain", "strain,time_s", 1)));
}
