//! Rods that turn at random, step by step, against their exact distribution.

use super::*;
use crate::oracle::diffusion::{Motion, Start, at};

/// a_ij at the end of a flow that has this gradient in 1/s, of rods with this D_r in 1/s.
type Exact = fn([[f64; 3]; 3], f64) -> Option<[f64; 6]>;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "brownian-rods")
            .claim(
                "The stochastic run of rods with rotary diffusion has the a_ij of their distribution, in shear and in \
                 a flow without symmetry.",
            )
            .source("A.1; Strang 1968; docs/src/theory/diffusion.md")
            .under_test(exact as Exact)
            .mistake("half the D_r", |l, d_r| exact(l, 0.5 * d_r))
            .mistake("no flow", |_, d_r| exact([[0.0; 3]; 3], d_r))
            .mistake("the gradient transposed", |l, d_r| {
                exact(std::array::from_fn(|i| std::array::from_fn(|j| l[j][i])), d_r)
            })
            .check(check),
    ]
}

const SHEAR: [[f64; 3]; 3] = [[0.0; 3], [0.5, 0.0, 0.0], [0.0; 3]];
const MIXED: [[f64; 3]; 3] = [[0.25, -0.5, 0.125], [0.75, 0.125, -0.25], [0.375, 0.625, -0.375]];
const ASPECT_RATIO: f64 = 10.0;
const END_S: f64 = 4.0;
const D_R: f64 = 0.05;
const REPLICAS: u64 = 40;

fn exact(gradient_per_s: [[f64; 3]; 3], d_r: f64) -> Option<[f64; 6]> {
    let motion = Motion::diffusing(gradient_per_s, ASPECT_RATIO, d_r);
    Some(at(&motion, Start::Isotropic, &[END_S]).ok()?[0].second)
}

/// Each component in both flows.
static OF_SCENES: Shared<(), [Vec<Sample>; 2]> = Shared::new();

fn check(exact: &Exact, effort: &Effort) -> Vec<Evidence> {
    let of_scenes = OF_SCENES.get(effort, (), || [SHEAR, MIXED].map(|flow| of_scene(flow, effort)));
    let (mut largest, mut widest) = (0.0, 0.0);
    for (gradient_per_s, means) in [SHEAR, MIXED].into_iter().zip(of_scenes.iter()) {
        let due = exact(gradient_per_s, D_R).unwrap_or([f64::NAN; 6]);
        for (Sample { mean, se, .. }, due) in means.iter().zip(due) {
            largest = larger(largest, (mean - due).abs() / se);
            widest = larger(widest, *se);
        }
    }
    vec![
        Evidence::on("a_ij, the farthest of twelve components", "standard errors").within(largest, 8.0).because(
            "Student's t of 39 degrees of freedom is beyond 8 with a probability of 10⁻⁹; the controls are more than \
             40 off",
        ),
        Evidence::on("largest standard error of them", "–")
            .within(widest, 1.5e-3)
            .because("1.7 times the value of a pilot: wider ones would hide a mistake"),
    ]
}

fn of_scene(gradient_per_s: [[f64; 3]; 3], effort: &Effort) -> Vec<Sample> {
    let mut scene = Scene { flow: Flow::Gradient { gradient_per_s }, time: Time::seconds(END_S), ..Scene::default() };
    scene.particles.aspect_ratio = ASPECT_RATIO;
    scene.particles.rotary_diffusion_per_s = D_R;
    scene.particles.count = effort.pick(3000, 5000);
    scene.ensemble.replicas = REPLICAS;
    scene.ensemble.seed = effort.seed(0);
    scene.output.observables = vec![Observable::OrientationTensor];
    let plan = lab::plan(&scene);
    let results = ensemble::run(&plan);
    let last = plan.outputs() - 1;
    Observable::OrientationTensor.channels().map(|channel| lab::at_output(&results, channel, last, REPLICAS)).collect()
}
