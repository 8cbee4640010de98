//! Tests of steady distributions: closed forms in extension, the equation of the moments, weak flows, large C_I.

use super::*;
use crate::diffusion::frame::Frame;
use crate::diffusion::harmonics::Basis;
use crate::diffusion::settled;
use crate::quadrature::integrate;

/// In flows without vorticity of any strength, ψ ∝ exp(p·(ΛD)p/2D_r) exactly.
#[test]
fn extension_has_the_density_of_bingham() {
    for (rate, aspect_ratio, c_i) in [(1.0, f64::INFINITY, 0.02), (-0.7, 5.0, 0.01), (2.0, 0.2, 0.3), (1.0, 11.6, 1e-4)]
    {
        let motion =
            Motion::new([[-0.5 * rate, 0.0, 0.0], [0.0, -0.5 * rate, 0.0], [0.0, 0.0, rate]], aspect_ratio, c_i);
        // p·Dp = rate (3z² − 1)/2.
        let r = aspect_ratio.min(1e8);
        let shape = (r * r - 1.0) / (r * r + 1.0);
        let k = 0.75 * shape * rate / (c_i * 3f64.sqrt() * rate.abs());
        let mean = |power: i32| {
            let top = k.max(0.0);
            let part = |power: i32| {
                let breaks = [0.0, 0.5, 0.9, 0.99, 1.0];
                integrate(|z| z.powi(power) * (k * z * z - top).exp(), &breaks, 1e-15)
            };
            part(power) / part(0)
        };
        let error = |motion: &Motion| {
            let found = steady(motion).unwrap();
            let [z2, z4, z] = [mean(2), mean(4), mean(1)];
            let pairs = [
                (found.second[2], z2),
                (found.second[0], 0.5 * (1.0 - z2)),
                (found.second[3], 0.0),
                (found.fourth[14], z4),
                (found.fourth[5], 0.5 * (z2 - z4)),
                (found.fourth[0], 0.375 * (1.0 - 2.0 * z2 + z4)),
                (found.projections[2], z),
            ];
            crate::worst(pairs.map(|(a, b)| (a - b).abs()))
        };
        judge((rate, aspect_ratio, c_i), motion, error, 1e-12, 1e-6);
    }
}

/// Planar extension, in which both angles matter.
#[test]
fn planar_extension_agrees_with_a_rule_over_the_sphere() {
    let motion = Motion::new([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]], 6.0, 0.05);
    let shape = 35.0 / 37.0;
    let k = shape / (2.0 * 0.05 * 2.0);
    let mut sums = [0.0; 4];
    for (p, weight) in crate::diffusion::harmonics::sphere_rule(60) {
        let density = weight * (k * (p[1] * p[1] - p[0] * p[0])).exp();
        let terms = [1.0, p[0] * p[0], p[1] * p[1], p[0] * p[0] * p[1] * p[1]];
        sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += density * term);
    }
    let error = |motion: &Motion| {
        let found = steady(motion).unwrap();
        apart(&[found.second[0], found.second[1], found.fourth[3]], &[1, 2, 3].map(|at| sums[at] / sums[0]))
    };
    judge("planar extension", motion, error, 1e-13, 1e-3);
}

/// The equation of the second moments gives a steady density the rate 0, in every flow.
#[test]
fn steady_moments_stand_still() {
    for (gradient, aspect_ratio, c_i) in [
        (COUETTE, f64::INFINITY, 1e-2),
        (COUETTE, 11.6, 1e-3),
        (COUETTE, 0.2, 0.1),
        (COUETTE, 1.0, 0.1),
        (COUETTE, 5.0, 1e3),
        (ASKEW, 3.0, 0.02),
        ([[0.2, 0.0, 0.0], [1.0, 0.3, 0.0], [0.0, 0.0, 0.6]], 10.0, 0.01),
    ] {
        let motion = Motion::new(gradient, aspect_ratio, c_i);
        let means = steady(&motion).unwrap();
        assert!(means.error < 4.1e-12 && means.error >= 0.0);
        // The terms of the rate have factors of about 1, and 6D_r.
        let bound = 1e-13 * (10.0 + 6.0 * motion.diffusivity);
        let right = rate(&motion, &means).amax();
        assert!(right < bound, "{gradient:?} {aspect_ratio} {c_i}: {right:e}");
        for (name, wrong) in mistakes(motion) {
            let wrong = rate(&motion, &steady(&wrong).unwrap()).amax();
            // A sphere is isotropic in any case; so is any rod with dominating diffusion, to first order in 1/C_I.
            assert!(aspect_ratio == 1.0 || wrong > 1e-5, "{name}: {wrong:e}");
        }
    }
}

/// Too few harmonics also satisfy the moments' equation; twice as many show the difference.
#[test]
fn refinement_does_not_stop_too_early() {
    for (gradient, aspect_ratio, c_i) in [
        (COUETTE, f64::INFINITY, 3e-3),
        (COUETTE, 11.6, 1e-3),
        (COUETTE, 0.1, 1e-2),
        (ASKEW, 8.0, 1e-2),
        ([[-0.1, 0.0, 0.0], [1.0, -0.1, 0.0], [0.0, 0.0, 0.2]], 20.0, 0.02),
        ([[1.0, 0.0, 0.0], [0.0, -0.7, 0.0], [0.0, 0.0, -0.3]], 5.0, 1e-2),
    ] {
        let frame = Frame::of(&Motion::new(gradient, aspect_ratio, c_i));
        let of = |degree, order| settled::steady(&frame, Basis { degree, order, even: frame.even }).unwrap();
        let (refined, stated) = settled::refined(&frame).unwrap();
        let many = of(140, 70);
        assert!(apart(&refined, &many) <= stated + 1e-13, "{:e} {stated:e}", apart(&refined, &many));
        let few = apart(&of(20, 14), &many);
        assert!(few > 1e-10, "{gradient:?} {aspect_ratio} {c_i}: {few:e}");
    }
}

/// a_ij = δ/3 + ΛD_ij/(15 D_r) + O(C_I⁻²).
#[test]
fn strong_diffusion_has_its_series() {
    let error = |c_i: f64, factor: f64| {
        let motion = Motion::new(ASKEW, 4.0, c_i);
        let first = motion.strain * (factor / (15.0 * motion.diffusivity)) + Matrix3::identity() / 3.0;
        (matrix(steady(&motion).unwrap().second) - first).amax()
    };
    let (near, far) = (error(50.0, 1.0), error(100.0, 1.0));
    assert!((near / far - 4.0).abs() < 0.1, "{near:e} {far:e}");
    // With a wrong factor the error only halves.
    let (near, far) = (error(50.0, 1.1), error(100.0, 1.1));
    assert!((near / far - 2.0).abs() < 0.2, "{near:e} {far:e}");
    // Without an end it leaves what spheres have.
    let [endless, spheres] =
        [(4.0, f64::INFINITY), (1.0, 0.1)].map(|(r, c_i)| steady(&Motion::new(ASKEW, r, c_i)).unwrap());
    assert_eq!(endless.second[3], 0.0);
    assert!(apart(&endless.fourth, &spheres.fourth).max(apart(&endless.projections, &spheres.projections)) < 1e-14);
}

#[test]
fn nothing_settles_without_diffusion() {
    for motion in [Motion::new([[0.0; 3]; 3], 5.0, 0.1), Motion::new(COUETTE, 5.0, 0.0)] {
        assert!(steady(&motion).is_err());
    }
}
