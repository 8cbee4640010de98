//! Interacting rods, and whole scenes as the program runs them, where they are extreme.

use super::extremes::{LENGTH, LENGTH_BECAUSE, off_length, worse};
use super::lab;
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use crate::stability::map::ASPECT_RATIOS;
use nalgebra::{UnitVector3, Vector3};
use shearbed::scene::{Orientation, Scene, Update};
use shearbed::{Observable, Suspension, ensemble};

/// What a control does to the directions before they are judged.
type Spoil = fn(Vec<Vector3<f64>>) -> Vec<Vector3<f64>>;
/// What runs a scene.
type Program = fn(&Scene) -> Ended;

pub fn cases() -> Vec<Case> {
    let about = |name, claim, source, equations| About {
        name,
        judges: Judges::Program,
        claim,
        source,
        equations,
    };
    vec![
        Case::new(
            about(
                "extreme-suspensions",
                "Interacting rods stay finite and |p| = 1 to 4 ulp: dense and thin, N = 1 and 2, α = 0 and huge, m from 0.1 to 50, σ at its limit, G from 10⁻³⁰ to 10³⁰ 1/s, steps from 10⁻⁷ T to T, parallel to one ulp, arms to the smallest normal number. A kick that overflows stops the run and names rod, step, seed and arm.",
                "eqs 5–14, A.7–A.14",
                &["7", "14", "A.13", "A.14"],
            ),
            (|directions| directions) as Spoil,
            vec![
                ("a length off by 10⁻¹⁴", |mut directions| {
                    directions[0] *= 1.0 + 1e-14;
                    directions
                }),
                ("one NaN", |mut directions| {
                    directions[0].z = f64::NAN;
                    directions
                }),
            ],
            extreme_suspensions,
        ),
        Case::new(
            about(
                "extreme-scenes",
                "Scenes of free rods end with finite means and tr⟨pp⟩ = 1: G from 10⁻³⁰ to 10³⁰ 1/s, r_e from 10⁻⁸ to 10⁸, σ at \
                 its limit, both poles, the flip, 10⁴ periods, and extension to a strain of 10⁴ (10⁵ and 10⁶ in a full run), which aligns \
                 every rod.",
                "eqs 3, 4, 11, 12, 15",
                &["3", "4", "11", "15"],
            ),
            whole_run as Program,
            vec![
                ("a thousandth of the strain", |scene| {
                    let mut short = scene.clone();
                    short.time.strain = scene.time.strain.map(|strain| 1e-3 * strain);
                    whole_run(&short)
                }),
                ("a mean that is no number", |scene| Ended {
                    finite: false,
                    ..whole_run(scene)
                }),
                ("lengths off by 10⁻¹³", |scene| {
                    let ended = whole_run(scene);
                    Ended {
                        trace: ended.trace + 2e-13,
                        ..ended
                    }
                }),
            ],
            extreme_scenes,
        ),
    ]
}

fn extreme_suspensions(spoil: &Spoil, effort: &Effort) -> Vec<Evidence> {
    let mut length = 0.0f64;
    let mut stopped = 0.0;
    let mut trace = 0.0f64;
    for scene in scenes(effort) {
        let mut suspension = lab::stepped(&scene, 0);
        stopped += f64::from(run(&mut suspension, 300).is_none());
        for p in spoil(suspension.directions()) {
            length = worse(length, off_length(&p));
        }
        let ended = whole_run(&scene);
        trace = worse(trace, ended.trace);
        stopped += f64::from(!ended.finite);
    }
    let (placed, refused) = placed_pairs(effort);
    for p in spoil(placed) {
        length = worse(length, off_length(&p));
    }
    vec![
        Evidence::new("largest ||p| − 1|", Rule::within(length, LENGTH, LENGTH_BECAUSE)),
        Evidence::new(
            "largest |tr⟨pp⟩ − 1| of whole runs",
            Rule::within(trace, TRACE, TRACE_BECAUSE),
        ),
        Evidence::new(
            "rods that met although n = 10⁻³⁰ per cm³, or did not although α = 10³⁰⁰",
            Rule::exact(meetings(effort)),
        ),
        Evidence::new(
            "runs that stopped or had a mean that is not finite",
            Rule::exact(stopped),
        ),
        Evidence::new(
            "pairs whose kick overflows and that did not stop with the rod, the step and the arm",
            Rule::exact(refused),
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

/// Runs a scene as the program does.
fn whole_run(scene: &Scene) -> Ended {
    let mut scene = scene.clone();
    scene.ensemble.replicas = 2;
    let Ok(results) = ensemble::run(&lab::plan(&scene), || ()) else {
        return Ended {
            trace: f64::NAN,
            finite: false,
            last_x1: f64::NAN,
        };
    };
    let mut channels = results.series.iter().flat_map(|series| &series.channels);
    let finite =
        channels.all(|channel| (channel.mean.iter().chain(&channel.se)).all(|value| value.is_finite()));
    let mean = |name: &str, output: usize| {
        results
            .channel(name)
            .map_or(f64::NAN, |channel| channel.mean[output])
    };
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
        trace: (0..=last).map(trace).fold(0.0, worse),
        finite,
        last_x1: mean("x1", last),
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
        trace = worse(trace, ended.trace);
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
                trace = worse(trace, ended.trace);
                failed += f64::from(!ended.finite);
                apart = worse(apart, (ended.last_x1 - 1.0).abs());
            }
        }
    }
    vec![
        Evidence::new(
            "scenes that stopped or had a result that is not finite",
            Rule::exact(failed),
        ),
        Evidence::new("largest |tr⟨pp⟩ − 1|", Rule::within(trace, TRACE, TRACE_BECAUSE)),
        Evidence::new(
            "largest |X̄₁ − 1| at the end of an extension",
            Rule::within(apart, LENGTH, LENGTH_BECAUSE),
        ),
    ]
}

/// Scenes in which rods meet although they are far apart, or never although everything reaches.
fn meetings(effort: &Effort) -> f64 {
    let met = |change: fn(&mut Scene)| {
        let mut scene = lab::interacting_scene(effort);
        scene.particles.count = 20;
        change(&mut scene);
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

/// Directions of pairs put down by hand after one step, and how many kicks that overflow went unnoticed.
fn placed_pairs(effort: &Effort) -> (Vec<Vector3<f64>>, f64) {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = 2;
    lab::interaction(&mut scene).alpha = 1e300;
    let x = UnitVector3::new_normalize(Vector3::new(1.0, 0.0, 1.0));
    let ulp = UnitVector3::new_normalize(Vector3::new(1.0, f64::EPSILON, 1.0));
    let y = Vector3::y_axis();
    let mut directions = Vec::new();
    let mut unnoticed = 0.0;
    // B beside A by `arm` along A's axis: A's arm is that, and ℓ has a part along the flow's difference.
    for (second, arm, overflows) in [
        (ulp, 0.5, false),
        (ulp, 1e-3, false),
        (y, 1e-3, false),
        (y, 1e-150, false),
        (y, f64::MIN_POSITIVE, false),
        (y, 1e-320, true),
    ] {
        let mut suspension = lab::suspension(&scene, 0);
        let middle = 0.5 * suspension.side_in_lengths();
        let place = |offset: f64| vec![0.0, offset];
        let at = [place(arm * x.x), vec![middle, middle + 0.3], place(arm * x.z)];
        let placed = suspension.place(at, &[x, second]);
        match (placed, suspension.step()) {
            (Some(()), Ok(_)) if !overflows => directions.extend(suspension.directions()),
            (Some(()), Err(error)) if overflows => {
                let text = error.to_string();
                unnoticed += f64::from(
                    !["rod", "step 0", "seed 1", "arm"]
                        .iter()
                        .all(|word| text.contains(word)),
                );
            }
            _ => unnoticed += 1.0,
        }
    }
    (directions, unnoticed)
}
