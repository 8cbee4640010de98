//! Compares the operator with functions of known derivatives, and its harmonics with quadratures.

use super::*;
use crate::diffusion::frame::Frame;
use crate::diffusion::harmonics::{Basis, modulus, sphere_rule};
use crate::diffusion::operator::Operator;
use crate::diffusion::start::projected;
use nalgebra::Vector3;

#[test]
fn harmonics_are_orthonormal_and_have_the_known_modulus() {
    for even in [true, false] {
        let basis = Basis { degree: 8, order: 5, even };
        let mut gram = vec![0.0; basis.len() * basis.len()];
        for (p, weight) in sphere_rule(12) {
            let values = basis.values(p);
            for (at, sum) in gram.iter_mut().enumerate() {
                *sum += weight * values[at / basis.len()] * values[at % basis.len()];
            }
        }
        for (at, value) in gram.iter().enumerate() {
            let expected = f64::from(u8::from(at / basis.len() == at % basis.len()));
            assert!((value - expected).abs() < 1e-13, "{even} {at} {value}");
        }
    }
    // |x| = ½ + (5/8) P₂ − (3/16) P₄ + …
    let shares = modulus(4);
    let of = |at: usize| shares[at] * (4.0 * at as f64 + 1.0) / (4.0 * std::f64::consts::PI);
    assert!((of(0) - 0.5).abs() + (of(1) - 0.625).abs() + (of(2) + 0.1875).abs() < 1e-15);
}

/// ψ = e^{k·Mk} with M symmetric, at p: its value and −∇·(ṗψ) + D_r∇²ψ by hand.
///
/// With f = p·Mp: ∇f = 2(Mp − f p), ∇²f = 2 tr M − 6f, ∇²e^f = e^f(∇²f + |∇f|²), and ∇·ṗ = −3 p·(ΛD)p.
fn by_hand(motion: &Motion, m: &Matrix3<f64>, p: [f64; 3]) -> (f64, f64) {
    let p = Vector3::from(p);
    let f = p.dot(&(m * p));
    let slope = 2.0 * (m * p - f * p);
    let strain = motion.strain * p;
    let rate = motion.spin.cross(&p) + strain - p * p.dot(&strain);
    let value = f.exp();
    let curved = 2.0 * m.trace() - 6.0 * f + slope.norm_squared();
    (value, value * (3.0 * p.dot(&strain) - rate.dot(&slope) + motion.diffusivity * curved))
}

/// A manufactured solution: the operator applied to ψ's harmonics gives the harmonics of its known rate.
#[test]
fn a_manufactured_solution_has_the_rate_that_is_worked_out_by_hand() {
    let m = Matrix3::new(0.9, 0.2, -0.4, 0.2, -0.5, 0.3, -0.4, 0.3, 0.1);
    let motion = Motion::new(ASKEW, 3.0, 0.17);
    let basis = Basis { degree: 24, order: 24, even: false };
    let unknowns = projected(&basis, &|p| by_hand(&motion, &m, p).0);
    let due = projected(&basis, &|p| by_hand(&motion, &m, p).1);
    let off = |operator: &Operator| {
        let mut found = vec![0.0; basis.len()];
        operator.apply(1.0, &unknowns, &mut found);
        // The highest degree lacks contributions from beyond.
        apart(&found, &due)
    };
    judge("operator", motion, |motion| off(&Operator::new(motion, basis)), 1e-12, 1e-3);
    // A missing coupling: one of many entries.
    let whole = Operator::new(&motion, basis);
    for entry in [0, 40, 333] {
        let wrong = off(&whole.without(entry));
        assert!(wrong > 1e-4, "entry {entry}: {wrong:e}");
    }
}

/// A symmetric flow in the laboratory's axes with all harmonics, compared with cosines in its own axes.
#[test]
fn axes_and_reflections_change_no_mean() {
    for motion in
        [Motion::new(COUETTE, 4.0, 0.1), Motion::new([[1.0, 0.3, 0.0], [0.5, -0.6, 0.0], [0.0, 0.0, -0.4]], 0.3, 0.2)]
    {
        let own = Frame::of(&motion);
        assert!(own.even);
        let (c, s) = (0.6, 0.8);
        let axes = Matrix3::new(c, s, 0.0, 0.0, 0.0, 1.0, s, -c, 0.0);
        let spin = axes * motion.spin;
        let plain = Motion { strain: axes * motion.strain * axes.transpose(), spin, ..motion };
        let with = |frame: &Frame| {
            crate::diffusion::settled::steady(frame, Basis { degree: 60, order: 60, even: frame.even }).unwrap()
        };
        let (found, expected) = (with(&Frame { axes, motion: plain, even: false }), with(&own));
        assert!(apart(&found, &expected) < 1e-13, "{:e}", apart(&found, &expected));
        // A vector transformed with the wrong sign.
        let mirrored = Motion { spin: -spin, ..plain };
        assert!(apart(&with(&Frame { axes, motion: mirrored, even: false }), &expected) > 1e-3);
    }
}
