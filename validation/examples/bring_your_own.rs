//! Your own integrator, graded as those of the project are: `cargo run --release --example bring_your_own`.

use nalgebra::Vector3;
use shearbed_validation::methods::integrators::{Integrator, RodProblem, Setting, grade};
use shearbed_validation::studies::work_precision::{Budget, curve, order};

/// Heun's method: one step of length h (in 1/G) from p.
fn heun(problem: &RodProblem, p: Vector3<f64>, h: f64) -> Vector3<f64> {
    let k1 = problem.rate(&p);
    let k2 = problem.rate(&(p + h * k1));
    p + 0.5 * h * (k1 + k2)
}

fn mine() -> Integrator {
    Integrator::in_p("Heun", 2, heun)
}

fn main() {
    let mine = mine();
    let (problem, start) = RodProblem::mid_flip(11.6);
    println!("{:?}", grade(&mine, &problem, &start, Setting::Steps(4096)));
    if let Some(study) = order::study(&mine, &problem, &start, 8) {
        println!("order {:?}: {:?}", study.judged, study.found);
    }
    for point in curve(&mine, 11.6, Budget::QUICK).points {
        println!("{:<14} {:.1e} rad in {:.1e} s", point.setting.to_string(), point.error_rad(), point.seconds.least);
    }
}

#[test]
fn heun_is_of_order_2() {
    let (problem, start) = RodProblem::mid_flip(11.6);
    let study = order::study(&mine(), &problem, &start, 8).unwrap();
    assert_eq!(study.found, order::OrderVerdict::AsTheory, "{study:?}");
}
