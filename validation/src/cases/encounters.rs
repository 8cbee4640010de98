//! Who collides, and what the control volume does: P_c, its empirical frequency, replacement.

use super::lab::{self, Sample};
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use rayon::prelude::*;
use shearbed::collision::reach;
use shearbed::jeffery::strain_per_period;
use shearbed::scene::Scene;

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            About {
                name: "collision-probability",
                judges: Judges::Core,
                claim: "The reach s* is where P_c = R, 0 at R = 1 and αa R^{−1/m} for small R, for any α, m > 0.",
                source: "eqs 7, 10",
                equations: &["7", "10"],
            },
            reach as Formula,
            vec![
                ("α missing in P_c's denominator", |r, alpha, m| {
                    alpha * r.powf(-1.0 / m)
                }),
                ("m = 3 whatever m is", |r, alpha, _| reach(r, alpha, 3.0)),
                ("s in rod radii", |r, alpha, m| 0.5 * reach(r, alpha, m)),
                ("the reach of 1 − R", |r, alpha, m| reach(1.0 - r, alpha, m)),
            ],
            limits,
        ),
        Case::new(
            About {
                name: "collision-frequency",
                judges: Judges::Core,
                claim: "In a run, nearest pairs become candidates as often as the sum of their P_c says.",
                source: "eqs 7, 8, 9",
                equations: &["7", "8", "9"],
            },
            (|_| {}) as Mend,
            vec![
                ("α 10 % larger", |scene| lab::interaction(scene).alpha *= 1.1),
                ("m = 2", |scene| lab::interaction(scene).m = 2.0),
                ("rods 10 % longer", |scene| scene.particles.length_mm *= 1.1),
            ],
            frequency,
        ),
        Case::new(
            About {
                name: "replacement",
                judges: Judges::Core,
                claim: "Replacement keeps every rod inside, new rods have x_1 = H√R and x_3 = HR, and the volume stays evenly filled.",
                source: "eqs 12, 14",
                equations: &["12", "14"],
            },
            (|places| places) as Spoil,
            vec![
                ("x_1 = HR for new rods", |mut places| {
                    places.new_x1.iter_mut().for_each(|x| *x *= *x);
                    places
                }),
                ("x_1 of the volume drifts by 10 %", |mut places| {
                    places.end[0].iter_mut().for_each(|x| *x = x.powf(1.1));
                    places
                }),
                ("new rods in the lower half of axis 3", |mut places| {
                    places.new_x3.iter_mut().for_each(|x| *x *= 0.5);
                    places
                }),
                ("x_2 drawn at random, as eq. 14's text has it", |mut places| {
                    places
                        .new_x2_off
                        .iter_mut()
                        .zip(&places.new_x3)
                        .for_each(|(off, random)| *off -= random);
                    places
                }),
                ("a rod left outside", |mut places| {
                    places.end[1][0] = 1.0;
                    places
                }),
            ],
            replacement,
        ),
    ]
}

type Formula = fn(f64, f64, f64) -> f64;

fn limits(reach: &Formula, _: &Effort) -> Vec<Evidence> {
    let (mut nearest, mut far, mut inverse) = (0.0f64, 0.0f64, 0.0f64);
    for alpha in [1e-3f64, 0.1, 0.5, 1.0, 7.0] {
        for m in [0.1, 0.7, 1.0, 3.0, 4.5, 50.0] {
            nearest = nearest.max(reach(1.0, alpha, m).abs());
            // R = 10⁻⁶ᵐ reaches 10⁶ αa, but for one αa.
            far = far.max((reach(1e-6f64.powf(m), alpha, m) / (1e6 * alpha) - 1.0).abs());
            for r in (1..20).map(|k| f64::from(k) / 20.0) {
                // Eq. 7 as printed. Its slope at s* turns the rounding of s* into m roundings of R.
                let p_c = (alpha / (reach(r, alpha, m) + alpha)).powf(m);
                inverse = inverse.max(((p_c - r) / r / (1.0 + m)).abs());
            }
        }
    }
    vec![
        Evidence::new("s* at R = 1", Rule::exact(nearest)),
        Evidence::new(
            "s* over αa R^{−1/m} at R = 10⁻⁶ᵐ, less 1",
            Rule::within(
                far,
                1e-6 * (1.0 + 1e-6),
                "the other term of s*, −αa; a logarithm of up to 691 rounded, over m, is 10⁻¹³",
            ),
        ),
        Evidence::new(
            "P_c at s* over R, less 1, over 1 + m",
            Rule::within(
                inverse,
                8.0 * f64::EPSILON,
                "a logarithm, a power, a quotient: a few roundings",
            ),
        ),
        Evidence::new(
            "eq. 10 by hand: P_c = ⅛ at s = αa",
            Rule::within(reach(0.125, 0.5, 3.0) - 0.5, f64::EPSILON, "roundings of ½"),
        ),
    ]
}

/// A change to the scene that the model runs; the expectation stays that of the unchanged scene.
type Mend = fn(&mut Scene);

/// Candidates less the sum of P_c over all rods and steps: a martingale, so that its increments are
/// uncorrelated and runs with different seeds independent.
fn frequency(mend: &Mend, effort: &Effort) -> Vec<Evidence> {
    let mut evidence = Vec::new();
    for (alpha, m, concentration) in [(0.5, 3.0, 50.0), (0.3, 1.7, 400.0)] {
        let mut scene = lab::interacting_scene(effort);
        let interaction = lab::interaction(&mut scene);
        (
            interaction.alpha,
            interaction.m,
            interaction.concentration_per_cm3,
        ) = (alpha, m, concentration);
        let length_mm = scene.particles.length_mm;
        let mut model = scene.clone();
        mend(&mut model);
        let ratios: Vec<f64> = (0..effort.pick(64, 1024))
            .into_par_iter()
            .map(|replica| {
                let mut suspension = lab::suspension(&model, replica);
                let mut expected = 0.0;
                for _ in 0..100 {
                    // In the rod lengths of the unchanged scene.
                    let unit = model.particles.length_mm / length_mm;
                    expected += expected_candidates(suspension.positions_in_lengths(), unit, alpha, m);
                    if suspension.step().is_err() {
                        return f64::NAN;
                    }
                }
                suspension.counters().candidates as f64 / expected
            })
            .collect();
        evidence.push(Evidence::new(
            format!("candidates over the sum of P_c, α = {alpha}, m = {m}, n = {concentration} per cm³"),
            Sample::of(&ratios).is(1.0, 0.0, 0.012, "unbiased; 1.2 % tells the controls apart"),
        ));
    }
    evidence
}

/// Σ P_c over all rods' nearest neighbours, by looking at every pair.
fn expected_candidates(positions: &[Vec<f64>; 3], unit: f64, alpha: f64, m: f64) -> f64 {
    let count = positions[0].len();
    (0..count)
        .map(|i| {
            let square = |j: usize| {
                (0..3)
                    .map(|k| (positions[k][i] - positions[k][j]).powi(2))
                    .sum::<f64>()
            };
            let nearest = (0..count)
                .filter(|&j| j != i)
                .map(square)
                .fold(f64::INFINITY, f64::min);
            (alpha / (unit * nearest.sqrt() + alpha)).powf(m)
        })
        .sum()
}

/// Places in units of H.
struct Places {
    /// x_2 of new rods less the overshoot modulo H.
    new_x2_off: Vec<f64>,
    new_x1: Vec<f64>,
    new_x3: Vec<f64>,
    end: [Vec<f64>; 3],
    outside: usize,
}

/// What a control does to the places before they are judged.
type Spoil = fn(Places) -> Places;

fn replacement(spoil: &Spoil, effort: &Effort) -> Vec<Evidence> {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = 20_000;
    // Eq. 14 draws x_1 apart from the overshoot, which fills the volume unevenly by O(GΔt): 0.02 in the
    // distribution function at 200 steps per period, 0.001 at this step (docs/model.md).
    scene.time.steps_per_period = Some(effort.pick(4000, 40_000));
    let places = spoil(follow(&scene, effort.pick(200, 2000)));
    let outside = places.outside
        + places
            .end
            .iter()
            .flatten()
            .filter(|x| !(0.0..1.0).contains(*x))
            .count();
    let overshoot_off = places
        .new_x2_off
        .iter()
        .fold(0.0f64, |worst, off| worst.max(off.abs()));
    let squares = places.new_x1.iter().map(|x| x * x).collect();
    let [x1, x2, x3] = places.end;
    let even = "Kolmogorov–Smirnov; a drift of 10 % in the power of x_i shows at 10⁴ rods";
    vec![
        Evidence::new("rods outside the volume", Rule::exact(outside as f64)),
        Evidence::new(
            "largest |x_2 − overshoot modulo H| of new rods, over H",
            Rule::within(
                overshoot_off,
                4.0 * f64::EPSILON,
                "two roundings of the new place",
            ),
        ),
        Evidence::new(
            "p of (x_1/H)² of new rods being uniform",
            lab::uniform(squares, 0.05, "Kolmogorov–Smirnov; x_1 = HR shows at 100"),
        ),
        Evidence::new(
            "p of x_3/H of new rods being uniform",
            lab::uniform(places.new_x3, 0.05, "Kolmogorov–Smirnov"),
        ),
        Evidence::new(
            "p of x_1/H being uniform after a strain of 3.7",
            lab::uniform(x1, 0.036, even),
        ),
        Evidence::new(
            "p of x_2/H being uniform after a strain of 3.7",
            lab::uniform(x2, 0.036, even),
        ),
        Evidence::new(
            "p of x_3/H being uniform after a strain of 3.7",
            lab::uniform(x3, 0.036, even),
        ),
    ]
}

/// Follows a suspension: the places of all new rods, and everyone's at the end.
fn follow(scene: &Scene, steps: usize) -> Places {
    let mut suspension = lab::suspension(scene, 0);
    let side = suspension.side_in_lengths();
    let strain = strain_per_period(scene.particles.aspect_ratio) / scene.steps_per_period() as f64;
    let mut places = Places {
        new_x2_off: Vec::new(),
        new_x1: Vec::new(),
        new_x3: Vec::new(),
        end: Default::default(),
        outside: 0,
    };
    for _ in 0..steps {
        let before = suspension.positions_in_lengths().clone();
        if suspension.step().is_err() {
            places.outside += 1;
        }
        let [x1, x2, x3] = suspension.positions_in_lengths();
        places.outside += x2.iter().filter(|x| !(0.0..side).contains(*x)).count();
        for rod in (0..x1.len()).filter(|&rod| x1[rod] != before[0][rod]) {
            let moved = before[1][rod] + before[0][rod] * strain;
            places.new_x2_off.push((x2[rod] - moved % side) / side);
            places.new_x1.push(x1[rod] / side);
            places.new_x3.push(x3[rod] / side);
        }
    }
    places.end = suspension
        .positions_in_lengths()
        .clone()
        .map(|axis| axis.into_iter().map(|x| x / side).collect());
    places
}
