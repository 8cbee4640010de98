//! The exact motion of a free rod over any time.
//!
//! Jeffery's equation is linear in disguise: p(t) = q/|q| with q = exp(At) p(0) and A = W + ΛD (the trace of
//! A changes |q| only and is left out). The size of q carries nothing, so every growing factor is shifted
//! away and no strain overflows. Whole turns are taken out of the phase before any function is called, so
//! that 10⁸ periods cost no digits.

use crate::flow::VelocityGradient;
use crate::jeffery;
use crate::phase::Phase;
use nalgebra::{Matrix3, UnitVector3};
use std::f64::consts::TAU;

/// The direction after the phase `phase` of a free rod in plane Couette flow with G > 0
/// (A.4 and A.5 as a linear map):
/// q = (p₁ cos ωt − (p₂/r_e) sin ωt, r_e p₁ sin ωt + p₂ cos ωt, p₃), p = q/|q|.
#[inline(always)]
pub fn couette(p: [f64; 3], aspect_ratio: f64, phase: Phase) -> [f64; 3] {
    let inverse = 1.0 / aspect_ratio;
    let q1 = p[0] * phase.cos - p[1] * inverse * phase.sin;
    let q2 = aspect_ratio * p[0] * phase.sin + p[1] * phase.cos;
    let scale = 1.0 / (q1 * q1 + q2 * q2 + p[2] * p[2]).sqrt();
    [q1 * scale, q2 * scale, p[2] * scale]
}

/// The exact motion of rods of one aspect ratio in one flow.
#[derive(Clone, Debug)]
pub struct Propagator {
    /// The largest component of L: times are counted in its inverse, so that no square overflows or vanishes.
    rate_per_s: f64,
    motion: Motion,
}

#[derive(Clone, Debug)]
enum Motion {
    /// Plane Couette flow u_2 = ±x_1: the closed form.
    Couette { sign: f64, aspect_ratio: f64 },
    /// A³ = −cA, as in every planar flow: elliptic (c > 0), parabolic (c = 0) or hyperbolic (c < 0).
    Planar { a: Matrix3<f64>, c: f64 },
    /// A complex pair σ ± iω beside a real eigenvalue λ.
    Spiral {
        a: Matrix3<f64>,
        omega: f64,
        /// λ − σ: the growth along the real eigenvector against that of the spiral.
        lead: f64,
        /// The projector onto the real eigenvector.
        real: Matrix3<f64>,
    },
    /// Three real eigenvalues.
    Real { a: Matrix3<f64> },
}

impl Propagator {
    /// The motion of rods with `aspect_ratio` > 0 in `flow`.
    pub fn new(flow: &VelocityGradient, aspect_ratio: f64) -> Self {
        let motion = match flow.shear_rate_per_s() {
            Some(shear_rate_per_s) => Motion::Couette {
                sign: shear_rate_per_s.signum(),
                aspect_ratio,
            },
            None => general(flow, aspect_ratio),
        };
        Self {
            rate_per_s: flow.per_s().amax(),
            motion,
        }
    }

    /// The period in s after which every direction is back where it was, where there is one.
    pub fn period_s(&self) -> Option<f64> {
        self.period().map(|period| period / self.rate_per_s)
    }

    /// The period in units of 1/rate, the same bits for any rate.
    pub(crate) fn period(&self) -> Option<f64> {
        match self.motion {
            Motion::Couette { aspect_ratio, .. } => Some(jeffery::strain_per_period(aspect_ratio)),
            Motion::Planar { c, .. } if c > 0.0 => Some(TAU / c.sqrt()),
            _ => None,
        }
    }

    /// The linear map q = M p over `turns` periods of this propagator; `None` where it has no period.
    pub fn map_over_turns(&self, turns: f64) -> Option<Matrix3<f64>> {
        match &self.motion {
            Motion::Couette { sign, aspect_ratio } => Some(couette_map(*aspect_ratio, turns * sign)),
            Motion::Planar { a, c } if *c > 0.0 => Some(elliptic(a, *c, Phase::of_turns(turns))),
            _ => None,
        }
    }

    /// The linear map q = M p over `time_s` ≥ 0 seconds, scaled by an arbitrary positive factor.
    pub fn map_over(&self, time_s: f64) -> Matrix3<f64> {
        let time = time_s * self.rate_per_s;
        let turns = self.period().map(|period| time / period);
        if let Some(map) = turns.and_then(|turns| self.map_over_turns(turns)) {
            return map;
        }
        match &self.motion {
            // Flows with a period have returned above.
            Motion::Couette { .. } => Matrix3::identity(),
            Motion::Planar { a, c } => hyperbolic(a, *c, time),
            Motion::Spiral { a, omega, lead, real } => spiral(a, *omega, *lead, real, time),
            Motion::Real { a } => squared_exponential(a, time),
        }
    }

    /// The direction of a rod `time_s` ≥ 0 seconds after it pointed along `p`.
    pub fn after(&self, p: &UnitVector3<f64>, time_s: f64) -> UnitVector3<f64> {
        UnitVector3::new_normalize(self.map_over(time_s) * p.as_ref())
    }

    /// The direction of a rod `turns` periods after it pointed along `p`; `None` where there is no period.
    pub fn after_turns(&self, p: &UnitVector3<f64>, turns: f64) -> Option<UnitVector3<f64>> {
        self.map_over_turns(turns)
            .map(|map| UnitVector3::new_normalize(map * p.as_ref()))
    }
}

fn couette_map(aspect_ratio: f64, turns: f64) -> Matrix3<f64> {
    let Phase { cos, sin } = Phase::of_turns(turns);
    Matrix3::new(
        cos,
        -sin / aspect_ratio,
        0.0,
        aspect_ratio * sin,
        cos,
        0.0,
        0.0,
        0.0,
        1.0,
    )
}

/// Sorts A, in units of its flow's largest component, by the roots of its characteristic equation
/// λ³ + cλ − d = 0 (A has no trace).
fn general(flow: &VelocityGradient, aspect_ratio: f64) -> Motion {
    let rate = flow.per_s().amax();
    if rate == 0.0 {
        return Motion::Planar {
            a: Matrix3::zeros(),
            c: 0.0,
        };
    }
    let l = flow.per_s() / rate;
    let l = l - Matrix3::identity() * (l.trace() / 3.0);
    // A = ½(1+Λ)L − ½(1−Λ)Lᵀ, and 1 ± Λ without cancellation for long rods and flat discs.
    let (long, short) = halves(aspect_ratio);
    let a = long * l - short * l.transpose();
    let c = -0.5
        * ((long * long + short * short) * (l * l).trace()
            - 2.0 * long * short * (l * l.transpose()).trace());
    if a.determinant().abs() <= 16.0 * f64::EPSILON {
        return Motion::Planar { a, c };
    }
    let eigenvalues = a.complex_eigenvalues();
    let Some(pair) = eigenvalues.iter().find(|e| e.im > 1e-6) else {
        return Motion::Real { a };
    };
    let lambda = -2.0 * pair.re;
    let size = pair.norm_sqr();
    let real = (a * a - a * (2.0 * pair.re) + Matrix3::identity() * size)
        / (lambda * lambda - 2.0 * pair.re * lambda + size);
    Motion::Spiral {
        a,
        omega: pair.im,
        lead: lambda - pair.re,
        real,
    }
}

/// ½(1 + Λ) and ½(1 − Λ).
fn halves(aspect_ratio: f64) -> (f64, f64) {
    let square = aspect_ratio * aspect_ratio;
    (1.0 / (1.0 + 1.0 / square), 1.0 / (1.0 + square))
}

/// exp(At) on a spiral, up to a positive factor. A whole turn only stretches: e^{λT} along the real
/// eigenvector, e^{σT} in the spiral's plane.
fn spiral(a: &Matrix3<f64>, omega: f64, lead: f64, real: &Matrix3<f64>, time: f64) -> Matrix3<f64> {
    let period = TAU / omega;
    let whole = (time / period).floor();
    let rest = (time - whole * period).max(0.0);
    let turning = Matrix3::identity() - real;
    let growth = lead * whole * period;
    let turns = if growth > 0.0 {
        real + (-growth).exp() * turning
    } else {
        turning + growth.exp() * real
    };
    (a * rest).exp() * turns
}

/// exp(At) for A³ = −ω²A with ω² = c > 0: I + (sin ωt/ω) A + ((1 − cos ωt)/ω²) A².
fn elliptic(a: &Matrix3<f64>, c: f64, phase: Phase) -> Matrix3<f64> {
    // 1 − cos = sin²/(1 + cos) where the difference would cancel.
    let versine = if phase.cos > 0.0 {
        phase.sin * phase.sin / (1.0 + phase.cos)
    } else {
        1.0 - phase.cos
    };
    Matrix3::identity() + a * (phase.sin / c.sqrt()) + a * a * (versine / c)
}

/// exp(At − κt) for A³ = κ²A with κ² = −c ≥ 0; κ = 0 is the parabolic I + At + A²t²/2.
fn hyperbolic(a: &Matrix3<f64>, c: f64, time: f64) -> Matrix3<f64> {
    let kappa = (-c).sqrt();
    if kappa == 0.0 {
        // Divided by 1 + (‖A‖t)², which keeps it finite.
        let strain = a.norm() * time;
        let scale = 1.0 / (1.0 + strain);
        let at = a * (time * scale);
        return Matrix3::identity() * (scale * scale) + at * scale + at * at * 0.5;
    }
    let decay = -(-kappa * time).exp_m1();
    let sinh = -(-2.0 * kappa * time).exp_m1() / 2.0;
    let unit = a / kappa;
    Matrix3::identity() * (-kappa * time).exp() + unit * sinh + unit * unit * (0.5 * decay * decay)
}

/// exp(At) up to a positive factor: a short exponential squared again and again, rescaled each time.
fn squared_exponential(a: &Matrix3<f64>, time: f64) -> Matrix3<f64> {
    let doublings = (a.norm() * time).log2().ceil().max(0.0) as i32;
    let mut map = (a * (time / 2f64.powi(doublings))).exp();
    for _ in 0..doublings {
        map *= map;
        map /= map.amax();
    }
    map
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::orientation;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    fn flow(rows: [[f64; 3]; 3]) -> VelocityGradient {
        VelocityGradient::new(Matrix3::from_fn(|i, j| rows[i][j])).unwrap()
    }

    fn apart(a: &UnitVector3<f64>, b: &UnitVector3<f64>) -> f64 {
        a.cross(b).norm()
    }

    #[test]
    fn quarter_turns_are_exact() {
        for (turns, cos, sin) in [
            (0.25, 0.0, 1.0),
            (-0.25, 0.0, -1.0),
            (0.5, -1.0, 0.0),
            (1e8 + 0.75, 0.0, -1.0),
        ] {
            let phase = Phase::of_turns(turns);
            assert_eq!((phase.cos, phase.sin), (cos, sin), "{turns}");
        }
    }

    proptest! {
        #![proptest_config(crate::fixed_seed(256))]

        #[test]
        fn every_kind_of_flow_agrees_with_the_plain_exponential(
            l in prop::array::uniform9(-1.0f64..1.0), phi in 0.0f64..6.2, theta in 0.0f64..3.1,
            r in 0.05f64..20.0, time in 0.0f64..20.0
        ) {
            let flow = VelocityGradient::new(Matrix3::from_row_slice(&l)).unwrap();
            let p = orientation::from_angles(phi, theta);
            let a = flow.vorticity() + jeffery::shape_factor(r) * flow.strain_rate();
            let plain = UnitVector3::new_normalize((a * time).exp() * p.as_ref());
            prop_assert!(apart(&Propagator::new(&flow, r).after(&p, time), &plain) < 1e-8);
        }

        #[test]
        fn a_short_time_moves_at_jefferys_rate(
            l in prop::array::uniform9(-1.0f64..1.0), phi in 0.0f64..6.2, theta in 0.0f64..3.1, r in 0.05f64..20.0
        ) {
            let flow = VelocityGradient::new(Matrix3::from_row_slice(&l)).unwrap();
            let p = orientation::from_angles(phi, theta);
            let dt = 1e-6;
            let moved = Propagator::new(&flow, r).after(&p, dt).into_inner();
            let rate = jeffery::direction_rate_per_s(&flow, r, &p);
            prop_assert!(((moved - p.into_inner()) / dt - rate).norm() < 1e-5);
        }

        #[test]
        fn plane_couette_flow_by_either_branch(phi in 0.0f64..6.2, theta in 0.0f64..3.1, r in 0.05f64..50.0, turns in 0.0f64..3.0) {
            let p = orientation::from_angles(phi, theta);
            let flow = VelocityGradient::plane_couette(0.5).unwrap();
            let closed = Propagator::new(&flow, r).after_turns(&p, turns).unwrap();
            let general = Propagator { rate_per_s: 0.5, motion: general(&flow, r) };
            let other = general.after_turns(&p, turns).unwrap();
            prop_assert!(apart(&closed, &other) < 1e-11 * (r + 1.0 / r));
            let [p1, p2, p3] = couette([p.x, p.y, p.z], r, Phase::of_turns(turns));
            prop_assert!((Vector3::new(p1, p2, p3) - closed.into_inner()).norm() < 1e-15);
        }
    }

    #[test]
    fn no_strain_overflows() {
        let p = orientation::from_angles(0.3, 1.0);
        let planar = flow([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]]);
        let axial = flow([[1.0, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, -0.5]]);
        for flow in [planar, axial] {
            let end = Propagator::new(&flow, 11.6).after(&p, 1e6);
            assert!((end.x - 1.0).abs() < 1e-15 && end.y.abs() < 1e-15, "{end:?}");
        }
    }

    #[test]
    fn a_spiral_keeps_its_phase_over_many_turns() {
        // Rotation about axis 3 with compression along it: p falls into the plane and turns there at ½.
        let spiral = flow([[0.1, -0.5, 0.0], [0.5, 0.1, 0.0], [0.0, 0.0, -0.2]]);
        let propagator = Propagator::new(&spiral, 5.0);
        assert_eq!(propagator.period_s(), None);
        let p = orientation::from_angles(0.3, 1.0);
        let turns = 1e6;
        let end = propagator.after(&p, turns * 2.0 * TAU);
        let expected = orientation::from_angles(0.3, std::f64::consts::FRAC_PI_2);
        // The time itself, 1.3·10⁷ s, is rounded to 2·10⁻⁹ s.
        assert!(apart(&end, &expected) < 1e-8, "{end:?}");
    }

    #[test]
    fn a_pure_rotation_has_the_period_of_its_vorticity() {
        let rotation = flow([[0.0, -0.5, 0.0], [0.5, 0.0, 0.0], [0.0, 0.0, 0.0]]);
        let period = Propagator::new(&rotation, 7.0).period_s().unwrap();
        assert!((period / (2.0 * TAU) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_phase_of_1e8_periods_is_not_lost() {
        let p = orientation::from_angles(0.2, 0.9);
        let rotated = flow([[0.0, 0.0, 0.0], [0.0, 0.0, 0.5], [0.0, 0.0, 0.0]]);
        for flow in [VelocityGradient::plane_couette(0.5).unwrap(), rotated] {
            let propagator = Propagator::new(&flow, 11.6);
            let near = propagator.after_turns(&p, 0.125).unwrap();
            let far = propagator.after_turns(&p, 1e8 + 0.125).unwrap();
            assert_eq!(near, far);
        }
    }
}
