//! Nearest neighbours, and the probability of a collision (eq. 7).

use super::reading::Images;

/// P_c (eq. 7) at centre distance s.
pub fn collision_probability(s_mm: f64, a_mm: f64, alpha: f64, m: f64) -> f64 {
    if alpha == 0.0 { 0.0 } else { (alpha / (s_mm / a_mm + alpha)).powf(m) }
}

/// The nearest other rod of rod i; the lowest index if several are equally near.
pub fn nearest(positions_mm: &[[f64; 3]], i: usize, images: Images, edges_mm: [f64; 3]) -> Option<usize> {
    let x = positions_mm[i];
    let (mut best, mut least_mm2) = (None, f64::INFINITY);
    for (j, &y) in positions_mm.iter().enumerate() {
        let square_mm2 = square_mm2(x, images.nearest_mm(y, x, edges_mm));
        if j != i && square_mm2 < least_mm2 {
            (best, least_mm2) = (Some(j), square_mm2);
        }
    }
    best
}

/// Σ P_c over all rods' nearest neighbours, found by checking every pair. Places and distances are in rod lengths a.
pub fn expected_candidates(places: &[Vec<f64>; 3], alpha: f64, m: f64) -> f64 {
    let [x, y, z] = places;
    let all: Vec<_> = (0..x.len()).map(|i| [x[i], y[i], z[i]]).collect();
    let chance = |i: usize| {
        let distance = nearest(&all, i, Images::None, [f64::INFINITY; 3]).map(|j| distance_mm(all[i], all[j]));
        collision_probability(distance.unwrap_or(f64::INFINITY), 1.0, alpha, m)
    };
    (0..all.len()).map(chance).sum()
}

fn square_mm2(x: [f64; 3], y: [f64; 3]) -> f64 {
    let [a, b, c] = [y[0] - x[0], y[1] - x[1], y[2] - x[2]];
    a * a + b * b + c * c
}

pub(crate) fn distance_mm(x: [f64; 3], y: [f64; 3]) -> f64 {
    square_mm2(x, y).sqrt()
}
