//! The core in stiff and extreme cases: no NaN, no panic, |p| = 1 to 4 ulp, C to its bound.

use super::*;
use crate::methods::integrators::{RodProblem, Setting, closed_form};
use crate::studies::stability::extremes;
use crate::studies::stability::map::{ASPECT_RATIOS, STEPS};
use shearbed::model::phase::Phase;

/// A function that returns the direction of a rod of aspect ratio r at the shear rate G after a number of periods.
type Motion = fn(f64, f64, &UnitVector3<f64>, f64) -> Vector3<f64>;
/// A function that returns the direction after a time in s in any flow.
type FlowMotion = fn(&VelocityGradient, f64, &UnitVector3<f64>, f64) -> Vector3<f64>;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "extreme-motion")
            .claim(
                "Free rods in plane Couette flow keep |p| = 1 to 4 ulp and C_b to 8, and are where the closed form has \
                 them, for r_e from 10⁻⁸ to 10⁸, G from 10⁻³⁰ to 10³⁰ 1/s, 10⁻⁹ to 10⁸ periods, at once and in a \
                 thousand steps, from any start.",
            )
            .source("eqs 13, 15")
            .under_test(extremes::exact as Motion)
            .mistake("q not rescaled", |r, g, p, turns| {
                let Phase { cos, sin } = Phase::of_turns(g.signum() * turns);
                Vector3::new(p.x * cos - p.y / r * sin, r * p.x * sin + p.y * cos, p.z)
            })
            .mistake("whole turns left in the phase", |r, _, p, turns| {
                let (sin, cos) = (TAU * turns).sin_cos();
                Vector3::new(p.x * cos - p.y / r * sin, r * p.x * sin + p.y * cos, p.z).normalize()
            })
            .mistake("G t for G t/T", |r, g, p, turns| {
                extremes::exact(r, g, p, turns * shearbed::model::jeffery::strain_per_period(r))
            })
            .mistake("through tan θ and φ (A.4, A.5)", |r, _, p, turns| {
                let end = closed_form().advance(&RodProblem::new(r, turns), p, Setting::Once);
                end.unwrap_or(Vector3::repeat(f64::NAN))
            })
            .check(extreme_motion),
        Case::of(Judges::Core, "extreme-flows")
            .claim(
                "In other flows rods keep |p| = 1 to 4 ulp up to a strain of 10⁶ and beyond, and end where the flow \
                 leads, to 4 ulp too where its two fastest rates are equal or next to each other and the start is \
                 5·10⁻¹⁵ rad from the third axis.",
            )
            .source("eqs 3, A.1")
            .under_test((|flow, r, p, time_s| Propagator::new(flow, r).after(p, time_s).into_inner()) as FlowMotion)
            .mistake("the plain exponential", |flow, r, p, time_s| {
                let a = flow.vorticity() + shape_factor(r) * flow.strain_rate();
                ((a * time_s).exp() * p.as_ref()).normalize()
            })
            .mistake("a millionth of the strain", |flow, r, p, time_s| {
                Propagator::new(flow, r).after(p, 1e-6 * time_s).into_inner()
            })
            .mistake("nearly equal rates taken as equal", |flow, r, p, time_s| {
                let mut l = *flow.per_s();
                for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                    if (l[(i, i)] - l[(j, j)]).abs() < 1e-12 * l.amax() {
                        l[(j, j)] = l[(i, i)];
                    }
                }
                let flow = VelocityGradient::new(l).expect("finite");
                Propagator::new(&flow, r).after(p, time_s).into_inner()
            })
            .mistake("in turned axes, where all coordinates are coupled", |flow, r, p, time_s| {
                let turn = Rotation3::from_euler_angles(0.3, 0.5, 0.7);
                let l = turn * flow.per_s() * turn.transpose();
                let flow = VelocityGradient::new(l).expect("finite");
                let start = UnitVector3::new_normalize(turn * p.as_ref());
                turn.transpose() * Propagator::new(&flow, r).after(&start, time_s).into_inner()
            })
            .check(extreme_flows),
    ]
}

/// 4 ulp of 1, as rounding of |p| itself allows.
pub(super) const LENGTH: f64 = 4.0 * f64::EPSILON;
pub(super) const LENGTH_BECAUSE: &str = "4 ulp of 1";

pub(super) fn off_length(p: &Vector3<f64>) -> f64 {
    (p.norm() - 1.0).abs()
}

fn extreme_motion(motion: &Motion, _: &Effort) -> Vec<Evidence> {
    let all: Vec<_> = ASPECT_RATIOS.into_iter().chain([1.0]).map(|r| extremes::worst(r, motion)).collect();
    let most = |of: fn(&extremes::Worst) -> f64| worst(all.iter().map(of));
    let (stepped_length, stepped_orbit) = thousand_steps(motion);
    vec![
        Evidence::on("largest ||p| − 1|", "–")
            .within(larger(most(|found| found.length), stepped_length), LENGTH)
            .because(LENGTH_BECAUSE),
        Evidence::on("largest change of C_b", "–")
            .within(most(|found| found.orbit), 8.0 * f64::EPSILON)
            .because("one evaluation's roundings; C_b ≤ 1 has slope ≤ 1 in ln C / 4"),
        Evidence::on("largest change of C_b in 1000 steps of 10⁻⁹ T to 10³ T", "–")
            .within(stepped_orbit, 8000.0 * f64::EPSILON)
            .because("a thousand evaluations"),
        Evidence::on("largest angle to the closed form over 16 ε(1 + 2π max(r_e, 1/r_e)|rest|)", "× its bound")
            .within(most(|found| found.angle), 1.0)
            .because(
                "the phase without whole turns is rounded to ε, and φ moves by max(r_e, 1/r_e) times that; some \
                 sixteen roundings",
            ),
    ]
}

/// The largest ||p| − 1| and change of C_b over a thousand consecutive steps.
fn thousand_steps(motion: &Motion) -> (f64, f64) {
    let start = UnitVector3::new_normalize(Vector3::new(0.3, -0.5, 0.8));
    let errors = pairs(ASPECT_RATIOS, STEPS).map(|(r, step)| {
        let bounded = |p: &Vector3<f64>| orientation::bounded_orbit_constant([p.x, p.y, p.z], r);
        let end = (0..1000).fold(start.into_inner(), |p, _| motion(r, 0.5, &UnitVector3::new_unchecked(p), step));
        (off_length(&end), (bounded(&end) - bounded(&start)).abs())
    });
    let (length, drift): (Vec<_>, Vec<_>) = errors.unzip();
    (worst(length), worst(drift))
}

fn extreme_flows(motion: &FlowMotion, _: &Effort) -> Vec<Evidence> {
    let (mut length, mut end, mut lost) = (0.0f64, 0.0f64, 0.0);
    // Flows in which every rod of r_e > 1 aligns with axis 1, and the strain rate of each.
    let flows = [
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, -0.5]],
        [[1.0, 0.0, 0.0], [0.0, -0.3, -2.0], [0.0, 2.0, -0.7]],
    ];
    let rods = pairs([1.5, 11.6, 1e8], [(0.3, 1.0), (1.57, 0.01), (3.0, 3.1)]);
    let runs = pairs(rods, [1e-9, 1.0, 1e2, 1e6, 1e12]);
    for ((rows, rate), ((r, (phi, theta)), strain)) in pairs(pairs(flows, [1e-30, 1.0, 1e30]), runs) {
        let flow = VelocityGradient::new(Matrix3::from_fn(|i, j| rows[i][j] * rate)).expect("finite");
        let start = orientation::from_angles(phi, theta);
        let p = motion(&flow, r, &start, strain / rate);
        if !p.sum().is_finite() {
            lost += 1.0;
            continue;
        }
        length = larger(length, off_length(&p));
        if strain >= 1e6 {
            end = larger(end, p.y.hypot(p.z) * start.x.abs());
        }
    }
    vec![
        Evidence::on("directions that are not finite", "directions").exact(lost),
        Evidence::on("largest ||p| − 1|", "–").within(length, LENGTH).because(LENGTH_BECAUSE),
        Evidence::on("distance from the flow's axis at a strain of 10⁶ or more, times |p_1| at first", "–")
            .within(end, LENGTH)
            .because(
                "e^{−Λ·10⁶} is 0; the map is known to some ε, which a start near the dividing plane grows by 1/|p_1|",
            ),
        Evidence::on("largest angle to p_i e^{ΛL_ii t} where two rates nearly meet, at a strain of 10² or more", "rad")
            .within(apart_where_rates_meet(motion), LENGTH)
            .because(
                "the motion of uncoupled axes amplifies nothing: a component of the core's direction is rounded twice \
                 (ε), one of the closed form three times (2 ε), which turns either by half of that, and their cross \
                 product is rounded to ε",
            ),
    ]
}

/// The largest angle to the closed form for uncoupled axes, two of which lengthen equally fast, or nearly so, while the
/// third shrinks. The start lies almost along the third axis.
fn apart_where_rates_meet(motion: &FlowMotion) -> f64 {
    let next = 1.0 + f64::EPSILON;
    let (near, beside) = (5.4e-15, 7.06e-16);
    let starts = [
        ([1.0, -2.0, next], [beside, 1.0, -near]),
        ([1.0, -2.0, 1.0], [beside, 1.0, -near]),
        ([-2.0, next, 1.0], [1.0, -near, beside]),
        ([next, 1.0, -2.0], [near, beside, -1.0]),
    ];
    let runs = pairs([1.5, 11.6, 1e8], [1e2, 1861.0, 2550.0, 1e6, 1e12]);
    worst(pairs(pairs(starts, [1e-30, 1.0, 1e30]), runs).map(|(((l, p), rate), (r, strain))| {
        let (l, time_s) = (Vector3::from(l) * rate, strain / rate);
        let flow = VelocityGradient::new(Matrix3::from_diagonal(&l)).expect("finite");
        let start = UnitVector3::new_unchecked(Vector3::from(p));
        // Differences of rates that nearly meet are exact, and the component along the third axis tends to 0.
        let grown = l.map(|l_ii| (shape_factor(r) * (l_ii - l.max()) * time_s).exp());
        let expected = start.component_mul(&grown).normalize();
        let off = motion(&flow, r, &start, time_s).cross(&expected).norm();
        // A result that is not finite counts as a right angle.
        if off.is_finite() { off } else { 1.0 }
    }))
}
