//! Tests of the orbits of rods with weak diffusion: the closed form, and the Fokker–Planck equation as C_I → 0.

use super::*;
use crate::diffusion::orbits::{
    cdf, mean_over_orbits, over_orbits, second_moments_of_orbit, shear_stress_of_isotropic, shear_stress_of_orbit,
};

#[test]
fn the_share_of_long_orbits_is_the_known_one() {
    // The share with C_b > ½ (C > 1) is 1/√5 for r → ∞.
    let above = |r: f64| 1.0 - cdf(0.5, r);
    assert!((above(f64::INFINITY) - 0.2f64.sqrt()).abs() < 1e-14);
    assert!((above(1e7) - 0.2f64.sqrt()).abs() < 1e-6);
    assert!((above(11.6) - 0.461).abs() < 5e-4, "{}", above(11.6));
    // A sphere's orbits are those of isotropic directions: P(C > 1) = 1/√2.
    assert!((above(1.0) - 0.5f64.sqrt()).abs() < 1e-13, "{}", above(1.0));
    for r in [0.1, 1.0, 3.0, 5.9, 11.6, 1e3, f64::INFINITY] {
        assert!((cdf(1.0, r) - 1.0).abs() < 1e-13 && cdf(0.0, r) == 0.0);
    }
}

#[test]
fn moments_of_an_orbit_are_those_of_its_phases() {
    for (c, r) in [(0.3, 5.0), (2.0, 0.4), (1.0, 11.6)] {
        const PHASES: usize = 2000;
        let (mut sums, mut sheared) = ([0.0; 3], 0.0);
        for k in 0..PHASES {
            let (s, cos) = (std::f64::consts::TAU * k as f64 / PHASES as f64).sin_cos();
            let squares = [(c * cos) * (c * cos), (r * c * s) * (r * c * s), 1.0];
            let all: f64 = squares.iter().sum();
            (0..3).for_each(|i| sums[i] += squares[i] / all / PHASES as f64);
            sheared += squares[0] * squares[1] / (all * all) / PHASES as f64;
        }
        assert!((shear_stress_of_orbit(c, r) - sheared).abs() < 1e-14);
        assert!((shear_stress_of_orbit(1.1 * c, r) - sheared).abs() > 1e-3);
        assert!(apart(&second_moments_of_orbit(c, r), &sums) < 1e-14);
        assert!(apart(&second_moments_of_orbit(1.1 * c, r), &sums) > 1e-3);
    }
}

/// Reversing the flow changes the sign of C_I in a_ii, so a_ii = a_ii(0) + O(C_I²): two values of C_I leave an error ∝
/// C_I⁴.
#[test]
fn weak_diffusion_is_the_limit_of_the_fokker_planck_equation() {
    for r in [0.3, 2.0, 3.0] {
        let of = |c_i: f64| {
            let found = steady(&Motion::new(COUETTE, r, c_i)).unwrap().second;
            [found[0], found[1], found[2]]
        };
        let expected = [0, 1, 2].map(|i| mean_over_orbits(r, |c| second_moments_of_orbit(c, r)[i]));
        let (near, far) = (of(2.5e-4), of(5e-4));
        let limit: [f64; 3] = std::array::from_fn(|i| near[i] + (near[i] - far[i]) / 3.0);
        let (first, second) = (apart(&near, &expected), apart(&limit, &expected));
        assert!(second < 1e-7 && first > 10.0 * second, "{r}: {first:e} {second:e}");
        // Wrong orbits: those of isotropic rods, which free rods keep, and those of another r.
        let density = |c| crate::closed_form::orbit_constant_density(c, r);
        let free = [0, 1, 2].map(|i| over_orbits(r, 1.0, 1e-12, |c| density(c) * second_moments_of_orbit(c, r)[i]));
        assert!(apart(&free, &limit) > 1e-4, "{r}: {:e}", apart(&free, &limit));
        let wrong = [0, 1, 2].map(|i| mean_over_orbits(1.2 * r, |c| second_moments_of_orbit(c, r)[i]));
        assert!(apart(&wrong, &limit) > 1e-3);
    }
}

#[test]
fn the_shear_stress_of_isotropic_rods_is_that_of_their_fourth_moments() {
    // The mean of ⟨p₁²p₂²⟩ over half a period of initially isotropic free rods, from the closed integral in time.
    const TIMES: usize = 400;
    for r in [1.5, 3.0, 5.0] {
        let at = |k: usize| crate::moments::fourth(r, 0.5 * k as f64 / TIMES as f64, [0, 0, 1, 1]);
        let mean = (0..TIMES).map(at).sum::<f64>() / TIMES as f64;
        let found = shear_stress_of_isotropic(r);
        assert!((found - mean).abs() < 1e-9, "{r}: {found} {mean}");
        assert!((shear_stress_of_isotropic(1.1 * r) - mean).abs() > 1e-4);
    }
    // Spheres stay isotropic: ⟨p₁²p₂²⟩ = 1/15.
    assert!((shear_stress_of_isotropic(1.0 + 1e-9) - 1.0 / 15.0).abs() < 1e-8);
}

/// Two values from an estimate that is independent of this project.
#[test]
fn free_rods_and_weak_diffusion_have_the_known_shear_stress() {
    let weak = mean_over_orbits(11.6, |c| shear_stress_of_orbit(c, 11.6));
    assert!((weak - 0.0214).abs() < 5e-5, "{weak}");
    assert!((shear_stress_of_isotropic(11.6) - 0.0218).abs() < 5e-5);
}
