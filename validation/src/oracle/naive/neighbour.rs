//! Who is near, and how likely a collision is (eq. 7).

use super::motion::vector;
use super::reading::Images;
use nalgebra::Vector3;

/// P_c (eq. 7) at centre distance s.
pub fn collision_probability(s_mm: f64, a_mm: f64, alpha: f64, m: f64) -> f64 {
    if alpha == 0.0 {
        0.0
    } else {
        (alpha / (s_mm / a_mm + alpha)).powf(m)
    }
}

/// Nearest other rod; the lower index where two are equally near.
pub fn nearest(positions_mm: &[[f64; 3]], i: usize, images: Images, edge_mm: f64) -> Option<usize> {
    let x = positions_mm[i];
    let mut best: Option<(usize, f64)> = None;
    for j in (0..positions_mm.len()).filter(|&j| j != i) {
        let square = separation_mm(x, images.nearest_mm(positions_mm[j], x, edge_mm)).norm_squared();
        if best.is_none_or(|(_, least)| square < least) {
            best = Some((j, square));
        }
    }
    best.map(|(j, _)| j)
}

/// From `x` to `y`.
pub(super) fn separation_mm(x: [f64; 3], y: [f64; 3]) -> Vector3<f64> {
    vector(y) - vector(x)
}
