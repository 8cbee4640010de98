//! Interacting rods, and whole scenes as the program runs them, where they are extreme.

mod placed;

use self::placed::{Pair, step_of_the_core, step_with_squares};
use super::extremes::{LENGTH, LENGTH_BECAUSE, off_length};
use crate::case::{Case, Effort, Evidence};
use crate::lab;
use crate::stability::map::ASPECT_RATIOS;
use crate::statistics::larger;
use nalgebra::{Matrix3, Vector3};
use shearbed::jeffery::{couette_rate, shape_factor, strain_per_period};
use shearbed::scene::{Orientation, Scene, Update};
use shearbed::{Observable, Suspension, ensemble};

/// What steps rods, and what a control puts in its place.
struct Model {
    /// The directions after so many steps.
    directions: fn(&Suspension) -> Vec<Vector3<f64>>,
    /// What a step makes of two rods that were put down by hand.
    pair: Pair,
    /// A change to the scenes that say how often rods meet.
    meeting: fn(&mut Scene),
}

const CORE: Model = Model {
    directions: |suspension| suspension.directions(),
    pair: step_of_the_core,
    meeting: |_| {},
};

/// What runs a scene.
type Program = fn(&Scene) -> Ended;

pub fn cases() -> Vec<Case> {
    vec![
        Case::program("extreme-suspensions")
            .claim("Interacting rods stay finite and |p| = 1 to 4 ulp: dense and thin, N = 1 and 2, α = 0 and \
                    huge, m from 0.1 to 50, σ at its limit, G from 10⁻³⁰ to 10³⁰ 1/s, steps from 10⁻⁷ T to T, \
                    parallel to one ulp, arms to the smallest normal number. A kick that overflows stops the \
                    run and names rod, step, seed and arm.")
            .source("eqs 5–14, A.7–A.14")
            .equations(&["7", "14", "A.13", "A.14"])
            .subject(CORE)
            .mistake("the last step by explicit Euler, not rescaled", Model {
                        directions: stepped_by_euler,
                        ..CORE
                    })
            .mistake("|ṗ| as the root of its squares", Model {
                        pair: step_with_squares,
                        ..CORE
                    })
            .mistake("a shortest arm of 10⁻³ nobody asked for", Model {
                        pair: |scene, placed| {
                            let mut scene = scene.clone();
                            lab::interaction(&mut scene).min_contact_arm = 1.1e-3;
                            step_of_the_core(&scene, placed)
                        },
                        ..CORE
                    })
            .mistake("α without effect", Model {
                        meeting: |scene| lab::interaction(scene).alpha = 1e-300,
                        ..CORE
                    })
            .check(extreme_suspensions),
        Case::program("extreme-scenes")
            .claim("Scenes of free rods end with finite means and tr⟨pp⟩ = 1: G from 10⁻³⁰ to 10³⁰ 1/s, r_e \
                    from 10⁻⁸ to 10⁸, σ at its limit, both poles, the flip, 10⁴ periods, and extension to a \
                    strain of 10⁴ (10⁵ and 10⁶ in a full run), which aligns every rod.")
            .source("eqs 3, 4, 11, 12, 15")
            .equations(&["3", "4", "11", "15"])
            .subject(whole_run as Program)
            .mistake("a thousandth of the strain", |scene| {
                    let mut short = scene.clone();
                    short.time.strain = scene.time.strain.map(|strain| 1e-3 * strain);
                    whole_run(&short)
                })
            .mistake("the plain exponential", |scene| by_exponential(scene, true))
            .mistake("the plain exponential, not rescaled", |scene| {
                    by_exponential(scene, false)
                })
            .check(extreme_scenes),
    ]
}

fn extreme_suspensions(model: &Model, effort: &Effort) -> Vec<Evidence> {
    let mut length = 0.0f64;
    let mut stopped = 0.0;
    let mut trace = 0.0f64;
    for scene in scenes(effort) {
        let mut suspension = lab::stepped(&scene, 0);
        stopped += f64::from(run(&mut suspension, 300).is_none());
        for p in (model.directions)(&suspension) {
            length = larger(length, off_length(&p));
        }
        let ended = whole_run(&scene);
        trace = larger(trace, ended.trace);
        stopped += f64::from(!ended.finite);
    }
    let (placed, unlike) = placed::ends(model.pair, effort);
    for p in placed {
        length = larger(length, off_length(&p));
    }
    vec![
        Evidence::within("largest ||p| − 1|", length, LENGTH, LENGTH_BECAUSE),
        Evidence::within("largest |tr⟨pp⟩ − 1| of whole runs", trace, TRACE, TRACE_BECAUSE),
        Evidence::exact(
            "rods that met although n = 10⁻³⁰ per cm³, or did not although α = 10³⁰⁰",
            meetings(model, effort),
        ),
        Evidence::exact("runs that stopped or had a mean that is not finite", stopped),
        Evidence::exact(
            "pairs put down by hand that did not turn, or did not stop with rod, step, seed and arm \
             where the kick overflows",
            unlike,
        ),
    ]
}

/// tr⟨pp⟩ is the mean of |p|².
const TRACE: f64 = 64.0 * f64::EPSILON;
const TRACE_BECAUSE: &str =
    "2 · 4 ulp of |p|², and the roundings of a mean over twenty rods and two replicas";

/// How a scene ended.
struct Ended {
    /// The largest |tr⟨pp⟩ − 1|.
    trace: f64,
    /// Whether it ended, with finite means and standard errors.
    finite: bool,
    /// X̄₁ at the end.
    last_x1: f64,
}

impl Ended {
    /// It stopped, or had a result that is no number: it is counted, and says nothing else.
    const LOST: Self = Self {
        trace: 0.0,
        finite: false,
        last_x1: 1.0,
    };
}

/// Runs a scene as the program does.
fn whole_run(scene: &Scene) -> Ended {
    let mut scene = scene.clone();
    scene.ensemble.replicas = 2;
    let Ok(results) = ensemble::run(&lab::plan(&scene), || ()) else {
        return Ended::LOST;
    };
    let mut channels = results.series.iter().flat_map(|series| &series.columns);
    let finite =
        channels.all(|channel| (channel.mean.iter().chain(&channel.se)).all(|value| value.is_finite()));
    let mean = |name: &str, output: usize| {
        results
            .column(name)
            .map_or(f64::NAN, |channel| channel.mean[output])
    };
    if !finite {
        return Ended::LOST;
    }
    let trace = |output: usize| {
        (["a11", "a22", "a33"]
            .map(|name| mean(name, output))
            .iter()
            .sum::<f64>()
            - 1.0)
            .abs()
    };
    let last = results.times.len() - 1;
    Ended {
        trace: (0..=last).map(trace).fold(0.0, larger),
        finite,
        last_x1: mean("x1", last),
    }
}

/// One rod at the end of a scene by q = exp(At) p as it stands: no growth is shifted away, no turn taken out.
fn by_exponential(scene: &Scene, rescaled: bool) -> Ended {
    let plan = lab::plan(scene);
    let flow = plan.flow();
    let r = scene.particles.aspect_ratio;
    let strain = (scene.time.strain).or(scene.time.periods.map(|periods| periods * strain_per_period(r)));
    let a = flow.vorticity() + shape_factor(r) * flow.strain_rate();
    let map: Matrix3<f64> = (a * (strain.unwrap_or(0.0) / flow.magnitude_per_s())).exp();
    let q = map * Vector3::new(0.6, 0.0, 0.8);
    let p = if rescaled { q.normalize() } else { q };
    if !p.norm_squared().is_finite() {
        return Ended::LOST;
    }
    Ended {
        trace: (p.norm_squared() - 1.0).abs(),
        finite: true,
        last_x1: p.x.abs(),
    }
}

/// What is enough where there are very many outputs.
const FEW: [Observable; 2] = [Observable::Projections, Observable::OrientationTensor];

fn extreme_scenes(program: &Program, effort: &Effort) -> Vec<Evidence> {
    let scene = |change: &dyn Fn(&mut Scene)| {
        let mut scene = lab::free_scene(effort);
        scene.particles.count = 5;
        scene.output.observables = Observable::ALL.to_vec();
        change(&mut scene);
        scene
    };
    let mut scenes = Vec::new();
    for r in ASPECT_RATIOS {
        for g in [1e-30, 1e30] {
            scenes.push(scene(&|scene| {
                scene.particles.aspect_ratio = r;
                scene.flow.shear_rate_per_s = Some(g);
                scene.time.outputs_per_period = Some(4);
            }));
        }
        for (phi_deg, theta_deg) in [
            (0.0, 0.0),
            (0.0, 180.0),
            (0.0, 90.0),
            (180.0, 90.0),
            (90.0, 90.0),
            (0.0, 1e-300),
        ] {
            scenes.push(scene(&|scene| {
                scene.particles.aspect_ratio = r;
                scene.particles.orientation = Orientation::Given { phi_deg, theta_deg };
                scene.time.outputs_per_period = Some(4);
            }));
        }
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
        scene.time.periods = Some(effort.pick(1e4, 1e5));
        scene.time.outputs_per_period = Some(1);
    }));
    let (mut trace, mut failed, mut apart) = (0.0, 0.0, 0.0);
    for scene in &scenes {
        let ended = program(scene);
        trace = larger(trace, ended.trace);
        failed += f64::from(!ended.finite);
    }
    let longest = effort.pick(1e4, 1e6);
    for (e, strain) in [(1e-30, 1e3), (1.0, longest), (1e30, 1e3)] {
        for rows in [[e, -e, 0.0], [e, -0.5 * e, -0.5 * e]] {
            for r in [1.5, 1e8] {
                let ended = program(&scene(&|scene| {
                    let [a, b, c] = rows;
                    scene.flow.shear_rate_per_s = None;
                    scene.flow.gradient_per_s = Some([[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]);
                    scene.particles.aspect_ratio = r;
                    scene.particles.count = 1;
                    scene.time.periods = None;
                    scene.time.strain = Some(strain);
                    scene.output.observables = FEW.to_vec();
                    scene.time.outputs_per_strain = Some(1);
                }));
                trace = larger(trace, ended.trace);
                failed += f64::from(!ended.finite);
                apart = larger(apart, (ended.last_x1 - 1.0).abs());
            }
        }
    }
    vec![
        Evidence::exact("scenes that stopped or had a result that is not finite", failed),
        Evidence::within("largest |tr⟨pp⟩ − 1|", trace, TRACE, TRACE_BECAUSE),
        Evidence::within(
            "largest |X̄₁ − 1| at the end of an extension",
            apart,
            LENGTH,
            LENGTH_BECAUSE,
        ),
    ]
}

/// Scenes in which rods meet although they are far apart, or never although everything reaches.
fn meetings(model: &Model, effort: &Effort) -> f64 {
    let met = |change: fn(&mut Scene)| {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.count = 20;
        change(&mut scene);
        (model.meeting)(&mut scene);
        ensemble::run(&lab::plan(&scene), || ())
            .map_or(f64::NAN, |results| results.counters.collisions as f64)
    };
    let thin = met(|scene| lab::interaction(scene).concentration_per_cm3 = 1e-30);
    let reaching = met(|scene| lab::interaction(scene).alpha = 1e300);
    f64::from(thin != 0.0) + f64::from(reaching.is_nan() || reaching < 1.0)
}

fn run(suspension: &mut Suspension, steps: usize) -> Option<()> {
    (0..steps).try_for_each(|_| suspension.step().ok().map(|_| ()))
}

fn scenes(effort: &Effort) -> Vec<Scene> {
    let scene = |change: fn(&mut Scene)| {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.count = 20;
        scene.output.observables = Observable::ALL.to_vec();
        change(&mut scene);
        scene
    };
    vec![
        scene(|scene| lab::interaction(scene).concentration_per_cm3 = 1e30),
        scene(|scene| lab::interaction(scene).concentration_per_cm3 = 1e-30),
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
            scene.time.steps_per_period = Some(200);
        }),
        scene(|scene| {
            // Every rod parallel to every other: no contact line.
            scene.particles.orientation = Orientation::Given {
                phi_deg: 90.0,
                theta_deg: 0.0,
            };
            lab::interaction(scene).alpha = 1e3;
        }),
        scene(|scene| {
            lab::interaction(scene).update = Update::Angles;
            lab::interaction(scene).alpha = 1e3;
        }),
        scene(|scene| scene.flow.shear_rate_per_s = Some(1e-30)),
        scene(|scene| scene.flow.shear_rate_per_s = Some(1e30)),
        scene(|scene| lab::interaction(scene).min_contact_arm = f64::MIN_POSITIVE),
        scene(|scene| {
            scene.time.periods = Some(3e-5);
            scene.time.steps_per_period = Some(10_000_000);
            scene.time.outputs_per_period = Some(100_000);
            lab::interaction(scene).alpha = 1e3;
        }),
        scene(|scene| {
            scene.time.steps_per_period = Some(1);
            scene.time.outputs_per_period = Some(1);
            lab::interaction(scene).alpha = 1e3;
        }),
    ]
}

/// The core's directions a step later, by p + ṗΔt.
fn stepped_by_euler(suspension: &Suspension) -> Vec<Vector3<f64>> {
    let rods = suspension
        .directions()
        .into_iter()
        .zip(suspension.aspect_ratios());
    rods.map(|(p, r)| p + 1e-3 * couette_rate(&p, shape_factor(r), 1.0))
        .collect()
}
