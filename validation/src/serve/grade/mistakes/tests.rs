//! Each curve against an independent one, and all of them against each other.

use super::physical::inverse;
use super::*;
use crate::methods::integrators::apart_rad;
use crate::methods::textbook::rk4_in_p;
use crate::oracle::quadrature::spread;
use std::f64::consts::TAU;

fn couette(aspect_ratio: f64) -> Setting {
    let mut gradient_per_s = Matrix3::zeros();
    gradient_per_s[(1, 0)] = 0.5;
    Setting { gradient_per_s, spin_per_s: Matrix3::zeros(), aspect_ratio }
}

/// RK4 of ṗ = Ap − p (p·Ap) with many steps, independent of the maps above.
fn integrated(a: &Matrix3<f64>, p: Vector3<f64>, time: f64) -> Vector3<f64> {
    rk4_in_p(a, p, time / 20_000.0, 20_000)
}

#[test]
fn the_maps_are_exponentials_of_any_traceless_matrix() {
    for (k, (u, v)) in spread(20).enumerate() {
        let x = |n: f64| (n * (u + 0.3) + 7.0 * v).sin();
        let mut a = Matrix3::new(x(1.0), x(2.0), x(3.0), x(4.0), x(5.0), x(6.0), x(7.0), x(8.0), 0.0);
        a[(2, 2)] = -a[(0, 0)] - a[(1, 1)];
        let p = Vector3::new(x(9.0), x(10.0), 1.0).normalize();
        let found = map_of(&a, 1.5).unwrap() * p;
        let expected = integrated(&a, p, 1.5);
        assert!(apart_rad(&found, &expected) < 1e-12, "{k} {}", apart_rad(&found, &expected));
        // The growth too: |q| obeys d ln|q|/dt = p·Ap; det M = 1 fixes it.
        assert!((map_of(&a, 1.5).unwrap() - (a * 1.5).exp()).norm() < 1e-12 * (a * 1.5).exp().norm());
    }
}

#[test]
fn every_mistake_differs_from_the_truth_somewhere_and_from_the_others() {
    let mut general = Setting { aspect_ratio: 3.0, ..couette(3.0) };
    general.gradient_per_s += Matrix3::new(0.2, 0.1, -0.3, 0.0, -0.3, 0.4, 0.25, -0.35, 0.1);
    let spin_per_s = Vector3::new(0.3, -0.2, 0.4).cross_matrix();
    let turning = Setting { spin_per_s, gradient_per_s: general.gradient_per_s + spin_per_s, ..general };
    let settings = [couette(11.6), couette(0.3), general, turning];
    let starts = [0.3, -0.3].map(|x| Vector3::new(x, 0.5, 0.8).normalize());
    let curve_of = |mistake: &Mistake| -> Vec<Option<Vector3<f64>>> {
        let of = |s| starts.iter().flat_map(move |p| [1.0, 7.3, 19.0].map(|t| mistake.direction(s, p, t)));
        settings.iter().flat_map(of).collect()
    };
    let truth = Mistake { name: "none".into(), ..components(String::new(), Matrix3::identity(), Matrix3::identity()) };
    let mut all = all();
    all.push(truth);
    let curves: Vec<_> = all.iter().map(curve_of).collect();
    for a in 0..all.len() {
        for b in 0..a {
            let far = curves[a].iter().zip(&curves[b]).any(|pair| match pair {
                (Some(a), Some(b)) => apart_rad(a, b) > 1e-6 || (a.norm() - b.norm()).abs() > 1e-6,
                (a, b) => a.is_some() != b.is_some(),
            });
            assert!(far, "{} = {}", all[a].name, all[b].name);
        }
    }
}

/// θ̇ with another factor, or sin θ for sin 2θ, integrated in p with the part of ṗ along θ changed.
#[test]
fn curves_of_angles_are_solutions_of_the_equations_with_the_mistake() {
    let s = couette(3.0);
    let a = s.rates_per_s();
    for (name, factor) in [
        ("twice the θ̇", (|_| 2.0) as fn(f64) -> f64),
        ("half the θ̇", |_| 0.5),
        ("four times the θ̇", |_| 4.0),
        ("θ̇ with the wrong sign", |_| -1.0),
        ("sin θ for sin 2θ in θ̇", |cos| 0.5 / cos),
    ] {
        let mistake = all().into_iter().find(|mistake| mistake.name == name).unwrap();
        for p in [Vector3::new(0.3, 0.5, 0.8), Vector3::new(-0.3, 0.5, -0.8)].map(|p| p.normalize()) {
            let rate = |p: Vector3<f64>| {
                let free = a * p - p * p.dot(&(a * p));
                let across = Vector3::new(p.x * p.z, p.y * p.z, -p.x * p.x - p.y * p.y).normalize();
                free + across * across.dot(&free) * (factor(p.z) - 1.0)
            };
            let expected = (0..20_000).fold(p, |p, _| crate::methods::integrators::rk4(rate, p, 2.0 / 20_000.0));
            let found = mistake.direction(&s, &p, 2.0).unwrap();
            assert!(apart_rad(&found, &expected) < 1e-11, "{name} {}", apart_rad(&found, &expected));
        }
    }
}

#[test]
fn names_are_told_apart() {
    let names: std::collections::BTreeSet<_> = all().into_iter().map(|mistake| mistake.name).collect();
    assert_eq!(names.len(), all().len());
    // Components in another order or with another sign keep every length.
    for mistake in permuted() {
        let Kind::Linear { start, end, .. } = mistake.kind else { panic!() };
        assert_eq!([start, end].map(|m| m * m.transpose()), [Matrix3::identity(); 2], "{}", mistake.name);
    }
}

#[test]
fn tensors_of_isotropic_rods_are_means_over_directions() {
    for r in [0.3, 1.0, 11.6] {
        for time in [0.0, 3.0, 11.0] {
            let map = right_map(&couette(r), time).unwrap();
            let found = isotropic_tensor(&map).unwrap();
            // Midpoint rule in cos θ and φ, of which the second, over a period, is exact long before the first.
            let (n, m) = (600, 150);
            let mut mean = Matrix3::zeros();
            for i in 0..n {
                for j in 0..m {
                    let z = (2.0 * f64::from(i) + 1.0) / f64::from(n) - 1.0;
                    let phi = TAU * f64::from(j) / f64::from(m);
                    let s = (1.0 - z * z).sqrt();
                    let q = (map * Vector3::new(s * phi.cos(), s * phi.sin(), z)).normalize();
                    mean += q * q.transpose();
                }
            }
            mean /= f64::from(n * m);
            // The midpoint rule is of order 2 in 1/n, the map stretches by r_e.
            let off = (found - mean).amax();
            assert!(off < 4.0 * (r.max(1.0 / r) / f64::from(n)).powi(2), "{r} {time} {off}");
            assert!((found.trace() - 1.0).abs() < 1e-13);
        }
    }
}

#[test]
fn the_inverse_of_a_formula_is_one() {
    for formula in &shearbed::model::shape::FORMULAS {
        assert!((formula.value(inverse(formula, 11.6)) / 11.6 - 1.0).abs() < 1e-12, "{}", formula.name);
        assert!(inverse(formula, 1e6).is_nan(), "{}", formula.name);
    }
}
