//! Experiments without points, and with synthetic ones: made here from the model itself with another seed, read off
//! with noise of known size, and written where only these tests look.

use crate::common::bounded::Bounded;
use crate::common::{Folder, empty_folder};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;
use shearbed::Plan;
use shearbed::run::ensemble;
use shearbed_validation::cases;
use shearbed_validation::input::experiment::{ANCZUROWSKI, OKAGAWA_MASON, Runs};
use shearbed_validation::input::{experiment, scenes};
use shearbed_validation::judge::accept::Verdict;
use shearbed_validation::judge::case::{Effort, Outcome};
use std::fs;
use std::path::Path;
use std::process::Command;

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

fn run(case: &str, data: Option<&Path>) -> Outcome {
    let effort = Effort { data: data.map(Path::to_owned), ..Effort::gate() };
    let all = cases::all();
    all.iter().find(|found| found.about.name == case).unwrap().run(&effort)
}

/// A folder with a synthetic Fig. 4 of this α.
fn okagawa(scenes: &[&str], alpha: f64) -> Folder {
    let dir = empty_folder();
    for scene in scenes {
        synthesise(dir.path(), "okagawa-mason-1973", scene, &["x1"], alpha);
    }
    dir
}

/// Runs the program on a case in a folder of its own: its exit code, what it prints, its report.
fn validate(case: &str, data: Option<&Path>) -> (Option<i32>, String, serde_json::Value) {
    let dir = empty_folder();
    let mut command = Command::new(env!("CARGO_BIN_EXE_shearbed"));
    command.current_dir(dir.path()).args(["validate", "--case", case]);
    if let Some(data) = data {
        command.arg("--data").arg(data);
    }
    let ended = command.ended();
    let text = [ended.stdout, ended.stderr].concat();
    let report = fs::read_to_string(dir.at("out/report/report.json")).unwrap_or("null".to_owned());
    (ended.status.code(), String::from_utf8(text).unwrap(), serde_json::from_str(&report).unwrap())
}

#[test]
fn a_synthetic_experiment_of_half_is_accepted() {
    let data = okagawa(&["fig4-n50", "fig4-n100"], 0.5);
    let (code, text, report) = validate("okagawa-mason-1973", Some(data.path()));
    assert_eq!(code, Some(0), "{text}");
    assert_eq!(report["summary"]["pass"], 1);
    let evidence = report["cases"][0]["evidence"].as_array().unwrap();
    assert_eq!(evidence.len(), 2, "a scene without points is left out");
}

#[test]
fn a_synthetic_experiment_of_one_is_rejected() {
    let data = okagawa(&["fig4-n50"], 1.0);
    let (code, text, report) = validate("okagawa-mason-1973", Some(data.path()));
    assert_eq!(code, Some(1), "{text}");
    assert_eq!(report["summary"]["fail"], 1);
    let evidence = report["cases"][0]["evidence"].as_array().unwrap();
    assert!(evidence.iter().all(|judged| judged["verdict"] == "fail"));
}

#[test]
fn one_alpha_for_both_aspect_ratios() {
    let both = okagawa(&["fig4-n50"], 0.5);
    synthesise(both.path(), ANCZUROWSKI.folder, "fig5", &["x1", "x2", "x3"], 0.5);
    for case in ["alpha-same-for-both", "anczurowski-1967"] {
        let outcome = run(case, Some(both.path()));
        assert_eq!(outcome.verdict, Verdict::Pass, "{outcome:#?}");
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
fn without_points_there_is_no_verdict_and_no_failure() {
    let empty = empty_folder();
    for case in ["okagawa-mason-1973", "anczurowski-1967", "alpha-same-for-both"] {
        for data in [None, Some(empty.path())] {
            let outcome = run(case, data);
            assert_eq!(outcome.verdict, Verdict::NoData);
            assert!(outcome.controls.is_empty(), "no control is run without data");
            let (code, text, report) = validate(case, data);
            assert_eq!(code, Some(0), "{text}");
            assert!(text.contains("no data"), "{text}");
            assert_eq!((&report["summary"]["nodata"], &report["summary"]["pass"]), (&1.into(), &0.into()));
        }
    }
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

#[test]
fn a_bad_file_stops_the_program_before_any_case_runs() {
    let data = okagawa(&["fig4-n50"], 0.5);
    let csv = data.path().join("okagawa-mason-1973/fig4-n50.csv");
    let text = fs::read_to_string(&csv).unwrap();
    fs::write(&csv, text + "\n1.0,0.3x").unwrap();
    let (code, text, report) = validate("jeffery-period", Some(data.path()));
    assert_eq!((code, report), (Some(2), serde_json::Value::Null));
    assert!(text.contains("fig4-n50.csv:18: column x1 Y: `0.3x` is not allowed"), "{text}");
    assert!(!text.contains("pass"), "{text}");
}

#[test]
fn what_is_shipped_has_no_points() {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../data");
    experiment::check(&shipped).unwrap();
    for source in &experiment::SOURCES {
        assert!(shipped.join(source.folder).is_dir());
        assert_eq!(experiment::read(&shipped, source).unwrap(), []);
    }
}
