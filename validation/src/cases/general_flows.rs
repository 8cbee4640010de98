//! The core in any flow, at any aspect ratio and strain: correct to its stated bound, or refused.

mod problems;
mod scenes;

use super::*;
use crate::oracle::exponential::Rod;
use problems::{FlowProblem, Kind, random};
use shearbed::motion::{Moved, Span};
use shearbed::plan::free_motion::MAX_ERROR_RAD;

/// A function that moves a rod and states a bound of the error.
type Motion = fn(&FlowProblem) -> Moved;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "general-flows")
            .claim(
                "In any flow, at r_e from 10⁻¹⁰⁰ to 10¹⁰⁰ and strains from 10⁻¹³ to 10⁶, a direction is off the \
                 oracle's, of hundreds of bits, by no more than the bound that comes with it; where that is above 10⁻⁶ \
                 rad, a scene is refused, and none that numbers of 106 bits can answer.",
            )
            .source("eqs 2, 3, A.1")
            .under_test(core as Motion)
            .mistake("Λ rounded to double before 1 − Λ is formed", |problem| {
                let shape = shape_factor(problem.rod.aspect_ratio);
                let rounded = ((1.0 + shape) / (1.0 - shape)).sqrt().clamp(1e-100, 1e100);
                let rod = Rod { aspect_ratio: rounded, ..problem.rod };
                core(&FlowProblem { rod, ..*problem })
            })
            .mistake("double for double-double", |problem| in_double(problem, squared_exponential))
            .mistake("|det A| ≤ 16 ε taken as planar", |problem| {
                let (a, _) = rates(problem);
                if a.determinant().abs() <= 16.0 * f64::EPSILON { in_double(problem, planar) } else { core(problem) }
            })
            .mistake("no bound, but for the oracle's own rounding", |problem| Moved { error: 0.0, ..core(problem) })
            .mistake("a bound as wide as double would need", |problem| {
                let moved = core(problem);
                let wide = moved.condition * problem.strain.max(1.0) * f64::EPSILON;
                Moved { error: moved.error.max(wide), ..moved }
            })
            .check(general_flows),
        Case::of(Judges::Core, "listed-scenes")
            .claim(
                "Scenes that were wrong once end where the oracle has them, within the error that their plan states: \
                 slow swirls to a strain of 3000, r_e = 10¹⁰⁰ and 10⁻¹⁰⁰ along an axis, flows next to shear, Couette \
                 flow turned by 45° at r_e = 10⁸, a strain of 10⁻¹³ of a rotation.",
            )
            .source("eqs 3, 15, A.1")
            .under_test(scenes::program as scenes::Run)
            .mistake("r_e longer by 10⁻⁶ of itself", |scene| {
                scenes::program(&lab::changed(scene.clone(), |scene| scene.particles.aspect_ratio *= 1.0 + 1e-6))
            })
            .mistake("nearly plane taken as plane: the flow along axis 3 left out", |scene| {
                let mut plane = scene.clone();
                if let Flow::Gradient { gradient_per_s: rows } = &mut plane.flow
                    && rows[2][2].abs() < 1e-4
                {
                    let third = rows[2][2];
                    rows.iter_mut().enumerate().for_each(|(k, row)| row[k] += if k < 2 { 0.5 * third } else { -third });
                }
                scenes::program(&plane)
            })
            .check(scenes::listed_scenes),
    ]
}

fn flow(problem: &FlowProblem) -> VelocityGradient {
    let l = problem.rod.gradient_per_s;
    VelocityGradient::new(Matrix3::from_fn(|i, j| l[i][j])).expect("finite components")
}

fn start(problem: &FlowProblem) -> UnitVector3<f64> {
    UnitVector3::new_unchecked(problem.rod.p.into())
}

fn core(problem: &FlowProblem) -> Moved {
    Propagator::general(&flow(problem), problem.rod.aspect_ratio)
        .moved(&start(problem), Span::Strain(problem.strain, 1.0))
        .expect("any flow has a strain")
}

/// L without its trace in units of the flow's largest component, and the time, in double.
fn gradient(problem: &FlowProblem) -> (Matrix3<f64>, f64) {
    let flow = flow(problem);
    let size = flow.per_s().amax();
    let l = flow.per_s() / size;
    let time = problem.strain * (size / flow.magnitude_per_s());
    (l - Matrix3::identity() * (l.trace() / 3.0), time)
}

/// A in the same units, and the time, in double.
fn rates(problem: &FlowProblem) -> (Matrix3<f64>, f64) {
    let (l, time) = gradient(problem);
    let square = problem.rod.aspect_ratio.powi(2);
    (l / (1.0 + 1.0 / square) - l.transpose() / (1.0 + square), time)
}

/// The direction by a map in double precision, with the core's bound.
fn in_double(problem: &FlowProblem, map: fn(&Matrix3<f64>, f64) -> Matrix3<f64>) -> Moved {
    let (a, time) = rates(problem);
    Moved { p: UnitVector3::new_normalize(map(&a, time) * start(problem).as_ref()), ..core(problem) }
}

fn squared_exponential(a: &Matrix3<f64>, time: f64) -> Matrix3<f64> {
    let doublings = (a.norm() * time).log2().ceil().max(0.0) as i32;
    let mut map = (a * (time / 2f64.powi(doublings))).exp();
    for _ in 0..doublings {
        map *= map;
        map /= map.amax();
    }
    map
}

/// exp(At) for A³ = −cA.
fn planar(a: &Matrix3<f64>, time: f64) -> Matrix3<f64> {
    let c = -0.5 * (a * a).trace();
    let root = c.abs().sqrt();
    let (once, twice) = if root == 0.0 {
        (time, 0.5 * time * time)
    } else if c > 0.0 {
        ((root * time).sin() / root, (1.0 - (root * time).cos()) / c)
    } else {
        ((root * time).sinh() / root, ((root * time).cosh() - 1.0) / -c)
    };
    Matrix3::identity() + a * once + a * a * twice
}

/// Number of hard problems. Of 10 000 at another seed 525 show a bound that is too wide and 585 a missing one, so that
/// at least 0.047 of all do: none of 300 does with a probability of 0.953³⁰⁰ = 5·10⁻⁷, below
/// [`crate::judge::accept::MISS`]. Of problems of any kind only 0.005 and 0.009 do, and 400 of these alone missed one
/// or the other at one seed in nine.
const HARD: u64 = 300;

/// The distance of two unit vectors up to sign: 2|sin| of half the angle, which has no cancellation.
fn apart(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    (a - b).norm().min((a + b).norm())
}

/// True if numbers of 106 bits leave at most 10⁻⁶ rad. Where two roots meet, the equation gives their distance only to
/// the root of a rounding: coefficients of e^{At} have errors of (|L|t)² roundings, and are |L|t times as large as what
/// remains after cancellation: roundings are those of L, even if little of it remains in A, near spheres. The remaining
/// part of the start's direction is smaller by the condition number. A thousand roundings are allowed for.
fn answerable(problem: &FlowProblem) -> bool {
    let (l, time) = gradient(problem);
    let turned = (l.norm() * time).max(1.0);
    let propagator = Propagator::general(&flow(problem), problem.rod.aspect_ratio);
    let (map, _) = propagator.map(Span::Strain(problem.strain, 1.0)).expect("any flow has a strain");
    let condition = map.norm() / (map * start(problem).as_ref()).norm();
    // The condition number itself is known to double precision only.
    condition < 1e12 && 1e3 * 2f64.powi(-106) * turned.powi(3) * condition <= MAX_ERROR_RAD
}

#[derive(Clone, Copy, Default)]
struct Decades {
    answered: u32,
    refused: u32,
    worst: f64,
    bound: f64,
}

fn general_flows(motion: &Motion, effort: &Effort) -> Vec<Evidence> {
    // Condition numbers up to 10², 10⁴, … and beyond.
    let mut decades = [Decades::default(); 9];
    let (mut wrong, mut share, mut needless) = (0.0, 0.0f64, 0.0);
    static PROBLEMS: Shared<(), Vec<FlowProblem>> = Shared::new();
    let problems = PROBLEMS.get(effort, (), || {
        let any = random(Kind::Any, effort.seed(9), effort.pick(400, 100_000));
        let hard = random(Kind::Hard, effort.seed(10), effort.pick(HARD, 30_000));
        [any, hard].concat()
    });
    for problem in problems.iter() {
        let moved = motion(problem);
        let at = ((moved.condition.log10() / 2.0).ceil() as usize).clamp(1, 9) - 1;
        let decades = &mut decades[at];
        if moved.error.is_nan() || moved.error > MAX_ERROR_RAD {
            decades.refused += 1;
            needless += f64::from(answerable(problem));
            continue;
        }
        let off = apart(&moved.p, &problem.truth.into());
        decades.answered += 1;
        // The oracle's own direction is rounded to double.
        let bound = moved.error + 2.0 * f64::EPSILON;
        if off.is_finite() {
            wrong += f64::from(off > bound);
            share = share.max(off / bound);
            decades.worst = decades.worst.max(off);
        } else {
            wrong += 1.0;
        }
        decades.bound = decades.bound.max(bound);
    }
    let all = [
        Evidence::on("answers that are off by more than their bound", "answers").exact(wrong),
        Evidence::on("largest error over its bound", "× its bound").within(share, 1.0).because("what a bound is"),
        Evidence::on("refused, though 106 bits can answer", "answers").exact(needless),
    ];
    let by_decade = decades.into_iter().enumerate().filter(|(_, found)| found.answered + found.refused > 0);
    let by_decade = by_decade.map(|(k, Decades { answered, refused, worst, bound })| {
        let exponent = 2 * (k + 1);
        let what = format!("worst of {answered} answers, condition number up to 10^{exponent}; {refused} refused");
        Evidence::on(what, "rad").within(worst, bound).because("the largest bound among them")
    });
    all.into_iter().chain(by_decade).collect()
}
