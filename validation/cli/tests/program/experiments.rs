//! Experiments without points, and with synthetic ones: made here from the model itself with another seed, read off
//! with noise of known size, and written where only these tests look.

use crate::common::bounded::Bounded;
use crate::common::{Folder, command, empty_folder};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;
use serde_json::Value;
use shearbed::Plan;
use shearbed::run::ensemble;
use shearbed_validation::input::experiment::{ANCZUROWSKI, OKAGAWA_MASON, Runs};
use shearbed_validation::input::{experiment, scenes};
use std::fs;
use std::path::Path;

/// One standard deviation of reading off, in T and in the rod's length.
const U_X: f64 = 0.004;
const U_Y: f64 = 0.005;
/// Rods of the synthetic experiment: 2000 would leave free rods, a control, uncaught at r_e = 14.2.
const RODS: u64 = 10_000;

/// Times at which curves are read off, each a twentieth of a period after the one before.
const TIMES: usize = 15;

/// A synthetic experiment: the scene at this α, read off at these times.
fn synthesise(data: &Path, folder: &str, scene_name: &str, observables: &[&str], alpha: f64) {
    let mut scene = scenes::find(scene_name).unwrap().scene().unwrap();
    scene.interaction.as_mut().unwrap().alpha = alpha;
    scene.time.duration = 0.8;
    scene.time.outputs_per_unit = Some(200);
    scene.ensemble.replicas = RODS / scene.particles.count as u64;
    scene.ensemble.seed = 1982;
    let results = ensemble::run(&Plan::new(&scene).unwrap()).unwrap();
    let mut stream = Pcg64Dxsm::seed_from_u64(4);
    let mut noise = |u: f64| -> f64 {
        let unit: f64 = StandardNormal.sample(&mut stream);
        u * unit
    };
    let mut lines = vec![observables.iter().map(|name| format!("{name},")).collect::<Vec<_>>().join(",")];
    lines.push(vec!["X,Y"; observables.len()].join(","));
    for k in 1..=TIMES {
        let output = 10 * k;
        let cells = observables.iter().map(|name| {
            let y = results.column(name).unwrap().mean[output];
            format!("{:.5},{:.5}", results.times[output] + noise(U_X), y + noise(U_Y))
        });
        lines.push(cells.collect::<Vec<_>>().join(","));
    }
    let curves = observables
        .iter()
        .map(|name| format!("[[curve]]\nscene = \"{scene_name}\"\nobservable = \"{name}\"\ndataset = \"{name}\"\n"));
    let provenance = format!(
        r#"paper = "synthetic: no experiment, made by a test from the model with alpha = {alpha}"
figure = "synthetic"
digitised_by = "a test"
tool = "a random stream"
date = "2000-01-01"
csv = "webplotdigitizer"
rods = {RODS}
[x]
quantity = "t_over_T"
calibration = [0, 1.5]
standard_uncertainty = {U_X}
[y]
quantity = "fraction"
calibration = [0, 1]
standard_uncertainty = {U_Y}
{}"#,
        curves.collect::<String>()
    );
    let folder = data.join(folder);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join(format!("{scene_name}.toml")), provenance).unwrap();
    fs::write(folder.join(format!("{scene_name}.csv")), lines.join("\n")).unwrap();
}

/// A folder with a synthetic Fig. 4 of this α.
fn okagawa(scenes: &[&str], alpha: f64) -> Folder {
    let dir = empty_folder();
    for scene in scenes {
        synthesise(dir.path(), "okagawa-mason-1973", scene, &["x1"], alpha);
    }
    dir
}

/// Runs the program on a case in a folder of its own: its exit code, and the case and the summary of its report.
fn validate(case: &str, data: &Path) -> (Option<i32>, Value, Value) {
    let dir = empty_folder();
    let code = command(dir.path(), "validate --case").arg(case).arg("--data").arg(data).ended().status.code();
    let mut report = dir.json("out/report/report.json");
    (code, report["cases"][0].take(), report["summary"].take())
}

#[test]
fn a_synthetic_experiment_of_half_is_accepted() {
    let data = okagawa(&["fig4-n50", "fig4-n100"], 0.5);
    let (code, case, summary) = validate("okagawa-mason-1973", data.path());
    assert_eq!((code, &summary["pass"]), (Some(0), &1.into()), "{case:#}");
    let of = |key: &str| case["evidence"].as_array().unwrap().iter().map(|e| e[key].to_string()).collect::<Vec<_>>();
    assert_eq!(of("verdict"), [r#""nodata""#, r#""pass""#, r#""pass""#], "{case:#}");
    let what = of("what");
    assert!(what[1..].iter().all(|what| what.contains("points of “synthetic: no experiment")), "{what:?}");
    assert!(!case["claim"].to_string().contains("measured"), "{case:#}");
}

#[test]
fn a_synthetic_experiment_of_one_is_rejected() {
    let data = okagawa(&["fig4-n50"], 1.0);
    let (code, case, summary) = validate("okagawa-mason-1973", data.path());
    assert_eq!((code, &summary["fail"]), (Some(1), &1.into()), "{case:#}");
    let verdicts: Vec<_> = case["evidence"].as_array().unwrap().iter().map(|judged| &judged["verdict"]).collect();
    // Points of n = 50 alone.
    assert_eq!(verdicts, ["nodata", "fail", "nodata"]);
}

#[test]
fn one_alpha_for_both_aspect_ratios() {
    let both = okagawa(&["fig4-n50"], 0.5);
    synthesise(both.path(), ANCZUROWSKI.folder, "fig5", &["x1", "x2", "x3"], 0.5);
    for case in ["alpha-same-for-both", "anczurowski-1967"] {
        let (code, case, _) = validate(case, both.path());
        assert_eq!((code, &case["verdict"]), (Some(0), &"pass".into()), "{case:#}");
    }
}

#[test]
fn the_alpha_of_a_synthetic_experiment_is_found() {
    let data = okagawa(&["fig4-n100"], 0.6);
    let curves = experiment::read(data.path(), &OKAGAWA_MASON).unwrap();
    let fit = experiment::alpha(&curves, |_| {}, Runs { replicas: 100, seed: 1 }).unwrap();
    assert!((fit.alpha - 0.6).abs() < 3.0 * fit.se && fit.se < 0.05, "{fit:?}");
    assert_eq!(fit.points, TIMES);
}

#[test]
fn points_for_a_picture_are_in_the_models_units() {
    assert_eq!(experiment::points_for(None, "fig5").unwrap(), []);
    let dir = empty_folder();
    synthesise(dir.path(), "anczurowski-cox-mason-1967", "fig5", &["x1", "x3"], 0.5);
    let points = experiment::points_for(Some(dir.path()), "fig5").unwrap();
    assert_eq!(points.len(), 2 * TIMES);
    assert_eq!((points[0].observable, points[TIMES].observable), ("x1", "x3"));
    assert!(points[..TIMES].windows(2).all(|pair| pair[0].x <= pair[1].x));
    assert_eq!((points[0].u_x, points[0].u_y), (U_X, U_Y));
    assert_eq!(experiment::points_for(Some(dir.path()), "fig4-n50").unwrap(), []);
}
