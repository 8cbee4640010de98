//! Extreme interacting rods, and extreme whole scenes as the program runs them.

mod placed;
mod whole;

use self::placed::{Pair, step_of_the_core, step_with_squares};
use self::whole::{Ended, TRACE, TRACE_BECAUSE, by_exponential, extreme_scenes, whole_run};
use super::extremes::{LENGTH, LENGTH_BECAUSE, off_length};
use super::*;
use crate::studies::stability::map::ASPECT_RATIOS;
use shearbed::model::jeffery::couette_rate;

/// The functions that step rods; a control replaces one of them.
struct Model {
    /// Returns the directions of the rods after the steps so far.
    directions: fn(&Suspension) -> Vec<Vector3<f64>>,
    pair: Pair,
    /// A change to the scenes that count how often rods meet.
    meeting: fn(&mut Scene),
}

const CORE: Model = Model { directions: |suspension| suspension.directions(), pair: step_of_the_core, meeting: |_| {} };

type Program = fn(&Scene) -> Ended;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Program, "extreme-suspensions")
            .claim(
                "Interacting rods stay finite and |p| = 1 to 4 ulp: dense and thin, N = 1 and 2, α = 0 and huge, m \
                 from 0.1 to 50, σ at its limit, G from 10⁻³⁰ to 10³⁰ 1/s, steps from 10⁻⁷ T to T, parallel to one \
                 ulp, arms to the smallest normal number. A kick that overflows stops the run and names rod, step, \
                 seed and arm.",
            )
            .source("eqs 7, 14, A.13, A.14")
            .under_test(CORE)
            .mistake("the last step by explicit Euler, not rescaled", Model { directions: stepped_by_euler, ..CORE })
            .mistake("|ṗ| as the root of its squares", Model { pair: step_with_squares, ..CORE })
            .mistake(
                "a shortest arm of 10⁻³ nobody asked for",
                Model {
                    pair: |scene, placed| {
                        let long = |scene: &mut Scene| lab::interaction(scene).min_contact_arm = 1.1e-3;
                        step_of_the_core(&lab::changed(scene.clone(), long), placed)
                    },
                    ..CORE
                },
            )
            .mistake("α without effect", Model { meeting: |scene| lab::interaction(scene).alpha = 1e-300, ..CORE })
            .check(extreme_suspensions),
        Case::of(Judges::Program, "extreme-scenes")
            .claim(
                "Scenes of free rods end with finite means and tr⟨pp⟩ = 1: G from 10⁻³⁰ to 10³⁰ 1/s, r_e from 10⁻⁸ to \
                 10⁸, σ at its limit, both poles, the flip, 10⁴ periods, and extension to a strain of 10⁴ (10⁵ and 10⁶ \
                 in a full run), which aligns every rod.",
            )
            .source("eqs 3, 4, 11, 15")
            .under_test(whole_run as Program)
            .mistake("a thousandth of the strain", |scene| {
                whole_run(&lab::changed(scene.clone(), |scene| scene.time.duration *= 1e-3))
            })
            .mistake("the plain exponential", |scene| by_exponential(scene, true))
            .mistake("the plain exponential, not rescaled", |scene| by_exponential(scene, false))
            .check(extreme_scenes),
    ]
}

fn extreme_suspensions(model: &Model, effort: &Effort) -> Vec<Evidence> {
    let [mut length, mut stopped, mut trace] = [0.0f64; 3];
    for scene in scenes(effort) {
        let mut suspension = lab::stepped(&scene, 0);
        stopped += f64::from((0..300).any(|_| suspension.step().is_err()));
        length = larger(length, worst((model.directions)(&suspension).iter().map(off_length)));
        let ended = whole_run(&scene);
        trace = larger(trace, ended.trace);
        stopped += f64::from(!ended.finite);
    }
    let (placed, unlike) = placed::ends(model.pair, effort);
    length = larger(length, worst(placed.iter().map(off_length)));
    vec![
        Evidence::on("largest ||p| − 1|", "–").within(length, LENGTH).because(LENGTH_BECAUSE),
        Evidence::on("largest |tr⟨pp⟩ − 1| of whole runs", "–").within(trace, TRACE).because(TRACE_BECAUSE),
        Evidence::on("rods that met although n = 10⁻³⁰ per cm³, or did not although α = 10³⁰⁰", "rods")
            .exact(meetings(model, effort)),
        Evidence::on("runs that stopped or had a mean that is not finite", "runs").exact(stopped),
        Evidence::on(
            "pairs put down by hand that did not turn, or did not stop with rod, step, seed and arm where the kick \
             overflows",
            "pairs",
        )
        .exact(unlike),
    ]
}

/// The number of scenes in which distant rods meet, or in which rods never meet although every one is within reach.
fn meetings(model: &Model, effort: &Effort) -> f64 {
    let met = |change: fn(&mut Scene)| {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.count = 20;
        change(&mut scene);
        (model.meeting)(&mut scene);
        ensemble::run(&lab::plan(&scene)).map_or(f64::NAN, |results| results.counters.collisions as f64)
    };
    let thin = met(|scene| lab::interaction(scene).concentration_per_cm3 = Some(1e-30));
    let reaching = met(|scene| lab::interaction(scene).alpha = 1e300);
    f64::from(thin != 0.0) + f64::from(reaching.is_nan() || reaching < 1.0)
}

fn scenes(effort: &Effort) -> Vec<Scene> {
    let scene = |change: fn(&mut Scene)| {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.count = 20;
        scene.liquid.viscosity_pa_s = Some(1.0);
        scene.output.observables = Observable::ALL.to_vec();
        change(&mut scene);
        scene
    };
    vec![
        scene(|scene| lab::interaction(scene).concentration_per_cm3 = Some(1e30)),
        scene(|scene| lab::interaction(scene).concentration_per_cm3 = Some(1e-30)),
        scene(|scene| scene.particles.count = 1),
        scene(|scene| scene.particles.count = 2),
        scene(|scene| lab::interaction(scene).alpha = 0.0),
        scene(|scene| lab::interaction(scene).alpha = 1e300),
        scene(|scene| lab::interaction(scene).m = 0.1),
        scene(|scene| lab::interaction(scene).m = 50.0),
        scene(|scene| {
            scene.particles.aspect_ratio = 1.2;
            // Three standard deviations reach 1 at 5.5556 %.
            scene.particles.aspect_ratio_sd_percent = 5.555;
            lab::interaction(scene).alpha = 1e3;
        }),
        scene(|scene| scene.particles.aspect_ratio = 1.0 + 1e-12),
        scene(|scene| {
            scene.particles.aspect_ratio = 1e8;
            scene.time.steps_per_unit = Some(200);
        }),
        scene(|scene| {
            // Every rod is parallel to every other: no contact line.
            scene.particles.orientation = Orientation::Given { phi_deg: 90.0, theta_deg: 0.0 };
            lab::interaction(scene).alpha = 1e3;
        }),
        scene(|scene| {
            lab::interaction(scene).update = Update::Angles;
            lab::interaction(scene).alpha = 1e3;
        }),
        scene(|scene| scene.flow = Flow::Shear { shear_rate_per_s: 1e-30 }),
        scene(|scene| scene.flow = Flow::Shear { shear_rate_per_s: 1e30 }),
        scene(|scene| lab::interaction(scene).min_contact_arm = f64::MIN_POSITIVE),
        scene(|scene| {
            scene.time =
                Time { steps_per_unit: Some(10_000_000), outputs_per_unit: Some(100_000), ..Time::periods(3e-5) };
            lab::interaction(scene).alpha = 1e3;
        }),
        scene(|scene| {
            scene.time.steps_per_unit = Some(1);
            scene.time.outputs_per_unit = Some(1);
            lab::interaction(scene).alpha = 1e3;
        }),
    ]
}

/// The core's directions one step later, by p + ṗΔt.
fn stepped_by_euler(suspension: &Suspension) -> Vec<Vector3<f64>> {
    let rods = suspension.directions().into_iter().zip(suspension.aspect_ratios());
    rods.map(|(p, r)| p + 1e-3 * couette_rate(&p, shape_factor(r), 1.0)).collect()
}
