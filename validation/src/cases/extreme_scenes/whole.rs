//! Whole runs of free rods at the extremes.

use super::*;

/// Bound of |tr⟨pp⟩ − 1|, where the trace is the mean of |p|².
pub(super) const TRACE: f64 = 64.0 * f64::EPSILON;

pub(super) const TRACE_BECAUSE: &str =
    "2 · 4 ulp of |p|², and the roundings of a mean over twenty rods and two replicas";

pub(super) struct Ended {
    pub(super) trace: f64,
    /// True if the run finished with finite means and standard errors.
    pub(super) finite: bool,
    pub(super) last_x1: f64,
}

/// A run that stopped or had a result that is not finite: it counts as not finite and has no other effect.
const LOST: Ended = Ended { trace: 0.0, finite: false, last_x1: 1.0 };

/// Runs a scene as the program does.
pub(super) fn whole_run(scene: &Scene) -> Ended {
    let mut scene = scene.clone();
    scene.ensemble.replicas = 2;
    let Ok(results) = ensemble::run(&lab::plan(&scene)) else {
        return LOST;
    };
    let mut channels = results.series.iter().flat_map(|series| &series.columns);
    let finite = channels.all(|channel| (channel.mean.iter().chain(&channel.se)).all(|value| value.is_finite()));
    let mean = |name: &str, output: usize| results.column(name).map_or(f64::NAN, |channel| channel.mean[output]);
    if !finite {
        return LOST;
    }
    let trace = |output: usize| (["a11", "a22", "a33"].map(|name| mean(name, output)).iter().sum::<f64>() - 1.0).abs();
    let last = results.times.len() - 1;
    Ended { trace: worst((0..=last).map(trace)), finite, last_x1: mean("x1", last) }
}

/// One rod at the end of a scene by a plain q = exp(At) p: without shifting growth away or removing whole periods.
pub(super) fn by_exponential(scene: &Scene, rescaled: bool) -> Ended {
    let plan = lab::plan(scene);
    let flow = plan.flow();
    let r = scene.particles.aspect_ratio;
    let strain = match scene.time.unit {
        TimeUnit::Strain => scene.time.duration,
        TimeUnit::Second => scene.time.duration * flow.magnitude_per_s(),
        TimeUnit::Period => scene.time.duration * strain_per_period(r),
    };
    let a = flow.vorticity() + shape_factor(r) * flow.strain_rate();
    let map: Matrix3<f64> = (a * (strain / flow.magnitude_per_s())).exp();
    let q = map * Vector3::new(0.6, 0.0, 0.8);
    let p = if rescaled { q.normalize() } else { q };
    if !p.norm_squared().is_finite() {
        return LOST;
    }
    Ended { trace: (p.norm_squared() - 1.0).abs(), finite: true, last_x1: p.x.abs() }
}

/// The observables for scenes with very many outputs.
const FEW: [Observable; 2] = [Observable::Projections, Observable::OrientationTensor];

pub(super) fn extreme_scenes(program: &Program, effort: &Effort) -> Vec<Evidence> {
    let scene = |change: &dyn Fn(&mut Scene)| {
        let mut scene = lab::free_scene(effort);
        scene.particles.count = 5;
        // Rods without a concentration have no stress in Pa.
        scene.output.observables = Observable::ALL.to_vec();
        scene.output.observables.retain(|observable| !observable.needs_viscosity());
        change(&mut scene);
        scene
    };
    let mut scenes = Vec::new();
    for (r, shear_rate_per_s) in pairs(ASPECT_RATIOS, [1e-30, 1e30]) {
        scenes.push(scene(&|scene| {
            scene.particles.aspect_ratio = r;
            scene.flow = Flow::Shear { shear_rate_per_s };
            scene.time.outputs_per_unit = Some(4);
        }));
    }
    let starts = [(0.0, 0.0), (0.0, 180.0), (0.0, 90.0), (180.0, 90.0), (90.0, 90.0), (0.0, 1e-300)];
    for (r, (phi_deg, theta_deg)) in pairs(ASPECT_RATIOS, starts) {
        scenes.push(scene(&|scene| {
            scene.particles.aspect_ratio = r;
            scene.particles.orientation = Orientation::Given { phi_deg, theta_deg };
            scene.time.outputs_per_unit = Some(4);
        }));
    }
    // Three standard deviations reach 1, or 0 for discs, at 5.5556, 33.333 and 33.333 %.
    for (r, sd) in [(1.2, 5.555), (1e8, 33.33), (0.5, 33.33)] {
        scenes.push(scene(&|scene| {
            scene.particles.aspect_ratio = r;
            scene.particles.aspect_ratio_sd_percent = sd;
        }));
    }
    scenes.push(scene(&|scene| {
        scene.particles.count = 1;
        scene.output.observables = FEW.to_vec();
        scene.time = Time { outputs_per_unit: Some(1), ..Time::periods(effort.pick(1e4, 1e5)) };
    }));
    let free = scenes.len();
    let longest = effort.pick(1e4, 1e6);
    let rates = [(1e-30, 1e3), (1.0, longest), (1e30, 1e3)];
    for ((e, strain), (r, across)) in pairs(rates, pairs([1.5, 1e8], [[-1.0, 0.0], [-0.5, -0.5]])) {
        let [b, c] = across.map(|share| share * e);
        scenes.push(scene(&|scene| {
            scene.flow = Flow::Gradient { gradient_per_s: [[e, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]] };
            scene.particles.aspect_ratio = r;
            scene.particles.count = 1;
            scene.time = Time { outputs_per_unit: Some(1), ..Time::strain(strain) };
            scene.output.observables = FEW.to_vec();
        }));
    }
    let ended: Vec<_> = scenes.iter().map(program).collect();
    let trace = worst(ended.iter().map(|ended| ended.trace));
    let failed = ended.iter().filter(|ended| !ended.finite).count() as f64;
    let apart = worst(ended[free..].iter().map(|ended| (ended.last_x1 - 1.0).abs()));
    vec![
        Evidence::on("scenes that stopped or had a result that is not finite", "scenes").exact(failed),
        Evidence::on("largest |tr⟨pp⟩ − 1|", "–").within(trace, TRACE).because(TRACE_BECAUSE),
        Evidence::on("largest |X̄₁ − 1| at the end of an extension", "rod lengths")
            .within(apart, LENGTH)
            .because(LENGTH_BECAUSE),
    ]
}
