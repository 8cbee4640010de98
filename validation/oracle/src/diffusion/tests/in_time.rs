//! Tests of densities in time: diffusion alone, free rods, late times, Bingham's starts.

use super::sharp::at_rest;
use super::*;
use crate::diffusion::bingham;
use crate::reference::big::{Bits, double};
use crate::reference::isotropic::Covariance;
use crate::reference::motion::{Motion as Free, Unit};
use nalgebra::Vector3;

/// At rest the part of degree l decays as e^{−l(l+1)D_r t}.
#[test]
fn diffusion_alone_has_the_known_decay() {
    let start = |p: [f64; 3]| 0.1 + 0.1 * (p[0] * p[1]).powi(2) + 0.05 * p[2] * (p[2] + p[0]);
    let still = Motion { strain: Matrix3::zeros(), spin: Vector3::zeros(), diffusivity: 0.3 };
    let error = |motion: &Motion| {
        let [first, last] = at(motion, Start::Density(&start), &[0.0, 0.8]).unwrap()[..] else { panic!() };
        let due = at_rest(&matrix(first.second), |q| entry(&first.fourth, q), 0.3 * 0.8);
        apart(&last.second, &due.0).max(apart(&last.fourth, &due.1))
    };
    assert!(error(&still) < 1e-13, "{:e}", error(&still));
    // Not taken as steady while a difference of more than the rounding is left: 6D_r t = 21 and 42.
    let left = at(&still, Start::Density(&start), &[0.0, 21.0 / 1.8, 42.0 / 1.8]).unwrap();
    let left: Vec<f64> = left.iter().map(|means| means.second[2] - 1.0 / 3.0).collect();
    assert!((left[1] / left[0] / (-21f64).exp() - 1.0).abs() < 1e-5 && left[2].abs() < 1e-15, "{left:?}");
    assert!(error(&Motion { diffusivity: 0.31, ..still }) > 1e-4);
    assert!(error(&Motion { strain: Matrix3::new(0.01, 0.0, 0.0, 0.0, -0.01, 0.0, 0.0, 0.0, 0.0), ..still }) > 1e-4);
}

/// C_I → 0 gives free rods, whose means are elliptic integrals.
#[test]
fn without_diffusion_rods_are_free() {
    for (gradient, aspect_ratio) in [(COUETTE, 3.0), (ASKEW, 0.4), ([[0.0, -0.7, 0.0], [0.2, 0.0, 0.0], [0.0; 3]], 8.0)]
    {
        let times = [0.4, 1.2];
        let free = Free { gradient_per_s: gradient, aspect_ratio };
        let error = |motion: &Motion| {
            let found = at(motion, Start::Isotropic, &times).unwrap();
            let each = times.iter().zip(&found).map(|(time, found)| {
                let exact = Covariance::at(&free, &Bits(64).of(*time), Unit::Second).unwrap();
                apart(&found.second, &exact.second().each_ref().map(double))
                    .max(apart(&found.fourth, &exact.fourth().each_ref().map(double)))
                    .max(apart(&found.projections, &exact.projections().each_ref().map(double)))
            });
            crate::worst(each)
        };
        let motion = Motion::new(gradient, aspect_ratio, 0.0);
        assert!(error(&Motion { diffusivity: 1e-9, ..motion }) > 1e-11);
        judge((gradient, aspect_ratio), motion, error, 1e-12, 1e-3);
    }
}

#[test]
fn late_times_are_the_steady_ones() {
    let motion = Motion::new(COUETTE, 4.0, 0.3);
    let last = at(&motion, Start::Isotropic, &[10.0, 40.0]).unwrap();
    let settled = steady(&motion).unwrap();
    assert!(apart(&last[0].fourth, &settled.fourth) < 1e-7 && apart(&last[0].fourth, &settled.fourth) > 1e-10);
    assert!(apart(&last[1].fourth, &settled.fourth) < 1e-13);
}

/// The density of Bingham has the tensor that it is made for, and in extension with K = ΛD/2D_r it stays.
#[test]
fn a_start_of_bingham_has_its_tensor() {
    for a in [[0.2, 0.5, 0.3, 0.0, 0.0, 0.0], [0.4, 0.35, 0.25, 0.1, -0.05, 0.02], [0.06, 0.84, 0.1, 0.02, 0.0, 0.01]] {
        let start = Start::Bingham(bingham(a).unwrap());
        let motion = Motion::new(ASKEW, 3.0, 0.1);
        let found = at(&motion, start, &[0.0, 0.5]).unwrap();
        assert!(apart(&found[0].second, &a) < 1e-13, "{a:?}: {:?}", found[0].second);
        assert!(apart(&found[1].second, &a) > 1e-2);
    }
    let l = [[-0.3, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, -0.1]];
    let motion = Motion::diffusing(l, 3.0, 0.1);
    let k = motion.strain / (2.0 * motion.diffusivity);
    let of = |by: f64| Start::Bingham(std::array::from_fn(|i| std::array::from_fn(|j| by * k[(i, j)])));
    let [begun, after] = [0, 1].map(|at_time| at(&motion, of(1.0), &[0.0, 3.0]).unwrap()[at_time]);
    assert!(begun.apart(&after) < 1e-12, "{:e}", begun.apart(&after));
    let [begun, after] = [0, 1].map(|at_time| at(&motion, of(1.1), &[0.0, 3.0]).unwrap()[at_time]);
    assert!(begun.apart(&after) > 1e-3);
    // No density has a negative eigenvalue, and one too narrow is not found.
    for least in [-0.1, 0.0, 1e-5] {
        assert!(bingham([least, 0.5, 0.5 - least, 0.0, 0.0, 0.0]).is_err(), "{least}");
    }
}
