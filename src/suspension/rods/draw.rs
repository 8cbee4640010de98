//! Draws the rods at t = 0 (eqs 11 and 12), or takes them from a file.

use super::Shapes;
use crate::model::chunks::{CHUNK, over_chunks};
use crate::model::gaussian;
use crate::model::orientation::{from_degrees, isotropic};
use crate::model::random::{Purpose, ahead, stream};
use crate::plan::{Plan, Stage};
use crate::scene::Orientation;
use rand::RngExt;
use rand_pcg::Pcg64Dxsm;

pub(super) fn draw_shapes(plan: &Plan, replica: u64) -> (Shapes, u64) {
    let particles = &plan.scene().particles;
    let mean = particles.aspect_ratio;
    if !plan.runs(Stage::AspectRatios) {
        return (Shapes::Shared(mean), 0);
    }
    if let Some(own) = particles.own_aspect_ratios() {
        return (Shapes::Each(own.to_vec()), 0);
    }
    let rng = stream(plan.scene().ensemble.seed, replica, Purpose::AspectRatios);
    // Rods stay rods and discs stay discs; a draw across r_e = 1 (or below 0) is repeated (eq. 11).
    let allowed = |r: f64| {
        if mean > 1.0 { r > 1.0 } else { r > 0.0 && r < 1.0 }
    };
    let deviation = mean * particles.aspect_ratio_sd_percent / 100.0;
    let (aspect_ratios, redrawn) = draw_gaussian(rng, particles.count, [mean, deviation], allowed);
    (Shapes::Each(aspect_ratios), redrawn)
}

/// Lengths over the mean, with the number of repeated draws; lengths of a file are divided by the scene's length.
pub(super) fn draw_lengths(plan: &Plan, replica: u64) -> (Vec<f64>, u64) {
    let particles = &plan.scene().particles;
    if !plan.runs(Stage::Lengths) {
        return (Vec::new(), 0);
    }
    if let Some(own) = particles.own_lengths_mm() {
        return (own.iter().map(|length| length / particles.length_mm).collect(), 0);
    }
    let rng = stream(plan.scene().ensemble.seed, replica, Purpose::Lengths);
    let deviation = particles.length_sd_percent / 100.0;
    draw_gaussian(rng, particles.count, [1.0, deviation], |length| length > 0.0)
}

/// `count` Gaussian numbers with this `mean` and `deviation`, redrawn until `allowed`, and the number of repeated
/// draws.
fn draw_gaussian(
    mut rng: Pcg64Dxsm,
    count: usize,
    [mean, deviation]: [f64; 2],
    allowed: impl Fn(f64) -> bool,
) -> (Vec<f64>, u64) {
    let mut redrawn = 0;
    let mut one = || {
        loop {
            let value = mean + deviation * gaussian::standard(&mut rng);
            if allowed(value) {
                return value;
            }
            redrawn += 1;
        }
    };
    let all = (0..count).map(|_| one()).collect();
    (all, redrawn)
}

pub(super) fn draw_directions(plan: &Plan, replica: u64) -> [Vec<f64>; 3] {
    let particles = &plan.scene().particles;
    if let Some(p) = particles.own().and_then(|own| own.p.as_ref()) {
        return p.clone();
    }
    let count = particles.count;
    let mut p = [(); 3].map(|()| vec![0.0; count]);
    let rng =
        plan.runs(Stage::Orientations).then(|| stream(plan.scene().ensemble.seed, replica, Purpose::Orientations));
    over_chunks(&mut p, |chunk, [p1, p2, p3]| {
        let mut rng = rng.as_ref().map(|rng| ahead(rng, 2 * (chunk * CHUNK) as u64));
        for ((p1, p2), p3) in p1.iter_mut().zip(p2).zip(p3) {
            let drawn = rng.as_mut().map(|rng| isotropic(rng.random(), rng.random()));
            let direction = match (&particles.orientation, drawn) {
                (Orientation::Random(_), Some(drawn)) => drawn,
                (Orientation::Given { phi_deg, theta_deg }, _) => from_degrees(*phi_deg, *theta_deg),
                _ => unreachable!("a plan keeps the draws of random directions"),
            };
            [*p1, *p2, *p3] = direction.into_inner().into();
        }
    });
    p
}
