//! Who is near, and how likely a collision is (eq. 7).

use super::motion::vector;

/// P_c (eq. 7) at centre distance s.
pub fn collision_probability(s_mm: f64, a_mm: f64, alpha: f64, m: f64) -> f64 {
    if alpha == 0.0 {
        0.0
    } else {
        (alpha / (s_mm / a_mm + alpha)).powf(m)
    }
}

/// Nearest other rod and its centre distance in mm, no images; the lower index where two are equally near.
pub fn nearest(positions_mm: &[[f64; 3]], i: usize) -> Option<(usize, f64)> {
    let mut best: Option<(usize, f64)> = None;
    for j in (0..positions_mm.len()).filter(|&j| j != i) {
        let s_mm = distance_mm(positions_mm, i, j);
        if best.is_none_or(|(_, least)| s_mm < least) {
            best = Some((j, s_mm));
        }
    }
    best
}

pub(super) fn distance_mm(positions_mm: &[[f64; 3]], i: usize, j: usize) -> f64 {
    (vector(positions_mm[j]) - vector(positions_mm[i])).norm()
}
