//! Programs that nobody here wrote, and small ones in other languages, graded as a user would. What cannot run here is
//! skipped by name and reason in one line, and recorded answers (`validation/peers/recorded`) are graded in its place.

use crate::bounded::{ANSWER_S, Bounded};
use crate::grading::{Graded, REFERENCE, files, graded, names, some};
use crate::programs::{peers, python, run, runs, skipped};
use serde_json::Value;
use std::path::Path;

#[test]
fn numpy_rk4_passes_with_order_4_and_euler_fails_with_order_1() {
    let script = peers().join("numpy_rk4.py");
    let dir = tempfile::tempdir().unwrap();
    let mine = match python("numpy") {
        Some(python) => {
            run(&python, &[&script, REFERENCE.path(), dir.path()]);
            dir.path().to_owned()
        }
        None => {
            skipped("numpy_rk4.py", "no python3 with numpy");
            peers().join("recorded/numpy_rk4")
        }
    };
    let rk4 = files(REFERENCE.path(), &mine);
    assert_eq!(rk4.code, Some(0), "{}", rk4.words);
    for name in ["mid-flip-2", "mid-flip-11.6", "isotropic-11.6"] {
        assert_eq!(rk4.verdict(name), "PASS", "{}", rk4.words);
        assert!((rk4.order(name) - 4.0).abs() < 0.2, "{name}: {}", rk4.words);
    }
    let Some(python) = python("numpy") else { return };
    // It has no rods that collide or diffuse, and no closures.
    let kinds = ["lee-springer", "folgar-tucker", "brownian", "closed", "closure", "dadt", "turning"];
    let others = |name: &&String| kinds.iter().any(|kind| name.starts_with(kind));
    for name in &names() {
        let expected = if others(&name) { "MISSING" } else { "PASS" };
        assert_eq!(rk4.verdict(name), expected, "{name}: {}", rk4.words);
    }
    let mine = dir.path().join("euler");
    run(&python, &[&script, REFERENCE.path(), &mine, Path::new("--euler")]);
    let euler = files(REFERENCE.path(), &mine);
    assert_eq!(euler.code, Some(1));
    // Whatever moves; contacts and formulas take no steps.
    let still = ["log-rolling", "contact-rule", "contact-angles"];
    let still = |name: &str| still.contains(&name) || name.starts_with("pdot");
    for name in names().iter().filter(|name| !others(name)) {
        let expected = if still(name) { "PASS" } else { "FAIL" };
        assert_eq!(euler.verdict(name), expected, "{}", euler.words);
        assert_eq!(euler.diagnosis(name), "", "Euler's is no known mistake: {}", euler.words);
        // It steps over every flip of these.
        let diverges = ["mid-flip-10000", "ten-thousand-periods"].contains(&name.as_str());
        if expected == "FAIL" && !diverges {
            // With half the steps it is off by twice as much: above 0.1 rad it does not follow the motion, and no order
            // is read.
            let follows = 2.0 * euler.of(name)["error"].as_f64().unwrap() < 0.1;
            let order = euler.order(name);
            let right = if follows { (order - 1.0).abs() < 0.2 } else { order.is_nan() };
            assert!(right, "{name}: {}", euler.words);
        }
    }
    let live = format!("'{python}' '{}' --live", script.display());
    let live = graded(&["--command", &live, "--brief", "--order", "4", "--timeout", ANSWER_S]);
    assert_eq!(live.code, Some(0), "{}", live.words);
}

/// The suspension that `bench --case cost-of-accuracy` times, against the core's: 40 replicas of 100 rods know X̄₁ to
/// 0.006, and a right one is 4.5 standard errors off at one seed in 10⁵; without collisions X̄₁ is ½.
#[test]
fn a_suspension_in_numpy_has_the_mean_of_the_core() {
    use shearbed_validation::judge::statistics::Sample;
    let Some(python) = python("numpy") else {
        return skipped("numpy_suspension.py", "no python3 with numpy");
    };
    let code = std::fs::read_to_string(peers().join("numpy_suspension.py")).unwrap();
    let answer = |code: &str, replicas: &str| {
        let output = std::process::Command::new(&python)
            .args(["-c", code, replicas, "50", "1"])
            .envs(crate::programs::ONE_THREAD)
            .ended();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
        let x1: Vec<_> = answer["x1"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        Sample::of(&x1)
    };
    let mut scene =
        shearbed::Scene { interaction: Some(shearbed::scene::Interaction::default()), ..shearbed::Scene::default() };
    scene.time.duration = 2.0;
    scene.time.outputs_per_unit = Some(1);
    scene.time.steps_per_unit = Some(50);
    scene.ensemble.replicas = 400;
    let core = shearbed::run::ensemble::run(&shearbed::Plan::new(&scene).unwrap()).unwrap();
    let core = core.column("x1").unwrap();
    let (mean, se) = (core.mean.last().unwrap(), core.se.last().unwrap());
    let off = |found: Sample| (found.mean - mean).abs() / found.se.hypot(*se);
    let (right, free) = (
        off(answer(&code, "40")),
        off(answer(
            &code.replace(
                "N, G, LENGTH, R_E, ALPHA, M, PER_MM3 = 100, 0.5, 0.72, 11.6, 0.5,",
                "N, G, LENGTH, R_E, ALPHA, M, PER_MM3 = 100, 0.5, 0.72, 11.6, 0.0,",
            ),
            "10",
        )),
    );
    assert!(right < 4.5 && free > 10.0, "{right} {free}");
}

#[test]
fn c_compiled_with_cc_passes_with_order_4() {
    if !runs("cc", &["--version"]) {
        return skipped("c_rk4.c", "no cc");
    }
    let dir = tempfile::tempdir().unwrap();
    let program = dir.path().join("c_rk4");
    run("cc", &[Path::new("-O2"), Path::new("-o"), &program, &peers().join("c_rk4.c"), Path::new("-lm")]);
    let command = format!("'{}'", program.display());
    let some = ["mid-flip-11.6", "poles", "spiral"].map(|name| ["--problem", name]);
    let asked = ["--command", &command, "--order", "4", "--timeout", ANSWER_S];
    let found = graded(&[&asked[..], some.as_flattened()].concat());
    assert_eq!(found.code, Some(0), "{}", found.words);
    assert!((found.order("mid-flip-11.6") - 4.0).abs() < 0.2);
    let live = &found.grade.as_ref().unwrap()["live"];
    for title in ["Error against steps, mid-flip-11.6", "Error against run time, one rod"] {
        assert!(found.html.as_ref().unwrap().contains(title), "{title}");
    }
    assert!(live["work_precision"]["pipe_s"].as_f64().is_some_and(|seconds| seconds > 0.0), "{}", found.words);
    // As the project's own RK4 in p: the longest step with which every rod of r_e = 11.6 turns.
    let limits = live["limits"].as_array().unwrap();
    let turning = limits.iter().find(|limit| limit["property"] == "turning" && limit["aspect_ratio"] == 11.6).unwrap();
    let own = own_turning_limit();
    assert!((turning["strain"]["at"].as_f64().unwrap() / own - 1.0).abs() < 1e-3, "{turning} {own}");
}

/// The limit of the project's own RK4 in p, by the same steps.
fn own_turning_limit() -> f64 {
    use shearbed_validation::methods::integrators::limits::{Ladder, Limit, Property, longest_on};
    let all = shearbed_validation::studies::integrators::all();
    let rk4 = all.iter().find(|integrator| integrator.name == "RK4 in p").unwrap();
    let ladder = Ladder { least: 0.01, most: 100.0, factor: 1.25 };
    match longest_on(ladder, rk4, Property::Turning, 11.6) {
        Limit::At(strain) => strain,
        other => panic!("{other:?}"),
    }
}

#[test]
fn javascript_has_order_2() {
    if !runs("node", &["--version"]) {
        return skipped("midpoint.js", "no node");
    }
    let script = peers().join("midpoint.js");
    let command = format!("node '{}'", script.display());
    let of = ["--problem", "mid-flip-2", "--problem", "mid-flip-11.6", "--problem", "spiral"];
    let found = graded(&[&["--command", &command, "--brief", "--order", "2", "--timeout", ANSWER_S][..], &of].concat());
    for name in ["mid-flip-2", "mid-flip-11.6", "spiral"] {
        assert!((found.order(name) - 2.0).abs() < 0.2, "{name}: {}", found.words);
        assert!(found.of(name)["length_drift"].as_f64().unwrap() < 1e-14);
    }
    let dir = tempfile::tempdir().unwrap();
    let reference = some(&dir.path().join("ref"), &["log-rolling", "mid-flip-10000"]);
    let mine = dir.path().join("mine");
    run("node", &[&script, &reference, &mine]);
    let found = files(&reference, &mine);
    assert_eq!((found.verdict("log-rolling"), found.verdict("mid-flip-10000")), ("PASS", "FAIL"), "{}", found.words);
}

/// fiberoripy 1.4.0 with SciPy's DOP853 at 10⁻¹² and its closures.
fn judge_fiberoripy(found: &Graded) {
    assert_eq!(found.code, Some(1));
    for name in ["mid-flip-2", "mid-flip-11.6"] {
        assert_eq!(found.verdict(name), "PASS", "{}", found.words);
    }
    // It claims success and has lost the fibre.
    let fibre = found.of("mid-flip-10000");
    assert!(fibre["verdict"] == "FAIL" && fibre["error"].as_f64().unwrap() > 0.01, "{fibre:#}");
    for (name, error) in CLOSURES {
        let of = found.of(name);
        assert_eq!(of["verdict"], "FAIL");
        assert!((of["error"].as_f64().unwrap() / error - 1.0).abs() < 0.01, "{name} {error}: {of:#}");
        assert_eq!(of["diagnosis"], Value::Null);
    }
}

/// By how much the IBOF closure misses a_ij of isotropic rods: recorded from fiberoripy 1.4.0, to a percent.
const CLOSURES: [(&str, f64); 2] = [("isotropic-3", 0.01503), ("isotropic-11.6", 0.09602)];

#[test]
fn fiberoripy_is_right_until_rods_are_fibres_and_its_closure_is_no_solution() {
    judge_fiberoripy(&files(REFERENCE.path(), &peers().join("recorded/fiberoripy-1.4.0")));
    let Some(python) = python("fiberoripy") else {
        return skipped("fiberoripy", "no python3 with fiberoripy: only its recorded answers were graded");
    };
    let script = peers().join("fiberoripy_peer.py");
    let dir = tempfile::tempdir().unwrap();
    // It needs minutes for the others.
    let slow = ["mid-flip-2", "mid-flip-11.6", "mid-flip-10000", "isotropic-3", "isotropic-11.6"];
    // It has no natural and no ORE closure.
    let all = names();
    let has = |name: &&String| {
        let formula = ["pdot", "closure", "dadt"].iter().any(|kind| name.starts_with(kind));
        formula && !name.ends_with("natural") && !name.ends_with("ore")
    };
    let formulas: Vec<_> = all.iter().filter(has).map(String::as_str).collect();
    let reference = some(&dir.path().join("ref"), &[&slow, &formulas[..]].concat());
    let mine = dir.path().join("mine");
    run(&python, &[&script, &reference, &mine]);
    let found = files(REFERENCE.path(), &mine);
    judge_fiberoripy(&found);
    assert!(formulas.len() > 15);
    for name in formulas {
        assert_eq!((found.verdict(name), found.diagnosis(name)), ("PASS", ""), "{}", found.words);
    }
    let command = format!("'{python}' '{}' --live", script.display());
    let of = ["--problem", "mid-flip-2", "--problem", "mid-flip-10000"];
    let live = graded(&[&["--command", &command, "--brief", "--timeout", ANSWER_S][..], &of].concat());
    assert_eq!(live.verdict("mid-flip-2"), "PASS", "{}", live.words);
    assert_eq!(live.verdict("mid-flip-10000"), "FAIL", "{}", live.words);
    let note = live.of("mid-flip-10000")["note"].as_str().unwrap();
    assert!(note.starts_with("asked for the tolerance"), "{note}");
}
