//! Free rods one by one: period, orbit constant, the exact propagator against closed forms and an integrator.

mod integrated;

use self::integrated::integrated_motion;
use super::*;
use crate::methods::integrators::rk4;
use crate::oracle::jeffery::direction_rate_per_s;
use crate::oracle::quadrature;
use crate::studies::bisect;
use nalgebra::SVector;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, System};
use shearbed::model::phase::Phase;
use shearbed::motion;
use std::f64::consts::FRAC_2_PI;

/// A function that returns the direction after a time in s, for a rod of some aspect ratio in some flow.
type Motion = fn(&VelocityGradient, f64, &UnitVector3<f64>, f64) -> UnitVector3<f64>;

fn exact(flow: &VelocityGradient, r: f64, p: &UnitVector3<f64>, time_s: f64) -> UnitVector3<f64> {
    Propagator::new(flow, r).after(p, time_s)
}

fn couette(shear_rate_per_s: f64) -> VelocityGradient {
    VelocityGradient::plane_couette(shear_rate_per_s).expect("a finite shear rate")
}

/// The angle between two directions up to sign, for small angles.
fn apart(a: &UnitVector3<f64>, b: &UnitVector3<f64>) -> f64 {
    a.cross(b).norm()
}

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "jeffery-period")
            .claim("A free rod comes back after T = 2π(r_e + 1/r_e)/G, for r_e from 1.01 to 10⁶.")
            .source("eqs 15, A.6")
            .under_test(exact as Motion)
            .mistake("Λ = 1", |flow, _, p, t| exact(flow, 1e9, p, t))
            .mistake("r_e − 1/r_e in the period", |flow, r, p, t| {
                exact(flow, r, p, t * (r + 1.0 / r) / (r - 1.0 / r))
            })
            .mistake("half the shear rate", |flow, r, p, t| exact(flow, r, p, 0.5 * t))
            .check(period),
        Case::of(Judges::Core, "orbit-constant")
            .claim("The orbit constant of a free rod keeps its value over 10⁴ periods.")
            .source("eqs 13, A.5")
            .under_test(exact as Motion)
            .mistake("r_e 0.1 % too long", |flow, r, p, t| exact(flow, 1.001 * r, p, t))
            .mistake("p_3 not rescaled", |flow, r, p, t| {
                let q = exact(flow, r, p, t);
                UnitVector3::new_normalize(Vector3::new(q.x, q.y, p.z))
            })
            .mistake("one RK4 step of 0.01 strain per call", |flow, r, p, _| {
                let rate = |v| direction_rate_per_s(flow.per_s(), r, &v);
                UnitVector3::new_normalize(rk4(rate, p.into_inner(), 0.01 / flow.magnitude_per_s()))
            })
            .check(orbit_constant),
        Case::of(Judges::Core, "propagator-closed-form")
            .claim("The propagator of plane Couette flow is Jeffery's closed form in angles.")
            .source("eqs 20, A.4, A.5")
            .under_test(exact as Motion)
            .mistake("the phase turns backwards", |flow, r, p, t| {
                exact(&VelocityGradient::new(-flow.per_s()).unwrap_or(*flow), r, p, t)
            })
            .mistake("1/r_e for r_e", |flow, r, p, t| exact(flow, 1.0 / r, p, t))
            .mistake("θ frozen", |flow, r, p, t| {
                let (phi, _) = orientation::angles(&exact(flow, r, p, t));
                orientation::from_angles(phi, orientation::angles(p).1)
            })
            .check(closed_form_motion),
        Case::of(Judges::Core, "propagator-integrator")
            .claim(
                "The propagator solves ṗ = W·p + Λ(D·p − p p·D·p) in any flow, by Dormand–Prince 8(5,3) of \
                 ode_solvers.",
            )
            .source("eqs 3, A.1")
            .under_test(exact as Motion)
            .mistake("Λ = 1", |flow, _, p, t| exact(flow, 1e9, p, t))
            .mistake("Λ for a disc", |flow, r, p, t| exact(flow, 1.0 / r, p, t))
            .mistake("the transposed gradient", |flow, r, p, t| {
                exact(&VelocityGradient::new(flow.per_s().transpose()).unwrap_or(*flow), r, p, t)
            })
            .mistake("no vorticity", |flow, r, p, t| {
                exact(&VelocityGradient::new(flow.strain_rate()).unwrap_or(*flow), r, p, t)
            })
            .check(integrated_motion),
        Case::of(Judges::Core, "mean-angle-quadrature")
            .claim(
                "⟨φ⟩ of a single rod, integrated over the φ(t) that a run has, is the dilogarithm, and tends to π/2 as \
                 (2/π)(1 + ln r_e)/r_e for r_e → ∞.",
            )
            .source("eqs 18–20")
            .under_test(angle_in_a_run as Angle)
            .mistake("r_e² for r_e", |r, turns| angle_in_a_run(r * r, turns))
            .mistake("φ grows evenly", |_, turns| 2.0 * PI * turns)
            .mistake("φ from axis 2", |r, turns| FRAC_PI_2 - angle_in_a_run(r, turns))
            .mistake("r_e a millionth too long", |r, turns| angle_in_a_run(r * (1.0 + 1e-6), turns))
            .check(mean_angle),
    ]
}

fn period(motion: &Motion, _: &Effort) -> [Evidence; 2] {
    let error = |r: f64, flow: &VelocityGradient, start: &UnitVector3<f64>, across: usize| {
        let expected = closed_form::period_s(0.5, r);
        // The component along the flow goes from − to + only when the rod has turned round.
        let flow_component = |t: f64| motion(flow, r, start, t)[across];
        let crossing = root(flow_component, 0.8 * expected, 1.2 * expected);
        // If a rod does not return within a fifth of a period, the error is at least that much.
        crossing.map_or(0.2, |t| (t / expected - 1.0).abs())
    };
    // u_3 = G x_2, which the core does not recognise.
    let turned = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0);
    let turned = VelocityGradient::new(turned).expect("finite components");
    [
        ("plane Couette flow by its closed form", couette(0.5), Vector3::x_axis(), 1),
        ("the same flow about other axes", turned, Vector3::y_axis(), 2),
    ]
    .map(|(name, flow, start, across)| {
        let ratios = [1.01, 1.1, 1.5, 2.0, 3.96, 11.6, 14.2, 50.0, 1e3, 1e4, 1e5, 1e6];
        Evidence::on(format!("relative error of the period, {name}"), "–")
            .within(worst(ratios.map(|r| error(r, &flow, &start, across))), 8.0 * f64::EPSILON)
            .because("the root is found to the last bit; eight roundings of the phase")
    })
}

/// A root of `f` where it rises through 0 between `low` and `high`, by bisection to the last bit.
fn root(f: impl Fn(f64) -> f64, low: f64, high: f64) -> Option<f64> {
    let [below, above] = bisect(low, high, 64, |x| f(x) < 0.0);
    (f(low) < 0.0 && f(high) > 0.0).then_some(0.5 * (below + above))
}

fn orbit_constant(motion: &Motion, _: &Effort) -> Evidence {
    let rods = pairs([1.01, 2.0, 11.6, 14.2, 100.0, 1e4], starts());
    let drift = pairs(rods, [0.1, 0.3, 17.77, 999.9, 1e4 - 0.123, 1e4]).map(|((r, start), turns)| {
        let p = motion(&couette(0.5), r, &start, turns * closed_form::period_s(0.5, r));
        // C from p itself (eq. 13): tan θ would lose digits for a rod nearly in the plane.
        let c = |p: &UnitVector3<f64>| p.x.hypot(p.y / r) / p.z.abs();
        (c(&p) / c(&start) - 1.0).abs()
    });
    Evidence::on("largest relative drift of C up to 10⁴ periods", "–")
        .within(worst(drift), 16.0 * f64::EPSILON)
        .because(
            "one evaluation, however many periods it spans: C is a ratio of lengths without cancellation, some sixteen \
         roundings",
        )
}

/// Directions in general position.
fn starts() -> Vec<UnitVector3<f64>> {
    [(0.1, 0.4), (1.2, 0.9), (2.5, 1.3), (-2.0, 0.05), (0.7, 1.5)]
        .into_iter()
        .map(|(phi, theta)| orientation::from_angles(phi, theta))
        .collect()
}

fn closed_form_motion(motion: &Motion, _: &Effort) -> Evidence {
    let rods = pairs([0.02, 0.5, 1.0, 1.01, 2.0, 11.6, 14.2, 100.0, 1e4], starts());
    let off = pairs(rods, [0.0, 0.05, 0.2499, 0.5, 0.7, 1.3, 4.9]).map(|((r, start), turns)| {
        let (phi, theta) = orientation::angles(&start);
        let (phi, theta) = closed_form::angles_at(phi, theta, r, turns);
        let moved = motion(&couette(0.5), r, &start, turns * closed_form::period_s(0.5, r));
        apart(&moved, &orientation::from_angles(phi, theta)) / (r.max(1.0 / r) * (1.0 + turns))
    });
    Evidence::on("angle between the two, over max(r_e, 1/r_e)·(1 + t/T)", "rad")
        .within(worst(off), 32.0 * f64::EPSILON)
        .because("a rounding of the phase, 2π(t/T)ε, grows by dφ/d(phase) ≤ max(r_e, 1/r_e) at the flip")
}

/// A function that returns φ in [0, π/2] for r_e and t/T.
type Angle = fn(f64, f64) -> f64;

/// The angle in a run: the propagator's map of a rod that starts along axis 1, and the angle that `mean_angle`
/// averages.
fn angle_in_a_run(r: f64, turns: f64) -> f64 {
    let [p1, p2, _] = motion::couette([1.0, 0.0, 0.0], r, Phase::of_turns(turns));
    orientation::folded_phi(p1, p2)
}

/// The quadrature's tolerance on a quarter of a period.
const QUARTER: f64 = 1e-14;

fn mean_angle(angle: &Angle, _: &Effort) -> Vec<Evidence> {
    let mean = |r: f64| {
        // Panels for the steep part of φ(t), of width 1/r_e in phase, and then of increasing width.
        let edge = (1.0 / r).atan() / (2.0 * PI);
        let mut breaks = vec![0.0];
        breaks.extend((0..).map(|k| edge * 4f64.powi(k)).take_while(|at| *at < 0.2));
        breaks.push(0.25);
        let quarter = quadrature::integrate(|turns| angle(r, turns), &breaks, QUARTER);
        (4.0 * quarter, 4.0 * QUARTER * (breaks.len() - 1) as f64)
    };
    let (mut worst, mut thread) = (0.0f64, 0.0f64);
    for r in [1.0f64, 1.01, 2.0, 5.0, 11.6, 14.2, 50.0, 1e3] {
        let (mean, tolerance) = mean(r);
        worst = larger(worst, (mean - closed_form::mean_angle(r)).abs() / tolerance);
    }
    for r in [1e5f64, 1e6, 1e7] {
        let (mean, tolerance) = mean(r);
        let first = FRAC_2_PI * (1.0 + r.ln()) / r;
        // χ₂(k) − ln k artanh k = k(1 − ln k) + k³(1/9 − ln k/3) + …
        let next = (1.0 + r.ln()) / r.powi(3);
        thread = larger(thread, (FRAC_PI_2 - mean - first).abs() / (tolerance + next));
    }
    let because = "the quadrature asks for 10⁻¹⁴ on each panel of a quarter";
    vec![
        Evidence::on("difference of ⟨φ⟩ over the quadrature's tolerance, r_e from 1 to 1000", "× its tolerance")
            .within(worst, 1.0)
            .because(because),
        Evidence::on(
            "difference of π/2 − ⟨φ⟩ and its first term, over that tolerance and the next term, r_e from 10⁵ to 10⁷",
            "× tolerance + next term",
        )
        .within(thread, 1.0)
        .because(because),
    ]
}
