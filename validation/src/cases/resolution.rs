//! Resolution of the motion by a step: X̄₁ of interacting rods at half a period, where free rods return to their
//! start and too long a step has the largest effect, compared with X̄₁ at another step.

use super::*;

/// Fig. 7's rods for half a period, with another mean aspect ratio and concentration.
pub fn scene(effort: &Effort, aspect_ratio: f64, concentration_per_cm3: f64) -> Scene {
    let mut scene = lab::crowded_scene(effort, 100, concentration_per_cm3);
    scene.particles.aspect_ratio = aspect_ratio;
    scene.time = Time { outputs_per_unit: Some(2), ..Time::periods(0.5) };
    scene
}

/// The even number of steps a period whose strain GΔt is closest to `strain`.
pub fn steps(aspect_ratio: f64, strain: f64) -> u64 {
    2 * (0.5 * strain_per_period(aspect_ratio) / strain).round() as u64
}

/// X̄₁ at t/T = ½ of the replicas 0 to `replicas`.
pub fn x1(scene: &Scene, steps_per_period: u64, replicas: u64) -> Vec<f64> {
    let scene = lab::changed(scene.clone(), |scene| scene.time.steps_per_unit = Some(steps_per_period));
    lab::per_replica(&scene, replicas, |mean| mean(Channel::X[0], 1))
}

struct Size {
    aspect_ratio: f64,
    /// A number of steps a period that must be detected as too small.
    coarse: u64,
    /// The change of X̄₁ by those steps beyond a drawn line, and the scatter of a replica's change.
    design: Design,
}

/// The width of a drawn line in the paper's figures.
const LINE: f64 = 0.01;

/// Coarse steps change X̄₁ against the default step by 0.0295 and 0.061 (the table of docs/src/theory/time-step.md, and
/// for the first the same with these steps). The difference of X̄₁ of 100 rods from the same replica at the default
/// step has a standard deviation of 0.025 at r_e = 11.6 and of 0.035 at 100 (2000 replicas; a tenth more is used).
/// Twice the default step changes X̄₁ by 0.003, so that a correct default fails with less than the gate's level.
const SIZES: [Size; 2] = [
    Size { aspect_ratio: 11.6, coarse: 4, design: Design::new(0.0195, 0.0275) },
    Size { aspect_ratio: 100.0, coarse: 200, design: Design::new(0.051, 0.0385) },
];

/// The [`SIZES`] that are run, at the coarse steps or at the scene's own.
struct Integrator {
    sizes: &'static [Size],
    coarse: bool,
}

/// The case of the default step.
pub fn cases() -> Vec<Case> {
    let control = |k: usize| Integrator { sizes: &SIZES[k..=k], coarse: true };
    vec![
        Case::of(Judges::Core, "default-step-resolves")
            .claim(
                "The default steps resolve the motion: even twice their length changes X̄₁ at t/T = ½ by less than a \
                 drawn line, for r_e = 11.6 and 100.",
            )
            .source("eq. 15; Fig. 7")
            .under_test(Integrator { sizes: &SIZES, coarse: false })
            .mistake("4 steps a period at r_e = 11.6", control(0))
            .mistake("200 steps a period at r_e = 100", control(1))
            .check(|compared, effort| {
                let of_size = |size| coarser_step(size, compared.coarse, effort);
                compared.sizes.iter().map(of_size).collect::<Vec<_>>()
            }),
    ]
}

fn coarser_step(size: &Size, coarse: bool, effort: &Effort) -> Evidence {
    let scene = scene(effort, size.aspect_ratio, 50.0);
    let default = scene.steps_per_unit();
    let steps = if coarse { size.coarse } else { default / 2 };
    let replicas = effort.samples(size.design);
    // Cached, as it is by far the longest of the runs.
    static DEFAULT: Shared<u64, Vec<f64>> = Shared::new();
    let fine = DEFAULT.get(effort, default, || x1(&scene, default, replicas));
    Evidence::on(format!("X̄₁ at r_e = {}: {steps} steps a period less {default}", size.aspect_ratio), "rod lengths")
        .is(Sample::of_differences(&x1(&scene, steps, replicas), &fine), 0.0, LINE, size.design.effect)
        .because("0.01: a drawn line of the paper's figures")
}
