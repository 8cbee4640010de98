//! How large and how frequent kicks are: the formulas of docs/time-step.md.
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
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// a·D·b.
fn strain(a: Vector, b: Vector) -> f64 {
    0.5 * (a[0] * b[1] + a[1] * b[0])
}

/// 1 − Λ without cancellation.
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

/// The largest kick over GΔt where no arm is shorter than `min_arm`, at centre distance `distance`; for the rod
/// `own` against `other`: ¼[(2 − Λ_other) s/r_min + 2 − Λ_own − Λ_other].
///
/// |h| ≤ s, |ℓ·D·ℓ| and |ℓ·D·p| are ½ at most, and |r_B| ≤ |r_A| + s.
pub fn largest_kick(distance: f64, min_arm: f64, own: f64, other: f64) -> f64 {
    0.25 * ((1.0 + rest(other)) * distance / min_arm + rest(own) + rest(other))
}

/// For rods along `p_a` and `p_b` and a separation of any direction, the limit for κ ≫ GΔt of the probability that
/// a collision kicks A by more than κ, times κ/(GΔt):
///
/// |p_A × p_B| √((ℓ·D·ℓ)² + (1 − Λ_B)² (ℓ·D·p_B)²)/π.
pub fn tail_of_pair(p_a: Vector, p_b: Vector, aspect_ratio_b: f64) -> f64 {
    let normal = cross(p_a, p_b);
    let size = dot(normal, normal).sqrt();
    if size == 0.0 {
        return 0.0;
    }
    let line = normal.map(|x| x / size);
    size * strain(line, line).hypot(rest(aspect_ratio_b) * strain(line, p_b)) / PI
}

/// The same for isotropic rods: ¼⟨√((ℓ·D·ℓ)² + (1 − Λ)² (ℓ·D·p)²)⟩ over all right-angled pairs ℓ, p. For threads
/// 1/(6π).
pub fn tail_of_isotropic(aspect_ratio: f64) -> f64 {
    let epsilon = rest(aspect_ratio);
    // Over the turns χ of p about ℓ, ℓ·D·p = b cos χ with b² = |Dℓ|² − (ℓ·D·ℓ)²: an elliptic integral.
    let over_turns = |along: f64, across_square: f64| {
        let square = epsilon * epsilon * across_square;
        let sum = along * along + square;
        let modulus = if sum > 0.0 { square / sum } else { 0.0 };
        sum.sqrt() * ellipe(modulus.min(1.0)).unwrap_or(f64::NAN) / FRAC_PI_2
    };
    // One of the eight equal parts of the sphere; in each, two equal halves of φ.
    let over_height = |phi: f64| {
        let sin = (2.0 * phi).sin();
        let at = |height: f64| {
            let in_plane = (1.0 - height) * (1.0 + height);
            let along = 0.5 * in_plane * sin;
            over_turns(along, (0.25 * in_plane - along * along).max(0.0))
        };
        integrate(at, &[0.0, 1.0], 1e-9).value
    };
    let eighth = integrate(over_height, &[0.0, 0.25 * PI], 1e-9).value;
    0.25 * eighth / (0.25 * PI)
}

/// The probability that a collision of two isotropic threads (Λ = 1) kicks a given one of them by more than
/// `scaled` × GΔt, to 2·10⁻⁴ of itself where `scaled` ≥ 1: 1/(6πY) (1 − 1/(140 Y²) + …).
pub fn chance_of_threads(scaled: f64) -> f64 {
    (1.0 - 1.0 / (140.0 * scaled * scaled)) / (6.0 * PI * scaled)
}
