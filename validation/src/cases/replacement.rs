//! The control volume: rods that leave it are replaced, by eq. 14 in plane Couette flow and by another rule in other
//! flows that keep the liquid's volume, so that it stays evenly filled.

use super::*;
use crate::oracle::naive::{Mistake, carry, stream};

pub fn cases() -> Vec<Case> {
    let mistake = |mistake| Inflow::Wrong(Some(mistake));
    vec![
        Case::of(Judges::Core, "replacement")
            .claim(
                "Replacement keeps every rod inside, new rods have x_1 = H√R and x_3 = HR, and the volume stays evenly \
                 filled.",
            )
            .source("eqs 12, 14")
            .under_test(Volume::Core { step: 1 })
            .mistake(
                "x_1 = HR for new rods",
                Volume::Wrong(|x, draws| *x = [draws.random(), x[1].rem_euclid(1.0), draws.random()]),
            )
            .mistake(
                "new rods in the lower half of axis 3",
                Volume::Wrong(|x, draws| *x = [root(draws), x[1].rem_euclid(1.0), 0.5 * draws.random::<f64>()]),
            )
            .mistake(
                "x_2 drawn at random, as eq. 14's text has it",
                Volume::Wrong(|x, draws| *x = [root(draws), draws.random(), draws.random()]),
            )
            .mistake("new rods keep x_1 and x_3", Volume::Wrong(|x, _| x[1] = x[1].rem_euclid(1.0)))
            .mistake(
                "rods of the far half of axis 1 are not brought back",
                Volume::Wrong(|x, draws| {
                    if x[0] < 0.5 {
                        *x = [root(draws), x[1].rem_euclid(1.0), draws.random()];
                    }
                }),
            )
            .mistake("steps as long as the whole strain", Volume::Core { step: STEPS })
            .check(replacement),
        Case::of(Judges::Core, "even-inflow")
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

enum Volume {
    /// The core; `step` is a factor on the usual time step.
    Core { step: u64 },
    /// Rods at random places that are carried, with a wrong rule for those that left; places in units of H.
    Wrong(fn(&mut [f64; 3], &mut Pcg64Dxsm)),
}

fn root(draws: &mut Pcg64Dxsm) -> f64 {
    draws.random::<f64>().sqrt()
}

/// Places in units of H, for the statistics.
#[derive(Default)]
struct Places {
    /// x_2 of new rods less the overshoot modulo H.
    new_x2_off: Vec<f64>,
    new_x1: Vec<f64>,
    new_x3: Vec<f64>,
    /// Number of new rods with the old x_1 or x_3.
    unchanged: usize,
    end: [Vec<f64>; 3],
    outside: usize,
}

/// Eq. 14 draws x_1 independently of the overshoot, which fills the volume unevenly by O(GΔt): 0.02 in the distribution
/// function at 200 steps per period (docs/src/theory/index.md), so 0.0005 at this many, a hundredth of the effect to
/// detect.
const STEPS_PER_PERIOD: u64 = 8000;
/// Number of steps, for a strain of 3.7.
const STEPS: u64 = 400;

fn replacement(volume: &Volume, effort: &Effort) -> Vec<Evidence> {
    const END: f64 = 0.08;
    let count = effort.pick(1, 4) * kolmogorov_samples(END);
    let places = follow(volume, effort, count as usize);
    let inside = |x: &&f64| (0.0..1.0).contains(*x);
    let outside = places.outside + places.end.iter().flatten().filter(|x| !inside(x)).count();
    let overshoot_off = places.new_x2_off.iter().fold(0.0, |worst, off| larger(worst, off.abs()));
    let squares = places.new_x1.iter().map(|x| x * x).collect();
    // The test needs values in [0, 1]; those outside are counted above.
    let end = places.end.map(|axis| axis.iter().filter(inside).copied().collect::<Vec<_>>());
    let [x1, x2, x3] = end;
    let even = "Kolmogorov–Smirnov; long steps move x_1 by 0.12 at the least";
    vec![
        Evidence::on("rods outside the volume", "rods").exact(outside as f64),
        Evidence::on("largest |x_2 − overshoot modulo H| of new rods, over H", "–")
            .within(overshoot_off, 4.0 * f64::EPSILON)
            .because("five roundings of numbers near 1, half an ε each"),
        Evidence::on("new rods with unchanged x_1 or x_3", "rods").exact(places.unchanged as f64),
        Evidence::on("p of (x_1/H)² of new rods being uniform", "–")
            .uniform(squares, 0.2)
            .because("Kolmogorov–Smirnov; x_1 = HR is ¼ off, √u − u at u = ¼"),
        Evidence::on("p of x_3/H of new rods being uniform", "–")
            .uniform(places.new_x3, 0.2)
            .because("Kolmogorov–Smirnov; half the axis is ½ off"),
        Evidence::on("p of x_1/H being uniform after a strain of 3.7", "–").uniform(x1, END).because(even),
        Evidence::on("p of x_2/H being uniform after a strain of 3.7", "–").uniform(x2, END).because(even),
        Evidence::on("p of x_3/H being uniform after a strain of 3.7", "–").uniform(x3, END).because(even),
    ]
}

/// Follows `count` rods: the places of all new ones, and of all rods at the end.
fn follow(volume: &Volume, effort: &Effort, count: usize) -> Places {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = count;
    let step = match volume {
        Volume::Core { step } => *step,
        Volume::Wrong(_) => 1,
    };
    scene.time.steps_per_unit = Some(STEPS_PER_PERIOD / step);
    let strain = strain_per_period(scene.particles.aspect_ratio) / scene.steps_per_unit() as f64;
    let mut suspension = lab::suspension(&scene, 0);
    let sides = suspension.sides_in_lengths();
    let mut draws = stream(scene.ensemble.seed, 0, 0);
    let mut rods = match volume {
        Volume::Core { .. } => in_sides(&suspension, sides),
        Volume::Wrong(_) => (0..count).map(|_| [(); 3].map(|()| draws.random::<f64>())).collect(),
    };
    let mut places = Places::default();
    for _ in 0..STEPS / step {
        let before = rods.clone();
        match volume {
            Volume::Core { .. } => {
                places.outside += usize::from(suspension.step().is_err());
                rods = in_sides(&suspension, sides);
            }
            Volume::Wrong(replace) => {
                for x in &mut rods {
                    x[1] += x[0] * strain;
                    if !(0.0..1.0).contains(&x[1]) {
                        replace(x, &mut draws);
                    }
                }
            }
        }
        for (x, before) in rods.iter().zip(&before) {
            places.outside += usize::from(!(0.0..1.0).contains(&x[1]));
            let moved = before[1] + before[0] * strain;
            if moved >= 1.0 {
                places.new_x2_off.push(x[1] - moved % 1.0);
                places.unchanged += usize::from(x[0] == before[0] || x[2] == before[2]);
                places.new_x1.push(x[0]);
                places.new_x3.push(x[2]);
            }
        }
    }
    places.end = [0, 1, 2].map(|axis| rods.iter().map(|x| x[axis]).collect());
    places
}

fn in_sides(suspension: &Suspension, [h1, h2, h3]: [f64; 3]) -> Vec<[f64; 3]> {
    let [x1, x2, x3] = suspension.positions_in_lengths();
    (0..x1.len()).map(|rod| [x1[rod] / h1, x2[rod] / h2, x3[rod] / h3]).collect()
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
const STRAIN_STEPS: u64 = 16;
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
            evidence.push(Evidence::on(title, "–").uniform(inside, DISTANCE).because(because));
        }
    }
    evidence.push(Evidence::on("rods outside the volume", "rods").exact(outside as f64));
    evidence
}

/// The rods' final places, in units of the sides.
fn ends(inflow: &Inflow, effort: &Effort, count: usize, gradient: Gradient, box_mm: [f64; 3]) -> [Vec<f64>; 3] {
    let scene = scene(effort, count, gradient, box_mm);
    match inflow {
        Inflow::Core => {
            let mut suspension = lab::suspension(&scene, 0);
            if (0..STRAIN_STEPS).any(|_| suspension.step().is_err()) {
                return [const { Vec::new() }; 3];
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
            for _ in 0..STRAIN_STEPS {
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
        let right = Volume::Wrong(|x, draws| *x = [root(draws), x[1].rem_euclid(1.0), draws.random()]);
        let (replaced, even) = (replacement(&right, &Effort::gate()), even(&Inflow::Wrong(None), &Effort::gate()));
        for evidence in replaced.into_iter().chain(even) {
            assert_eq!(judge(&evidence.rule), Verdict::Pass, "{evidence:?}");
        }
    }
}
