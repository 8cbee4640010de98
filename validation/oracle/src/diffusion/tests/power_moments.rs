//! A second method: the equations of ⟨p₁^a p₂^b⟩, which need no harmonics, closed at a high degree.

use super::*;
use nalgebra::{DMatrix, DVector};

const DEGREE: usize = 40;

/// a₁₁, a₂₂, a₁₂ and a₁₁₂₂ of a steady plane flow with the in-plane generator `g` of Jeffery's motion (ṗ = g p − p
/// p·gp).
///
/// d⟨p₁^a p₂^b⟩/dt = ⟨∇(p₁^a p₂^b)·ṗ⟩ + D_r⟨∇²p₁^a p₂^b⟩ for each power. Moments above the degree are those of
/// isotropic rods.
fn moments(g: [[f64; 2]; 2], diffusivity: f64) -> [f64; 4] {
    let powers: Vec<(usize, usize)> = (0..=DEGREE).step_by(2).flat_map(|n| (0..=n).map(move |a| (a, n - a))).collect();
    let place = |a: usize, b: usize| powers.iter().position(|power| *power == (a, b));
    let size = powers.len();
    let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
    (matrix[(0, 0)], right[0]) = (1.0, 1.0);
    for (row, (a, b)) in powers.iter().copied().enumerate().skip(1) {
        let mut add = |a: i32, b: i32, factor: f64| {
            if factor == 0.0 {
                return;
            }
            let (a, b) = (a as usize, b as usize);
            match place(a, b) {
                Some(column) => matrix[(row, column)] += factor,
                None => right[row] -= factor * isotropic(a, b),
            }
        };
        let (x, y, n) = (a as f64, b as f64, (a + b) as f64);
        let (a, b) = (a as i32, b as i32);
        add(a, b, x * g[0][0] + y * g[1][1] - diffusivity * n * (n + 1.0));
        add(a - 1, b + 1, x * g[0][1]);
        add(a + 1, b - 1, y * g[1][0]);
        add(a + 2, b, -n * g[0][0]);
        add(a, b + 2, -n * g[1][1]);
        add(a + 1, b + 1, -n * (g[0][1] + g[1][0]));
        add(a - 2, b, diffusivity * x * (x - 1.0));
        add(a, b - 2, diffusivity * y * (y - 1.0));
    }
    let found = matrix.lu().solve(&right).unwrap();
    [(2, 0), (0, 2), (1, 1), (2, 2)].map(|(a, b)| found[place(a, b).unwrap()])
}

/// ⟨p₁^a p₂^b⟩ over isotropic directions: (a − 1)!!(b − 1)!!/(a + b + 1)!! for even powers.
fn isotropic(a: usize, b: usize) -> f64 {
    let odd = |n: usize| (1..=n).step_by(2).map(|k| k as f64).product::<f64>();
    if a.is_multiple_of(2) && b.is_multiple_of(2) {
        odd(a.saturating_sub(1)) * odd(b.saturating_sub(1)) / odd(a + b + 1)
    } else {
        0.0
    }
}

#[test]
fn power_moments_agree() {
    for (gradient, aspect_ratio, c_i) in [
        (COUETTE, f64::INFINITY, 0.3),
        (COUETTE, 3.0, 0.15),
        (COUETTE, 0.3, 0.15),
        ([[-0.2, 0.5, 0.0], [0.9, 0.2, 0.0], [0.0; 3]], 11.6, 0.3),
    ] {
        let motion = Motion::new(gradient, aspect_ratio, c_i);
        let generator = motion.strain + motion.spin.cross_matrix();
        let expected = moments(
            [[generator[(0, 0)], generator[(0, 1)]], [generator[(1, 0)], generator[(1, 1)]]],
            motion.diffusivity,
        );
        let error = |motion: &Motion| {
            let found = steady(motion).unwrap();
            off(&[found.second[0], found.second[1], found.second[3], found.fourth[3]], &expected)
        };
        judge((gradient, aspect_ratio, c_i), motion, error, 1e-10, 1e-4);
    }
}
