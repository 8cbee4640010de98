//! The core where it is stiff or extreme: no NaN, no panic, |p| = 1 to 4 ulp, C to its bound.

use super::lab;
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Kind};
use nalgebra::{Matrix3, UnitVector3, Vector3};
use shearbed::flow::VelocityGradient;
use shearbed::propagator::Propagator;
use shearbed::run::run_replica;
use shearbed::scene::{Orientation, Scene, Update};
use shearbed::{Observable, Suspension, orientation};

/// The direction after a number of turns, of a rod of aspect ratio r at the shear rate G.
type Motion = fn(f64, f64, &UnitVector3<f64>, f64) -> Vector3<f64>;
/// The direction after a time in s in any flow.
type FlowMotion = fn(&VelocityGradient, f64, &UnitVector3<f64>, f64) -> Vector3<f64>;
/// What a control does to the directions before they are judged.
type Spoil = fn(Vec<Vector3<f64>>) -> Vec<Vector3<f64>>;

pub fn cases() -> Vec<Case> {
    let about = |name, claim, source, equations| About {
        name,
        kind: Kind::Verification,
        claim,
        source,
        equations,
        statistical_checks: 0,
    };
    vec![
        Case::new(
            about(
                "extreme-motion",
                "Free rods in plane Couette flow keep |p| = 1 to 4 ulp and C_b to round-off, for r_e from 10⁻⁸ to 10⁸, G from 10⁻³⁰ to 10³⁰ 1/s, 10⁻⁹ to 10⁸ turns, from any start.",
                "eqs 13, 15, A.4, A.5",
                &["13", "15"],
            ),
            exact as Motion,
            vec![
                ("q not rescaled", |r, g, p, turns| {
                    let map = couette(g, r).map_over_turns(turns);
                    map.map_or(Vector3::repeat(f64::NAN), |map| map * p.as_ref())
                }),
                ("through tan θ and φ (A.4, A.5)", |r, _, p, turns| {
                    let c = orientation::orbit_constant(p, r);
                    let phi = shearbed::jeffery::phi_rad(r, turns);
                    orientation::from_angles(phi, shearbed::jeffery::theta_rad(c, r, phi)).into_inner()
                }),
            ],
            extreme_motion,
        ),
        Case::new(
            about(
                "extreme-flows",
                "In other flows rods keep |p| = 1 to 4 ulp up to a strain of 10⁶ and beyond, and end where the flow leads.",
                "eq. 3, A.1",
                &["3", "A.1"],
            ),
            (|flow, r, p, time_s| Propagator::new(flow, r).after(p, time_s).into_inner()) as FlowMotion,
            vec![("the plain exponential", |flow, r, p, time_s| {
                let a = flow.vorticity() + shearbed::jeffery::shape_factor(r) * flow.strain_rate();
                ((a * time_s).exp() * p.as_ref()).normalize()
            })],
            extreme_flows,
        ),
        Case::new(
            about(
                "extreme-suspensions",
                "Interacting rods stay finite and |p| = 1 to 4 ulp: dense and thin, N = 1 and 2, α = 0 and huge, m from 0.1 to 50, σ at its limit, parallel to one ulp, arms to the smallest normal number. A kick that overflows stops the run and names rod, step, seed and arm.",
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
    ]
}

fn couette(g: f64, r: f64) -> Propagator {
    Propagator::new(
        &VelocityGradient::plane_couette(g).expect("a finite shear rate"),
        r,
    )
}

fn exact(r: f64, g: f64, p: &UnitVector3<f64>, turns: f64) -> Vector3<f64> {
    let end = couette(g, r).after_turns(p, turns);
    end.map_or(Vector3::repeat(f64::NAN), UnitVector3::into_inner)
}

/// 4 ulp of 1, as rounding of |p| itself allows.
const LENGTH: f64 = 4.0 * f64::EPSILON;
const LENGTH_BECAUSE: &str = "4 ulp of 1";

fn off_length(p: &Vector3<f64>) -> f64 {
    (p.norm() - 1.0).abs()
}

/// The larger; NaN stays.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else {
        a.max(b)
    }
}

fn extreme_motion(motion: &Motion, _: &Effort) -> Vec<Evidence> {
    let tiny = |p: [f64; 3]| UnitVector3::new_normalize(Vector3::from(p));
    let starts = [
        // Both poles, the flip, C = 0, 10⁻³⁰⁰, 10³⁰⁰, ∞, and one in between.
        tiny([0.0, 0.0, 1.0]),
        tiny([0.0, 0.0, -1.0]),
        tiny([1.0, 0.0, 0.0]),
        tiny([0.0, 1.0, 0.0]),
        tiny([1e-300, 0.0, 1.0]),
        tiny([1.0, 0.0, 1e-300]),
        tiny([1e-9, 1.0, 1e-9]),
        tiny([0.3, -0.5, 0.8]),
    ];
    let (mut length, mut drift) = (0.0f64, 0.0f64);
    for r in [1e-8, 1e-3, 1.0, 1.0 + 1e-12, 1.01, 11.6, 1e4, 1e8] {
        for g in [1e-30, 0.5, 1e30] {
            for turns in [1e-9, 1e-3, 0.25, 0.37, 1.0 / 3.0, 0.5, 1.0, 1e3, 1e8, 1e8 + 0.37] {
                for start in &starts {
                    let p = motion(r, g, start, turns);
                    let bounded = |p: &Vector3<f64>| orientation::bounded_orbit_constant([p.x, p.y, p.z], r);
                    length = worse(length, off_length(&p));
                    drift = worse(drift, (bounded(&p) - bounded(start)).abs());
                }
            }
        }
    }
    vec![
        Evidence::new("largest ||p| − 1|", Rule::within(length, LENGTH, LENGTH_BECAUSE)),
        Evidence::new(
            "largest change of C_b",
            Rule::within(
                drift,
                8.0 * f64::EPSILON,
                "one evaluation's roundings; C_b ≤ 1 has slope ≤ 1 in ln C / 4",
            ),
        ),
    ]
}

fn extreme_flows(motion: &FlowMotion, _: &Effort) -> Vec<Evidence> {
    let (mut length, mut end) = (0.0f64, 0.0f64);
    // Flows that lead every rod of r_e > 1 to axis 1, and the strain rate of each.
    for rows in [
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, -0.5]],
        [[1.0, 0.0, 0.0], [0.0, -0.3, -2.0], [0.0, 2.0, -0.7]],
    ] {
        for rate in [1e-30, 1.0, 1e30] {
            let flow = VelocityGradient::new(Matrix3::from_fn(|i, j| rows[i][j] * rate)).expect("finite");
            for r in [1.5, 11.6, 1e8] {
                for (phi, theta) in [(0.3, 1.0), (1.57, 0.01), (3.0, 3.1)] {
                    let start = orientation::from_angles(phi, theta);
                    for strain in [1e-9, 1.0, 1e2, 1e6, 1e12] {
                        let p = motion(&flow, r, &start, strain / rate);
                        length = worse(length, off_length(&p));
                        if strain >= 1e6 {
                            end = worse(end, p.y.hypot(p.z) * start.x.abs());
                        }
                    }
                }
            }
        }
    }
    vec![
        Evidence::new("largest ||p| − 1|", Rule::within(length, LENGTH, LENGTH_BECAUSE)),
        Evidence::new(
            "distance from the flow's axis at a strain of 10⁶ or more, times |p_1| at first",
            Rule::within(
                end,
                LENGTH,
                "e^{−Λ·10⁶} is 0; the map is known to some ε, which a start near the dividing plane grows by 1/|p_1|",
            ),
        ),
    ]
}

fn extreme_suspensions(spoil: &Spoil, _: &Effort) -> Vec<Evidence> {
    let mut length = 0.0f64;
    let mut stopped = 0.0;
    for scene in scenes() {
        let mut suspension = lab::stepped(&scene, 0);
        stopped += f64::from(run(&mut suspension, 300).is_none());
        for p in spoil(suspension.directions()) {
            length = worse(length, off_length(&p));
        }
        let means = run_replica(&lab::plan(&scene), 0);
        let finite = means.is_ok_and(|run| run.sums.iter().all(|sum| sum.value.is_finite()));
        stopped += f64::from(!finite);
    }
    let (placed, refused) = placed_pairs();
    for p in spoil(placed) {
        length = worse(length, off_length(&p));
    }
    vec![
        Evidence::new("largest ||p| − 1|", Rule::within(length, LENGTH, LENGTH_BECAUSE)),
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

fn run(suspension: &mut Suspension, steps: usize) -> Option<()> {
    (0..steps).try_for_each(|_| suspension.step().ok().map(|_| ()))
}

fn scenes() -> Vec<Scene> {
    let scene = |change: fn(&mut Scene)| {
        let mut scene = lab::interacting_scene();
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
            scene.particles.aspect_ratio_sd_percent = 5.5;
            lab::interaction(scene).alpha = 1e3;
        }),
        scene(|scene| scene.particles.aspect_ratio = 1.0 + 1e-12),
        scene(|scene| scene.particles.aspect_ratio = 1e8),
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
        scene(|scene| {
            scene.time.steps_per_period = Some(1);
            scene.time.outputs_per_period = Some(1);
            lab::interaction(scene).alpha = 1e3;
        }),
    ]
}

/// Directions of pairs put down by hand after one step, and how many kicks that overflow went unnoticed.
fn placed_pairs() -> (Vec<Vector3<f64>>, f64) {
    let mut scene = lab::interacting_scene();
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
