//! The size and frequency of kicks: the formulas of docs/src/theory/time-step.md.
//!
//! A kick is |ṗ′ − ṗ|Δt = |g|Δt/(2|r|), with g the relative velocity of the contact points along the contact line
//! and r the rod's arm. Lengths are in rod lengths, time in 1/G. D is the rate of strain of u_2 = x_1.

use super::quadrature::integrate;
use ellip::ellipe;
use std::f64::consts::{FRAC_PI_2, PI};

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a·D·b.
fn strain(a: Vector, b: Vector) -> f64 {
    0.5 * (a[0] * b[1] + a[1] * b[0])
}

/// 1 − Λ, computed without cancellation.
fn rest(aspect_ratio: f64) -> f64 {
    2.0 / (aspect_ratio * aspect_ratio + 1.0)
}

/// The kicks |ṗ′ − ṗ|Δt of two rods in contact over GΔt, for `separation` = x_B − x_A:
///
/// g = h ℓ·D·ℓ + (1 − Λ_A) r_A ℓ·D·p_A − (1 − Λ_B) r_B ℓ·D·p_B, with h = d·ℓ the gap between the lines.
pub fn kicks(separation: Vector, directions: [Vector; 2], aspect_ratios: [f64; 2]) -> [f64; 2] {
    let [a, b] = directions;
    let normal = cross(a, b);
    let size = dot(normal, normal).sqrt();
    let line = normal.map(|x| x / size);
    let cosine = dot(a, b);
    // The normal equations of the shortest line.
    let (along_a, along_b) = (dot(separation, a), dot(separation, b));
    let arms = [along_a - cosine * along_b, cosine * along_a - along_b].map(|r| r / (size * size));
    let gap = dot(separation, line) * strain(line, line) + rest(aspect_ratios[0]) * arms[0] * strain(line, a)
        - rest(aspect_ratios[1]) * arms[1] * strain(line, b);
    arms.map(|r| (0.5 * gap / r).abs())
}

/// The largest kick over GΔt of the rod `own` against `other`, at the centre distance `distance`, if no arm is shorter
/// than `min_arm`: ¼[(2 − Λ_other) s/r_min + 2 − Λ_own − Λ_other].
///
/// |h| ≤ s, |ℓ·D·ℓ| and |ℓ·D·p| are ½ at most, and |r_B| ≤ |r_A| + s.
pub fn largest_kick(distance: f64, min_arm: f64, own: f64, other: f64) -> f64 {
    0.25 * ((1.0 + rest(other)) * distance / min_arm + rest(own) + rest(other))
}

/// The probability that a collision kicks A by more than `scaled` × GΔt, for rods along `p_a` and `p_b` and a
/// separation of any direction: (2/π) atan(q/(2Y)) with
///
/// q = |p_A × p_B| √((ℓ·D·ℓ)² + (1 − Λ_B)² (ℓ·D·p_B)²).
///
/// Exact for threads (Λ = 1); else up to terms of order (1 − Λ)/Y².
pub fn chance_of_pair(p_a: Vector, p_b: Vector, aspect_ratio_b: f64, scaled: f64) -> f64 {
    let normal = cross(p_a, p_b);
    let size = dot(normal, normal).sqrt();
    if size == 0.0 {
        return 0.0;
    }
    let line = normal.map(|x| x / size);
    let q = size * strain(line, line).hypot(rest(aspect_ratio_b) * strain(line, p_b));
    (0.5 * q / scaled).atan() / FRAC_PI_2
}

/// The limit for Y → ∞ of Y × the probability of `chance_of_pair`, for isotropic rods of one aspect ratio:
/// ¼⟨√((ℓ·D·ℓ)² + (1 − Λ)² (ℓ·D·p)²)⟩ over all right-angled pairs ℓ, p. For threads 1/(6π).
pub fn tail_of_isotropic(aspect_ratio: f64) -> f64 {
    let epsilon = rest(aspect_ratio);
    // Averaged over the angle χ of p about ℓ, ℓ·D·p = b cos χ with b² = |Dℓ|² − (ℓ·D·ℓ)² gives an elliptic integral.
    let over_turns = |along: f64, across_square: f64| {
        let square = epsilon * epsilon * across_square;
        let sum = along * along + square;
        let modulus = if sum > 0.0 { square / sum } else { 0.0 };
        sum.sqrt() * ellipe(modulus.min(1.0)).unwrap_or(f64::NAN) / FRAC_PI_2
    };
    // Integrates over one of the eight equal parts of the sphere, which consists of two equal halves of φ.
    let over_height = |phi: f64| {
        let sin = (2.0 * phi).sin();
        let at = |height: f64| {
            let in_plane = (1.0 - height) * (1.0 + height);
            let along = 0.5 * in_plane * sin;
            over_turns(along, (0.25 * in_plane - along * along).max(0.0))
        };
        integrate(at, &[0.0, 1.0], 1e-9)
    };
    let eighth = integrate(over_height, &[0.0, 0.25 * PI], 1e-9);
    0.25 * eighth / (0.25 * PI)
}

/// The probability that a collision of two isotropic threads (Λ = 1) kicks a given one of them by more than `scaled` ×
/// GΔt: 1/(6πY) (1 − 1/(140 Y²) + …), with a relative error of 2·10⁻⁴ for `scaled` ≥ 1.
pub fn chance_of_threads(scaled: f64) -> f64 {
    (1.0 - 1.0 / (140.0 * scaled * scaled)) / (6.0 * PI * scaled)
}

#[cfg(test)]
mod tests {
    use super::super::naive::{collide, jeffery, stream};
    use super::*;
    use rand::RngExt;

    const GRADIENT: [Vector; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]];

    /// Isotropic directions of A and B and a separation of length 1.
    fn samples(count: usize) -> impl Iterator<Item = [Vector; 3]> {
        let mut draws = stream(3, 0, 0);
        let mut direction = move || {
            let (height, phi) = (2.0 * draws.random::<f64>() - 1.0, 2.0 * PI * draws.random::<f64>());
            let radius = (1.0 - height * height).sqrt();
            [radius * phi.cos(), radius * phi.sin(), height]
        };
        (0..count).map(move |_| [direction(), direction(), direction()])
    }

    /// The kicks of both rods by A.7 to A.13, and the arms.
    fn collided(a: Vector, b: Vector, separation: Vector, aspect_ratios: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let before = [(a, aspect_ratios[0]), (b, aspect_ratios[1])].map(|(p, r)| jeffery(p, r, GRADIENT));
        let contact = collide([0.0; 3], a, before[0], separation, b, before[1], GRADIENT).unwrap();
        let after = [contact.pdot_a_per_s, contact.pdot_b_per_s];
        let size = |k: usize| (0..3).map(|i| (after[k][i] - before[k][i]).powi(2)).sum::<f64>().sqrt();
        ([size(0), size(1)], [contact.arm_a_mm, contact.arm_b_mm])
    }

    #[test]
    fn the_gap_s_velocity_is_that_of_the_appendix_and_kicks_are_bounded() {
        let (mut compared, mut closest, mut sharpest) = (0, 0.0f64, 0.0f64);
        for (k, [a, b, d]) in samples(20_000).enumerate() {
            let ratios = [[11.6, 1.3], [0.2, 3.0], [1e4, 1e4]][k % 3];
            let (expected, arms) = collided(a, b, d, ratios);
            let square = dot(cross(a, b), cross(a, b));
            let shortest = arms[0].abs().min(arms[1].abs());
            if square < 0.05 || shortest < 0.05 {
                continue;
            }
            compared += 1;
            let found = kicks(d, [a, b], ratios);
            for i in 0..2 {
                // There are terms up to 20 arms long, each with an error of ε/sin².
                closest = closest.max((found[i] - expected[i]).abs());
                let bound = largest_kick(1.0, shortest, ratios[i], ratios[1 - i]);
                sharpest = sharpest.max(expected[i] / bound);
            }
        }
        assert!(compared > 15_000 && closest < 1e-11, "{compared} {closest}");
        assert!((0.3..=1.0).contains(&sharpest), "no bound, or a useless one: {sharpest}");
    }

    #[test]
    fn isotropic_kicks_are_counted_as_the_formulas_say() {
        let count = 400_000;
        for (ratio, scaled) in [(1e6, 1.0), (1e6, 0.3), (11.6, 2.0), (2.0, 3.0)] {
            let (mut larger, mut chance) = (0.0, 0.0);
            for [a, b, d] in samples(count) {
                larger += f64::from(collided(a, b, d, [ratio; 2]).0[0] > scaled) / count as f64;
                chance += chance_of_pair(a, b, ratio, scaled) / count as f64;
            }
            // At r_e = 2, 1 − Λ = 0.4 is neglected in terms of 1/Y².
            let allowed = 4.5 * (larger / count as f64).sqrt() + if ratio < 3.0 { 0.01 * larger } else { 0.0 };
            assert!((larger - chance).abs() < allowed, "{ratio} {scaled}: {larger} {chance}");
            // The constant of the tail, for Y where the next term of the series is known or below 10⁻³.
            if scaled >= 1.0 {
                let series = chance_of_threads(scaled) * tail_of_isotropic(ratio) * 6.0 * PI;
                assert!((series - chance).abs() < allowed, "{ratio} {scaled}: {series} {chance}");
                // Wrong variants: a mean over κ of the wrong power, or a factor of π.
                assert!((series * scaled - chance).abs() > allowed || scaled == 1.0);
                assert!((series * 1.1 - chance).abs() > allowed);
            }
        }
    }

    #[test]
    fn the_tail_of_threads_is_1_over_6_pi_and_of_spheres_more() {
        assert!((tail_of_isotropic(1e9) * 6.0 * PI - 1.0).abs() < 1e-8);
        let tails = [100.0, 11.6, 2.0, 1.0, 0.5].map(tail_of_isotropic);
        assert!(tails.is_sorted(), "{tails:?}");
        // For spheres the mean ⟨√((ℓ·D·ℓ)² + (ℓ·D·p)²)⟩ is computed by the midpoint rule over three angles.
        let n = 60;
        let mut sum = 0.0;
        for (i, j, k) in (0..n * n * n).map(|q| (q / n / n, q / n % n, q % n)) {
            let middle = |k: i32| (f64::from(k) + 0.5) / f64::from(n);
            let (height, phi, chi) = (middle(i), 0.5 * PI * middle(j), 2.0 * PI * middle(k));
            let (sin, cos) = phi.sin_cos();
            let radius = (1.0 - height * height).sqrt();
            let line = [radius * cos, radius * sin, height];
            let (across, up) = ([-sin, cos, 0.0], [-height * cos, -height * sin, radius]);
            let p = [0, 1, 2].map(|i| across[i] * chi.cos() + up[i] * chi.sin());
            sum += strain(line, line).hypot(strain(line, p)) / f64::from(n).powi(3);
        }
        // The error of the midpoint rule is h²/24 of second derivatives of order 10.
        assert!((0.25 * sum / tail_of_isotropic(1.0) - 1.0).abs() < 1e-3);
    }
}
