//! Jeffery's equations one by one: the core's A.1 to A.5 against printed forms, closed forms and the motion.

use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use crate::oracle::closed_form;
use nalgebra::{Matrix3, UnitVector3, Vector3};
use shearbed::flow::VelocityGradient;
use shearbed::{jeffery, orientation};

/// ω in 1/s of a rod along p with aspect ratio r in a flow.
type Spin = fn(&VelocityGradient, f64, &UnitVector3<f64>) -> Vector3<f64>;
/// (φ̇, θ̇) in 1/s from G, r_e, φ, θ.
type Rates = fn(f64, f64, f64, f64) -> (f64, f64);
/// φ(t/T) from r_e, and θ from C, r_e, φ.
type Angles = (Phi, Theta);
type Phi = fn(f64, f64) -> f64;
type Theta = fn(f64, f64, f64) -> f64;

pub fn cases() -> Vec<Case> {
    vec![
        Case::new(
            About {
                name: "angular-velocity",
                judges: Judges::Core,
                claim: "The coordinate-free angular velocity is A.1 in the body frame, with r_e = a/b.",
                source: "eq. 1, A.1",
                equations: &["1", "A.1"],
            },
            jeffery::angular_velocity_per_s as Spin,
            vec![
                ("b/a for a/b", |flow, r, p| {
                    jeffery::angular_velocity_per_s(flow, 1.0 / r, p)
                }),
                ("no spin about the axis", |flow, r, p| {
                    let omega = jeffery::angular_velocity_per_s(flow, r, p);
                    omega - p.into_inner() * omega.dot(p)
                }),
                ("the transposed gradient", |flow, r, p| {
                    let turned = VelocityGradient::new(flow.per_s().transpose()).unwrap_or(*flow);
                    jeffery::angular_velocity_per_s(&turned, r, p)
                }),
            ],
            body_frame,
        ),
        Case::new(
            About {
                name: "angle-rates",
                judges: Judges::Core,
                claim: "A.2 and A.3 are the rates of the closed form in angles.",
                source: "A.2, A.3",
                equations: &["A.2", "A.3"],
            },
            jeffery::angle_rates_per_s as Rates,
            vec![
                ("sin φ and cos φ exchanged in φ̇", |g, r, phi, theta| {
                    let shifted = phi + std::f64::consts::FRAC_PI_2;
                    (
                        jeffery::angle_rates_per_s(g, r, shifted, theta).0,
                        jeffery::angle_rates_per_s(g, r, phi, theta).1,
                    )
                }),
                ("θ̇ with the wrong sign", |g, r, phi, theta| {
                    let (a, b) = jeffery::angle_rates_per_s(g, r, phi, theta);
                    (a, -b)
                }),
                ("½ for ¼ in θ̇", |g, r, phi, theta| {
                    let (a, b) = jeffery::angle_rates_per_s(g, r, phi, theta);
                    (a, 2.0 * b)
                }),
            ],
            differences,
        ),
        Case::new(
            About {
                name: "angles-in-closed-form",
                judges: Judges::Core,
                claim: "The core's φ(t) and θ(φ) are A.4 and A.5.",
                source: "A.4, A.5, eqs 13, 20",
                equations: &["13", "20", "A.4", "A.5"],
            },
            (jeffery::phi_rad as Phi, jeffery::theta_rad as Theta),
            vec![
                (
                    "1/r_e in φ",
                    (|r, turns| jeffery::phi_rad(1.0 / r, turns), jeffery::theta_rad),
                ),
                (
                    "1/r_e in θ",
                    (jeffery::phi_rad, |c, r, phi| jeffery::theta_rad(c, 1.0 / r, phi)),
                ),
                (
                    "C without r_e",
                    (jeffery::phi_rad, |c, r, phi| jeffery::theta_rad(c / r, r, phi)),
                ),
            ],
            closed_form_angles,
        ),
    ]
}

/// A.1 as printed, with the axes of the particle: 1 along its long axis a, 2 and 3 along its short axes b.
fn printed(l: &Matrix3<f64>, a: f64, b: f64, p: &UnitVector3<f64>) -> Vector3<f64> {
    let helper = if p.x.abs() < 0.5 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let second = p.cross(&helper).normalize();
    let frame = Matrix3::from_columns(&[p.into_inner(), second, p.cross(&second)]);
    let g = frame.transpose() * l * frame;
    let (a2, b2) = (a * a, b * b);
    frame
        * Vector3::new(
            0.5 * (g[(2, 1)] - g[(1, 2)]),
            (b2 * g[(0, 2)] - a2 * g[(2, 0)]) / (a2 + b2),
            -(b2 * g[(0, 1)] - a2 * g[(1, 0)]) / (a2 + b2),
        )
}

fn body_frame(spin: &Spin, _: &Effort) -> Vec<Evidence> {
    let mut worst = 0.0f64;
    for rows in [
        [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, -0.5]],
        [[0.3, -0.9, 0.4], [0.8, 0.1, -0.6], [-0.2, 0.7, -0.4]],
    ] {
        let l = Matrix3::from_fn(|i, j| rows[i][j]);
        let Some(flow) = VelocityGradient::new(l) else {
            continue;
        };
        for (a, b) in [(11.6, 1.0), (3.0, 2.0), (0.2, 1.0), (5.0, 5.0)] {
            for (phi, theta) in [(0.0, 0.4), (0.7, 1.2), (2.0, 0.9), (-1.3, 2.6), (1.5, 1.57)] {
                let p = orientation::from_angles(phi, theta);
                worst = worst.max((spin(&flow, a / b, &p) - printed(&l, a, b, &p)).norm());
            }
        }
    }
    let because = "some dozens of roundings of numbers up to 1";
    vec![Evidence::new(
        "largest difference of ω in 1/s",
        Rule::within(worst, 32.0 * f64::EPSILON, because),
    )]
}

fn differences(rates: &Rates, _: &Effort) -> Vec<Evidence> {
    let g = 0.5;
    let mut worst = [0.0f64; 2];
    for r in [0.5, 1.0, 3.96, 11.6] {
        let period = closed_form::period_s(g, r);
        for (phi, theta) in [(0.2, 0.3), (0.9, 1.1), (2.4, 0.8), (-0.6, 1.5)] {
            let dt = 1e-4;
            let ahead = closed_form::angles_at(phi, theta, r, dt / period);
            let behind = closed_form::angles_at(phi, theta, r, -dt / period);
            let (phi_rate, theta_rate) = rates(g, r, phi, theta);
            worst[0] = worst[0].max((phi_rate - (ahead.0 - behind.0) / (2.0 * dt)).abs());
            worst[1] = worst[1].max((theta_rate - (ahead.1 - behind.1) / (2.0 * dt)).abs());
        }
    }
    let because = "the central difference's own error: (Δt²/6)·G³ ≈ 10⁻⁹ and ε·r_e/Δt ≈ 10⁻¹⁰";
    ["φ̇", "θ̇"]
        .into_iter()
        .zip(worst)
        .map(|(rate, worst)| {
            Evidence::new(
                format!("largest error of {rate} in 1/s"),
                Rule::within(worst, 1e-8, because),
            )
        })
        .collect()
}

fn closed_form_angles((phi_rad, theta_rad): &Angles, _: &Effort) -> Vec<Evidence> {
    let (mut phi_off, mut theta_off) = (0.0f64, 0.0f64);
    for r in [0.5, 1.01, 3.96, 11.6, 50.0] {
        for theta in [0.05, 0.6, 1.2, 1.5] {
            for turns in [0.0, 0.1, 0.2499, 0.37, 0.8, 2.3] {
                let expected = closed_form::angles_at(0.0, theta, r, turns);
                let phi = phi_rad(r, turns);
                // On φ = 0, eq. 13 reads C = tan θ.
                let found = theta_rad(theta.tan(), r, expected.0);
                phi_off = phi_off.max((phi - expected.0).abs() / (r.max(1.0 / r) * (1.0 + turns)));
                theta_off = theta_off.max((found - expected.1).abs() / r.max(1.0 / r));
            }
        }
    }
    let because = "a rounding of the phase grows by dφ/d(phase) ≤ max(r_e, 1/r_e)";
    vec![
        Evidence::new(
            "largest error of φ over max(r_e, 1/r_e)(1 + t/T)",
            Rule::within(phi_off, 32.0 * f64::EPSILON, because),
        ),
        Evidence::new(
            "largest error of θ over max(r_e, 1/r_e)",
            Rule::within(theta_off, 32.0 * f64::EPSILON, because),
        ),
    ]
}
