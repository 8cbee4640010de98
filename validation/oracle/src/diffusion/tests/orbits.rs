//! Orbits of rods with weak diffusion: the closed form, and the Fokker–Planck equation as C_I → 0.

use super::*;
use crate::diffusion::orbits::{cdf, mean_over_orbits, second_moments_of_orbit};

#[test]
fn the_share_of_long_orbits_is_the_known_one() {
    // 1 − C_b-distribution at ½, C = 1: 1/√5 for r → ∞.
    let above = |r: f64| 1.0 - cdf(0.5, r);
    assert!((above(f64::INFINITY) - 0.2f64.sqrt()).abs() < 1e-14);
    assert!((above(1e7) - 0.2f64.sqrt()).abs() < 1e-6);
    assert!((above(11.6) - 0.461).abs() < 5e-4, "{}", above(11.6));
    // A sphere's orbits are those of all directions alike: P(C > 1) = 1/√2.
    assert!((above(1.0) - 0.5f64.sqrt()).abs() < 1e-13, "{}", above(1.0));
    for r in [0.1, 1.0, 3.0, 5.9, 11.6, 1e3, f64::INFINITY] {
        assert!((cdf(1.0, r) - 1.0).abs() < 1e-13 && cdf(0.0, r) == 0.0);
    }
}

#[test]
fn moments_of_an_orbit_are_those_of_its_phases() {
    for (c, r) in [(0.3, 5.0), (2.0, 0.4), (1.0, 11.6)] {
        const PHASES: usize = 2000;
        let mut sums = [0.0; 3];
        for k in 0..PHASES {
            let (s, cos) = (std::f64::consts::TAU * k as f64 / PHASES as f64).sin_cos();
            let squares = [(c * cos) * (c * cos), (r * c * s) * (r * c * s), 1.0];
            let all: f64 = squares.iter().sum();
            (0..3).for_each(|i| sums[i] += squares[i] / all / PHASES as f64);
        }
        assert!(off(&second_moments_of_orbit(c, r), &sums) < 1e-14);
        assert!(off(&second_moments_of_orbit(1.1 * c, r), &sums) > 1e-3);
    }
}

/// Turning the flow round turns C_I's sign in a_ii, so a_ii = a_ii(0) + O(C_I²): two C_I leave the fourth power.
#[test]
fn weak_diffusion_is_the_limit_of_the_fokker_planck_equation() {
    for r in [0.3, 2.0, 3.0] {
        let of = |c_i: f64| {
            let found = steady(&Motion::new(COUETTE, r, c_i)).unwrap().second;
            [found[0], found[1], found[2]]
        };
        let expected = [0, 1, 2].map(|i| mean_over_orbits(r, |c| second_moments_of_orbit(c, r)[i]));
        let (near, far) = (of(2.5e-4), of(5e-4));
        let limit = std::array::from_fn(|i| near[i] + (near[i] - far[i]) / 3.0);
        let (first, second) = (off(&near, &expected), off(&limit, &expected));
        assert!(second < 1e-7 && first > 10.0 * second, "{r}: {first:e} {second:e}");
        // The orbits of isotropic rods, which free rods keep, and those of another r.
        let free = [0, 1, 2].map(|i| {
            let of_c = |c_b: f64| {
                let c = c_b / (1.0 - c_b);
                crate::closed_form::orbit_constant_density(c, r)
                    * second_moments_of_orbit(c, r)[i]
                    * (1.0 + c).powi(2)
            };
            crate::quadrature::integrate(of_c, &[1e-9, 0.1, 0.5, 0.9, 1.0 - 1e-9], 1e-12).value
        });
        assert!(off(&free, &limit) > 1e-4, "{r}: {:e}", off(&free, &limit));
        let wrong = [0, 1, 2].map(|i| mean_over_orbits(1.2 * r, |c| second_moments_of_orbit(c, r)[i]));
        assert!(off(&wrong, &limit) > 1e-3);
    }
}
