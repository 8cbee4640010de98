//! Free suspensions against their closed forms: phase means, the orbit constant's distribution, plateaus, the
//! damping by unequal aspect ratios, rods started in the shear plane.

use super::lab::{self, Sample, per_replica};
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use crate::oracle::{closed_form, isotropic, quadrature};
use nalgebra::UnitVector3;
use shearbed::ensemble;
use shearbed::flow::VelocityGradient;
use shearbed::orientation;
use shearbed::propagator::Propagator;
use shearbed::scene::{Orientation, Scene};
use std::f64::consts::{PI, SQRT_2, TAU};

/// A change to the scene that the model runs; the expectation stays that of the unchanged scene.
type Mend = fn(&mut Scene);
/// The direction after `turns` of a rod of aspect ratio r.
type Motion = fn(f64, &UnitVector3<f64>, f64) -> UnitVector3<f64>;

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            About {
                name: "phase-means",
                judges: Judges::Core,
                claim: "The time means of |p_i| of a rod on the orbit C are an elliptic integral, an arcsinh and an arcsine.",
                source: "eqs 13, 17",
                equations: &["13", "17"],
            },
            exact as Motion,
            vec![
                ("r_e 1 % longer", |r, p, turns| exact(1.01 * r, p, turns)),
                ("φ growing evenly", |_, p, turns| {
                    let (phi, theta) = orientation::angles(p);
                    orientation::from_angles(phi + TAU * turns, theta)
                }),
            ],
            phase_means,
        ),
        Case::new(
            About {
                name: "orbit-distribution",
                judges: Judges::Core,
                claim: "Isotropic rods have the closed distribution of C, and free motion leaves every rod's C alone.",
                source: "eqs 12, 13",
                equations: &["12", "13"],
            },
            (|_| {}) as Mend,
            vec![
                ("r_e 10 % longer", |scene| scene.particles.aspect_ratio *= 1.1),
                ("every rod at 45°", |scene| {
                    scene.particles.orientation = Orientation::Given {
                        phi_deg: 45.0,
                        theta_deg: 45.0,
                    };
                }),
                ("rods in collision", |scene| lab::interaction(scene).alpha = 0.5),
            ],
            orbit_distribution,
        ),
        Case::new(
            About {
                name: "free-plateau",
                judges: Judges::Core,
                claim: "Free rods of Gaussian aspect ratio settle at the phase means averaged over isotropic orbits.",
                source: "eqs 16, 17",
                equations: &["16", "17"],
            },
            (|_| {}) as Mend,
            vec![
                ("no spread: the phases stay together", |scene| {
                    scene.particles.aspect_ratio_sd_percent = 0.0
                }),
                ("r_e 5 % longer", |scene| scene.particles.aspect_ratio *= 1.05),
            ],
            plateau,
        ),
        Case::new(
            About {
                name: "spread-damping",
                judges: Judges::Core,
                claim: "A Gaussian spread damps the first harmonic of X̄_1 by 1/e at t/T = 1/(2√2 π s), s = σ(r_e² − 1)/(r_e² + 1), to first order in σ.",
                source: "eqs 4, 11, 15; Fig. 9",
                equations: &["11", "15"],
            },
            1.0 as Factor,
            vec![("σ 15 % too wide", 1.15), ("no spread", 0.0)],
            spread_damping,
        ),
        Case::new(
            About {
                name: "in-plane-start",
                judges: Judges::Core,
                claim: "Free rods started together in the shear plane follow |cos φ|, |sin φ| of A.4 and never leave the plane.",
                source: "A.4, eqs 4, 20",
                equations: &["4", "20", "A.4"],
            },
            (|_| {}) as Mend,
            vec![
                ("r_e 1 % longer", |scene| scene.particles.aspect_ratio *= 1.01),
                ("1° out of the plane", |scene| {
                    scene.particles.orientation = Orientation::Given {
                        phi_deg: 30.0,
                        theta_deg: 89.0,
                    };
                }),
            ],
            in_plane_start,
        ),
    ]
}

fn exact(r: f64, p: &UnitVector3<f64>, turns: f64) -> UnitVector3<f64> {
    let flow = VelocityGradient::plane_couette(0.5).expect("a finite shear rate");
    Propagator::new(&flow, r)
        .after_turns(p, turns)
        .expect("plane Couette flow has a period")
}

fn phase_means(motion: &Motion, _: &Effort) -> Vec<Evidence> {
    let mut worst = 0.0f64;
    for r in [1.0f64, 1.5, 5.0, 11.6, 50.0] {
        for c in [0.05, 0.3, 1.0, 4.0, 100.0] {
            // On φ = 0, eq. 13 reads C = tan θ.
            let start = orientation::from_angles(0.0, f64::atan(c));
            let expected = closed_form::phase_means(c, r);
            let edge = (1.0 / r).atan() / TAU;
            let breaks = [
                0.0,
                (0.25 * edge).min(0.05),
                edge.min(0.1),
                (4.0 * edge).min(0.2),
                0.25,
            ];
            for (axis, expected) in expected.into_iter().enumerate() {
                let value = |turns: f64| motion(r, &start, turns)[axis].abs();
                let mean = 4.0 * quadrature::integrate(value, &breaks, 1e-13).value;
                worst = worst.max((mean - expected).abs());
            }
        }
    }
    let because = "the quadrature's own tolerance, 4·10⁻¹³, with room for its panels";
    vec![Evidence::new(
        "largest difference of a time mean",
        Rule::within(worst, 1e-11, because),
    )]
}

fn orbit_distribution(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = effort.pick(4000, 20_000);
    lab::interaction(&mut scene).alpha = 0.0;
    let r = scene.particles.aspect_ratio;
    mend(&mut scene);
    let mut suspension = lab::stepped(&scene, 0);
    let constants = |suspension: &shearbed::Suspension| -> Vec<f64> {
        let directions = suspension.directions();
        directions
            .iter()
            .map(|p| orientation::bounded_orbit_constant([p.x, p.y, p.z], r))
            .collect()
    };
    let before = constants(&suspension);
    let mut failed = false;
    for _ in 0..137 {
        failed |= suspension.step().is_err();
    }
    let after = constants(&suspension);
    let change = before
        .iter()
        .zip(&after)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    let uniform = |bounded: &[f64]| {
        let levels = bounded
            .iter()
            .map(|&c| closed_form::orbit_constant_cdf(c, r))
            .collect();
        lab::uniform(
            levels,
            0.08,
            "Kolmogorov–Smirnov; r_e 10 % longer shows at 4000 rods",
        )
    };
    vec![
        Evidence::new(
            "p of C_b having the closed distribution at t = 0",
            uniform(&before),
        ),
        Evidence::new(
            "p of C_b having the closed distribution after 137 steps",
            uniform(&after),
        ),
        Evidence::new(
            "largest change of a rod's C_b",
            Rule::within(
                if failed { f64::NAN } else { change },
                1e-14,
                "round-off of one evaluation",
            ),
        ),
    ]
}

fn plateau(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::free_scene(effort);
    scene.particles.count = effort.pick(40_000, 400_000);
    scene.particles.aspect_ratio_sd_percent = 3.6;
    // A quarter period past t/T = 100, where rods in phase would be far from their mean.
    scene.time.periods = Some(100.25);
    scene.time.outputs_per_period = Some(4);
    let (r, sd) = (
        scene.particles.aspect_ratio,
        scene.particles.aspect_ratio_sd_percent,
    );
    mend(&mut scene);
    let results = ensemble::run(&lab::plan(&scene), || ());
    let spread = isotropic::mean_projections_polydisperse(r, sd, 100.25);
    let single = isotropic::plateau_projections(r);
    let mut evidence = Vec::new();
    for (axis, name) in ["x1", "x2", "x3"].into_iter().enumerate() {
        let channel = results.as_ref().ok().and_then(|results| results.channel(name));
        let (mean, se) = channel.map_or((f64::NAN, f64::NAN), |c| (c.mean[401], c.se[401]));
        let sample = Sample {
            mean,
            se,
            samples: scene.particles.count as u64,
        };
        evidence.push(Evidence::new(
            format!("X̄_{} at t/T = 100¼, against the quadrature over r_e", axis + 1),
            sample.is(
                spread[axis],
                0.0,
                2e-3,
                "the quadrature is exact to 10⁻⁶; independent rods",
            ),
        ));
        evidence.push(Evidence::new(
            format!(
                "X̄_{} at t/T = 100¼, against the phase means at the mean r_e",
                axis + 1
            ),
            sample.is(
                single[axis],
                1e-3,
                2e-3,
                "the plateau's curvature in r_e gives a shift of order σ² = 0.0013",
            ),
        ));
    }
    evidence
}

/// By how much the model's σ is wrong.
type Factor = f64;

/// The first harmonic's amplitude around t, ∫ X̄_1 cos(4πt/T) over half a period, at t* against t = ¼.
fn spread_damping(factor: &Factor, effort: &Effort) -> Vec<Evidence> {
    let mut evidence = Vec::new();
    for sd in [1.8, 3.6] {
        let mut scene = lab::free_scene(effort);
        let r = scene.particles.aspect_ratio;
        let s = sd / 100.0 * (r * r - 1.0) / (r * r + 1.0);
        let end = 1.0 / (2.0 * SQRT_2 * PI * s);
        scene.particles.count = 1000;
        scene.particles.aspect_ratio_sd_percent = sd * factor;
        scene.time.outputs_per_period = Some(40);
        scene.time.periods = Some(end.round() + 1.0);
        // Half a period is 20 outputs; the window closest to the predicted time.
        let middle = (end * 40.0).round() as usize;
        let harmonic = |from: usize, value: &dyn Fn(usize) -> f64| {
            (from..from + 20)
                .map(|k| value(k) * (TAU * k as f64 / 20.0).cos())
                .sum::<f64>()
                / 10.0
        };
        let quadrature = |k: usize| isotropic::mean_projections_polydisperse(r, sd, k as f64 / 40.0)[0];
        let first = harmonic(0, &|k| isotropic::mean_projections(r, k as f64 / 40.0)[0]);
        let expected = harmonic(middle - 10, &quadrature) / first;
        let found = per_replica(&scene, effort.pick(100, 1000), |means| {
            harmonic(middle - 10, &|k| means.at(k, 0)) / first
        });
        let at = (middle as f64 - 0.5) / 40.0;
        let what = format!("first harmonic at t/T = {at:.4} over that at once, σ = {sd} %");
        let because = "the quadrature is exact to 10⁻⁶; 0.012 tells the controls apart";
        evidence.push(Evidence::new(
            format!("{what}, against the quadrature"),
            Sample::of(&found).is(expected, 0.0, 0.012, because),
        ));
        evidence.push(Evidence::new(
            format!("{what}, the formula less the quadrature, over σ"),
            Rule::within(
                ((-(at / end).powi(2)).exp() - expected) / (sd / 100.0),
                0.5,
                "first order in σ, with a coefficient of order ½; at σ = 10 % it is off by 0.03 of 0.37 and ends to hold",
            ),
        ));
    }
    evidence
}

fn in_plane_start(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::free_scene(effort);
    scene.particles.orientation = Orientation::Given {
        phi_deg: 30.0,
        theta_deg: 90.0,
    };
    scene.particles.count = 3;
    scene.time.periods = Some(2.0);
    let r = scene.particles.aspect_ratio;
    mend(&mut scene);
    let results = ensemble::run(&lab::plan(&scene), || ());
    let channel = |name: &str| {
        let found = results.as_ref().ok().and_then(|results| results.channel(name));
        found.map_or_else(|| vec![f64::NAN; 101], |channel| channel.mean.clone())
    };
    let (mut worst, [x1, x2, x3]) = (0.0f64, ["x1", "x2", "x3"].map(channel));
    for output in 0..=100 {
        let (phi, _) = closed_form::angles_at(PI / 6.0, PI / 2.0, r, output as f64 / 50.0);
        let error = (x1[output] - phi.cos().abs()).hypot(x2[output] - phi.sin().abs());
        worst = if error.is_nan() {
            f64::NAN
        } else {
            worst.max(error)
        };
    }
    let out_of_plane = x3.iter().copied().fold(0.0, f64::max);
    vec![
        Evidence::new(
            "largest error of (X̄_1, X̄_2)",
            Rule::within(
                worst,
                1e-13,
                "a rounding of the phase, 2π·2ε, grows by r_e at the flip",
            ),
        ),
        Evidence::new(
            "largest X̄_3",
            Rule::within(
                out_of_plane,
                1e-15,
                "cos 90° is 6·10⁻¹⁷, grown by the stretch of q at most r_e-fold",
            ),
        ),
    ]
}
