//! Tensor codes with a closure: named on the exact problems with what it costs, and right to 10⁻¹⁰ on their own.

use crate::grading::{answers, problem, text, write};
use shearbed::nalgebra::Matrix3;
use shearbed_validation::methods::integrators::rk4;
use shearbed_validation::methods::tensors::fourth::PAIRS;
use shearbed_validation::methods::textbook::tensors::{Closure, Code, determinant, hybrid, hybrid_by, quadratic};
use shearbed_validation::oracle::diffusion::{Motion, Start, at};

type M = Matrix3<f64>;

/// A step of a rate.
type Step = fn(&dyn Fn(M) -> M, M, f64) -> M;

/// The rows of a problem by RK4 with steps of about 0.01 of strain.
fn answer(name: &str, c_i: f64, closure: Closure) -> Vec<Vec<String>> {
    answer_by(|rate, a, h| rk4(rate, a, h), 0.01, name, c_i, closure)
}

/// The rows of a problem with steps of about `strain`; late times end at a strain of 600.
fn answer_by(step: Step, strain: f64, name: &str, c_i: f64, closure: Closure) -> Vec<Vec<String>> {
    const G: f64 = 0.5;
    let (_, mut rows) = problem(name);
    let (code, l) = (Code { shape: |_| 1.0, ..Code::right(closure) }, [[0.0; 3], [G, 0.0, 0.0], [0.0; 3]]);
    let rate = |a: M| M::from(code.rate(&a.into(), &l, 1.0, [c_i, f64::NAN]));
    let (mut a, mut now) = (M::identity() / 3.0, 0.0);
    for row in rows.iter_mut().skip(1) {
        let time: f64 = row[0].parse::<f64>().unwrap().min(1200.0);
        let steps = ((time - now) * G / strain).ceil();
        let h = (time - now) / steps;
        a = (0..steps as usize).fold(a, |a, _| step(&rate, a, h));
        now = time;
        for (at, place) in PAIRS.into_iter().enumerate() {
            row[1 + at] = format!("{:e}", a[place]);
        }
    }
    rows
}

#[test]
fn the_closure_of_a_program_is_named_with_its_cost() {
    let dir = tempfile::tempdir().unwrap();
    let of = |name: &str, rows: Vec<Vec<String>>| write(dir.path(), name, "answer.csv", text(&rows));
    let (shear, weak, steady) =
        ("folgar-tucker-shear-0.01", "folgar-tucker-shear-0.001", "folgar-tucker-steady-shear-0.01");
    of(shear, answer(shear, 0.01, quadratic));
    of(weak, answer(weak, 0.001, quadratic));
    of(steady, answer(steady, 0.01, hybrid));
    let ended = answers(dir.path());
    for (name, closure, cost) in [
        (shear, "the quadratic closure, to ", "; it costs +1."),
        (weak, "the quadratic closure, to ", "; it costs +"),
        (steady, "the hybrid closure, to ", " in a22 once steady"),
    ] {
        assert_eq!(ended.verdict(name), "FAIL");
        let said = ended.diagnosis(name);
        assert!(said.starts_with(&format!("this is the curve of {closure}")) && said.contains(cost), "{said}");
        assert!(!said.contains(" or of "), "{said}");
    }
    let overall = "one mistake explains 2 of 3 that do not pass: the quadratic closure";
    assert!(ended.words.contains(overall), "{}", ended.words);
}

/// Too coarse for the tolerance, but at its order: right, if what it converges to is.
#[test]
fn steps_that_converge_to_the_certified_answer_pass() {
    let name = "closed-ft-quadratic-0.01";
    let of = |c_i: f64| {
        let dir = tempfile::tempdir().unwrap();
        let midpoint: Step = |rate, a, h| a + h * rate(a + 0.5 * h * rate(a));
        for steps in [320, 640, 1280, 2560] {
            let rows = answer_by(midpoint, 20.0 / f64::from(steps), name, c_i, quadratic);
            write(dir.path(), name, &format!("steps-{steps}.csv"), text(&rows));
        }
        answers(dir.path())
    };
    let right = of(0.01);
    let (error, tolerance) = (right.of(name)["error"].as_f64(), right.of(name)["tolerance"].as_f64());
    assert!(right.verdict(name) == "PASS" && error > tolerance, "{}", right.words);
    assert!(right.words.contains("converges to the certified answer at order 2.0"), "{}", right.words);
    assert_eq!(of(0.0101).verdict(name), "FAIL");
}

#[test]
fn a_coefficient_that_is_off_is_named_and_half_a_closure_is_not() {
    let dir = tempfile::tempdir().unwrap();
    let name = "folgar-tucker-shear-0.01";
    let said = |rows: Vec<Vec<String>>| {
        write(dir.path(), name, "answer.csv", text(&rows));
        answers(dir.path()).of(name)["diagnosis"].clone()
    };
    let half = said(answer(name, 0.005, hybrid));
    // γ̇ = 0.5/s: its square is half of it.
    let expected = "this is the curve of 2D:D for γ̇, with the hybrid closure or of half the C_I (C_I γ̇ (δ − 3a), \
        without the 2, or γ̇ = (D:D/2)^½), with the hybrid closure, to ";
    assert!(half.as_str().unwrap().starts_with(expected), "{half}");
    assert_eq!(
        said(answer(name, 0.01, |a, at| hybrid_by(a, at, 0.5 - 13.5 * determinant(a)))),
        serde_json::Value::Null
    );
}

#[test]
fn a_right_tensor_code_passes_its_closed_problem_and_another_closure_fails_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let (own, other) = ("closed-ft-quadratic-0.01", "closed-ft-hybrid-0.01");
    write(dir.path(), own, "answer.csv", text(&answer(own, 0.01, quadratic)));
    write(dir.path(), other, "answer.csv", text(&answer(other, 0.01, quadratic)));
    let ended = answers(dir.path());
    assert_eq!((ended.verdict(own), ended.verdict(other)), ("PASS", "FAIL"), "{}", ended.words);
    assert!(ended.of(own)["error"].as_f64() < Some(1e-10));
    let said = ended.diagnosis(other);
    assert!(said.starts_with("this is the curve of the quadratic closure, to ") && !said.contains("costs"), "{said}");
    // The distribution itself, as the exact problem has it at the same times.
    let (_, mut exact) = problem("folgar-tucker-shear-0.01");
    exact[0] = problem(other).1[0].clone();
    write(dir.path(), other, "answer.csv", text(&exact));
    let ended = answers(dir.path());
    let expected = "this is the curve of the distribution, without a closure, to ";
    assert!(ended.diagnosis(other).starts_with(expected), "{}", ended.words);
}

/// Brownian rods: a right code passes, one with a wrong diffusivity fails by name, at rest and in shear.
#[test]
fn a_wrong_diffusivity_of_brownian_rods_is_named() {
    let (rest, shear) = ("brownian-relaxation", "brownian-startup-pe-10");
    let graded = |factor: f64, shear_rate_per_s: f64| {
        let dir = tempfile::tempdir().unwrap();
        let (_, mut rows) = problem(rest);
        for row in rows.iter_mut().skip(1) {
            // a − 1/3 fades as e^{−6D_r t}, D_r = 0.25/s.
            let fades = (-1.5 * factor * row[0].parse::<f64>().unwrap()).exp();
            for (k, start) in [(1, 0.5), (2, 0.5), (3, 0.0)] {
                row[k] = (1.0 / 3.0 + (start - 1.0 / 3.0) * fades).to_string();
            }
        }
        write(dir.path(), rest, "answer.csv", text(&rows));
        let (_, mut rows) = problem(shear);
        let times: Vec<f64> = rows[1..].iter().map(|row| row[0].parse().unwrap()).collect();
        let rods = Motion::diffusing([[0.0; 3], [shear_rate_per_s, 0.0, 0.0], [0.0; 3]], 10.0, 0.05 * factor);
        for (row, means) in rows.iter_mut().skip(1).zip(at(&rods, Start::Isotropic, &times).unwrap()) {
            row.iter_mut().skip(1).zip(means.second).for_each(|(field, x)| *field = x.to_string());
        }
        write(dir.path(), shear, "answer.csv", text(&rows));
        answers(dir.path())
    };
    let right = graded(1.0, 0.5);
    assert_eq!([rest, shear].map(|name| right.verdict(name)), ["PASS"; 2], "{}", right.words);
    // D_r stays what it is in another flow.
    let slow = graded(1.0, 0.25);
    assert_eq!(slow.verdict(rest), "PASS");
    assert!(slow.diagnosis(shear).starts_with("this is the curve of half the shear rate, to "), "{}", slow.words);
    for (factor, words) in [(2.0, "twice the D_r"), (0.5, "half the D_r or of the distribution with D_r γ̇")] {
        let wrong = graded(factor, 0.5);
        for name in [rest, shear] {
            let said = wrong.diagnosis(name);
            let words = if name == rest { &words[..words.find(" or").unwrap_or(words.len())] } else { words };
            assert_eq!(wrong.verdict(name), "FAIL");
            assert!(said.starts_with(&format!("this is the curve of the distribution with {words}")), "{said}");
        }
    }
}
