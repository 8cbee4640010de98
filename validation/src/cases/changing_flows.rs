//! Flows one after another, exact for free rods: `[[flow.steps]]`.

use super::*;
use crate::judge::lab::{changed, free_scene};
use crate::methods::integrators::apart_rad;
use crate::oracle::exponential::{Rod, Span};
use shearbed::scene::FlowStep;
use shearbed::suspension::snapshot::Snapshot;

struct Moved {
    /// Aspect ratio, initial direction and final direction of each rod.
    rods: Vec<(f64, [f64; 3], [f64; 3])>,
    /// The bound that the plan states on a direction's error, in rad.
    error_rad: f64,
    seconds: f64,
}

type Run = fn(&Scene) -> Moved;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "changing-flows")
            .claim(
                "Where one flow follows another, each free rod moves by the product of their exponentials: a reversal \
                 takes it back to its start, after an extension that aligns rods to 10⁻⁸ rad too, and three flows \
                 take it where the oracle has it. The seconds are those of each flow's rate.",
            )
            .source("eqs 2, 3, A.1")
            .under_test(run as Run)
            .mistake("the flows in the opposite order", |scene| run(&with(scene, |steps| steps.reverse())))
            .mistake("the last flow left out: the one before goes on", |scene| {
                run(&with(scene, |steps| {
                    let last = steps.len() - 1;
                    steps[last].gradient_per_s = steps[last - 1].gradient_per_s;
                }))
            })
            .mistake("a gradient read by columns", |scene| {
                run(&with(scene, |steps| {
                    let rows = steps[0].gradient_per_s;
                    steps[0].gradient_per_s = std::array::from_fn(|i| std::array::from_fn(|j| rows[j][i]));
                }))
            })
            .mistake("a flow that begins a millionth of its strain late", |scene| {
                run(&with(scene, |steps| steps[0].strain *= 1.0 + 1e-6))
            })
            .mistake("the seconds of the first flow's rate", |scene| {
                let steps = scene.flow.steps().unwrap_or_default();
                let rate = rate_per_s(&steps[0].gradient_per_s);
                Moved { seconds: scene.time.duration / rate, ..run(scene) }
            })
            .check(changing_flows),
    ]
}

fn with(scene: &Scene, change: impl FnOnce(&mut Vec<FlowStep>)) -> Scene {
    changed(scene.clone(), |scene| {
        if let Flow::Steps { steps } = &mut scene.flow {
            change(steps);
            // A longer step would end the scene later.
            scene.time.duration = scene.time.duration.min(steps.iter().map(|step| step.strain).sum());
        }
    })
}

fn run(scene: &Scene) -> Moved {
    let ended = || {
        let plan = Plan::new(scene).ok()?;
        let results = ensemble::run(&plan).ok()?;
        let [start, end] = &results.snapshots[..] else { return None };
        let direction = |snapshot: &Snapshot, rod: usize| [0, 1, 2].map(|axis| snapshot.p[axis][rod]);
        let rods = 0..start.aspect_ratio.len();
        Some(Moved {
            rods: rods.map(|rod| (start.aspect_ratio[rod], direction(start, rod), direction(end, rod))).collect(),
            error_rad: plan.error_rad()?,
            seconds: results.elapsed.last()?.seconds,
        })
    };
    ended().unwrap_or(Moved { rods: Vec::new(), error_rad: f64::NAN, seconds: f64::NAN })
}

const SHEAR: [[f64; 3]; 3] = [[0.0; 3], [0.5, 0.0, 0.0], [0.0; 3]];
const EXTENSION: [[f64; 3]; 3] = [[2.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
const MIXED: [[f64; 3]; 3] = [[0.3, -0.2, 0.1], [0.7, -0.4, 0.0], [-0.6, 0.5, 0.1]];

/// The shear rate (2 D:D)^½ of a velocity gradient.
fn rate_per_s(l: &[[f64; 3]; 3]) -> f64 {
    let entries = (0..9).map(|k| (k / 3, k % 3));
    (0.5 * entries.map(|(i, j)| (l[i][j] + l[j][i]).powi(2)).sum::<f64>()).sqrt()
}

fn scene(effort: &Effort, steps: Vec<FlowStep>) -> Scene {
    changed(free_scene(effort), |scene| {
        let strain = steps.iter().map(|step| step.strain).sum();
        scene.flow = Flow::Steps { steps };
        scene.particles.count = 64;
        scene.particles.aspect_ratio_sd_percent = 3.6;
        scene.particles.orientation = Orientation::default();
        scene.time = Time { outputs_per_unit: Some(2), ..Time::strain(strain) };
        scene.output.rods_at = vec![0.0, strain];
    })
}

/// Two steps: a flow over `strain`, then its reverse.
fn reversed(gradient_per_s: [[f64; 3]; 3], strain: f64) -> Vec<FlowStep> {
    let back = gradient_per_s.map(|row| row.map(|component| -component));
    vec![FlowStep { gradient_per_s, strain }, FlowStep { gradient_per_s: back, strain }]
}

fn apart(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    apart_rad(&(*a).into(), &(*b).into())
}

fn changing_flows(run: &Run, effort: &Effort) -> Vec<Evidence> {
    let reversals = [(SHEAR, 30.0), (EXTENSION, 24.0), (MIXED, 10.0)].map(|(gradient, strain)| {
        let moved = run(&scene(effort, reversed(gradient, strain)));
        let worst = moved.rods.iter().map(|(_, start, end)| apart(start, end)).fold(f64::NEG_INFINITY, larger);
        worst / (moved.error_rad + 4.0 * f64::EPSILON)
    });
    let three = [(SHEAR, 3.0), (MIXED, 1.5), (EXTENSION, 1.0)];
    let steps = three.map(|(gradient_per_s, strain)| FlowStep { gradient_per_s, strain }).to_vec();
    let moved = run(&scene(effort, steps));
    let off = moved.rods.iter().map(|(aspect_ratio, start, end)| {
        let truth = three.iter().fold(*start, |p, (gradient_per_s, strain)| {
            Rod { gradient_per_s: *gradient_per_s, aspect_ratio: *aspect_ratio, p }.after(Span::Strain(*strain))
        });
        apart(&truth, end)
    });
    let seconds: f64 = three.iter().map(|(gradient, strain)| strain / rate_per_s(gradient)).sum();
    vec![
        Evidence::on(
            "reversed shear, extension and a mixed flow: largest angle to the start over the plan's bound",
            "× its bound",
        )
        .within(worst(reversals), 1.0)
        .because("what a bound is, with four roundings of a direction to double"),
        Evidence::on("three flows: largest angle to the oracle's direction", "rad")
            .within(off.fold(f64::NEG_INFINITY, larger), 1e-12)
            .because(
                "the oracle's direction is rounded to double between flows; they turn 10⁻¹⁶ rad into 10⁻¹³ at most, a \
                 rod's r_e of 13 times e^(½ of the strains)",
            ),
        Evidence::on("three flows: relative error of the seconds", "–")
            .within((moved.seconds / seconds - 1.0).abs(), 16.0 * f64::EPSILON)
            .because("roundings of three quotients and their sum"),
    ]
}
