//! Rods in flows that keep the liquid's volume: the control volume stays evenly filled.

use super::*;
use crate::oracle::naive::{Mistake, carry, stream};

pub fn cases() -> Vec<Case> {
    let mistake = |mistake| Inflow::Wrong(Some(mistake));
    vec![
        Case::core("even-inflow")
            .claim(
                "In any flow without a trace, rods that leave come back inside, so that the volume stays evenly \
                 filled.",
            )
            .source("eqs 2, 3, 12; a replacement rule for flows other than eq. 14's")
            .under_test(Inflow::Core)
            .mistake("rods come in anywhere on a face alike", mistake(Mistake::InflowUniform))
            .mistake("faces chosen by their area alone", mistake(Mistake::FacesByArea))
            .mistake("rods come in at the step's beginning, all of them", mistake(Mistake::InflowAtOnce))
            .check(even),
    ]
}

enum Inflow {
    Core,
    /// The naive rule, with a mistake or without one.
    Wrong(Option<Mistake>),
}

/// L in 1/s, row by row.
type Gradient = [[f64; 3]; 3];

/// Shear that is oblique to the volume, extension, and a flow with all components, each in a volume that is not a cube.
const FLOWS: [(&str, Gradient, [f64; 3]); 3] = [
    ("oblique shear", [[0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.0; 3]], [10.0, 5.0, 5.0]),
    ("extension", [[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, -0.5]], [5.0, 5.0, 20.0]),
    ("all components", [[0.3, -0.5, 0.1], [0.8, 0.1, -0.2], [0.4, 0.6, -0.4]], [5.0, 8.0, 10.0]),
];

/// Steps of a quarter of a unit of strain: less than a thousandth of the volume is replaced twice within a step.
const STEPS_PER_STRAIN: u64 = 4;
const STEPS: u64 = 16;
/// The distance of a coordinate's distribution function to detect.
const DISTANCE: f64 = 0.02;

fn even(inflow: &Inflow, effort: &Effort) -> Vec<Evidence> {
    let count = effort.pick(1, 4) * kolmogorov_samples(DISTANCE);
    let mut evidence = Vec::new();
    let mut outside = 0;
    for (name, gradient, box_mm) in FLOWS {
        let ends = ends(inflow, effort, count as usize, gradient, box_mm);
        for (axis, places) in ends.into_iter().enumerate() {
            let inside: Vec<f64> = places.iter().copied().filter(|x| (0.0..1.0).contains(x)).collect();
            outside += places.len() - inside.len();
            let title = format!("{name}: p of x_{k}/H_{k} being uniform after a strain of 4", k = axis + 1);
            let because = "Kolmogorov–Smirnov; each mistake moves a coordinate by more in some flow";
            evidence.push(Evidence::new(title, lab::uniform(inside, DISTANCE, because)));
        }
    }
    evidence.push(Evidence::exact("rods outside the volume", outside as f64));
    evidence
}

/// The rods' final places, in units of the sides.
fn ends(inflow: &Inflow, effort: &Effort, count: usize, gradient: Gradient, box_mm: [f64; 3]) -> [Vec<f64>; 3] {
    let scene = scene(effort, count, gradient, box_mm);
    match inflow {
        Inflow::Core => {
            let mut suspension = lab::suspension(&scene, 0);
            for _ in 0..STEPS {
                if suspension.step().is_err() {
                    return [const { Vec::new() }; 3];
                }
            }
            let (places, sides) = (suspension.positions_in_lengths(), suspension.sides_in_lengths());
            [0, 1, 2].map(|axis| places[axis].iter().map(|x| x / sides[axis]).collect())
        }
        Inflow::Wrong(made) => {
            let dt_s = lab::problem(&scene, 0, *made).time_step_s();
            let mut draws = stream(effort.seed(31), 0, 0);
            let mut places: Vec<[f64; 3]> =
                (0..count).map(|_| box_mm.map(|side| side * draws.random::<f64>())).collect();
            let (replacements, mut replaced) = (stream(effort.seed(31), 0, 1), 0);
            for _ in 0..STEPS {
                carry(&mut places, gradient, box_mm, dt_s, &replacements, &mut replaced, *made);
            }
            [0, 1, 2].map(|axis| places.iter().map(|x| x[axis] / box_mm[axis]).collect())
        }
    }
}

fn scene(effort: &Effort, count: usize, gradient: Gradient, box_mm: [f64; 3]) -> Scene {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = count;
    scene.flow = Flow::Gradient { gradient_per_s: gradient };
    lab::set_box_mm(&mut scene, box_mm);
    scene.time = Time { steps_per_unit: Some(STEPS_PER_STRAIN), outputs_per_unit: Some(1), ..Time::strain(1.0) };
    scene
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::accept::{Verdict, judge};

    #[test]
    fn the_wrong_rules_are_wrong_by_their_mistakes_alone() {
        for evidence in even(&Inflow::Wrong(None), &Effort::gate()) {
            assert_eq!(judge(&evidence.rule), Verdict::Pass, "{evidence:?}");
        }
    }
}
