//! Rotary diffusion of a direction on the sphere.

use nalgebra::Vector3;

/// The mean of 1 − p(0)·p(t) after a time t: 1 − e^{−2D_r t}.
pub fn mean_turn(diffusivity_per_s: f64, time_s: f64) -> f64 {
    -libm::expm1(-2.0 * diffusivity_per_s * time_s)
}

/// The direction `p` turned at random, from two uniform numbers in [0, 1): by an angle whose 1 − cos is exponential
/// with this mean (cut at 2), towards any side alike.
///
/// With [`mean_turn`], ⟨P_l⟩ of the cosine is e^{−l(l+1)D_r t} to a relative error of the order of (D_r t)³ for every l
/// (and exact for l = 1, but for the cut): a weak scheme of order 2. A Gaussian angle in the tangent plane has order 1.
pub fn turned(p: [f64; 3], mean: f64, [r, s]: [f64; 2]) -> [f64; 3] {
    let turn = (-mean * libm::log1p(-r)).min(2.0);
    let (sine, cosine) = libm::sincos(std::f64::consts::TAU * s);
    let across = (turn * (2.0 - turn)).sqrt();
    // Axes across p without a branch near a pole (Duff et al. 2017).
    let [x, y, z] = p;
    let sign = 1f64.copysign(z);
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    let first = Vector3::new(1.0 + sign * x * x * a, sign * b, -sign * x);
    let second = Vector3::new(b, sign + y * y * a, -y);
    let end = Vector3::from(p) * (1.0 - turn) + (first * cosine + second * sine) * across;
    end.normalize().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ⟨P_l⟩ over both numbers, on a grid of midpoints, against the heat kernel's; halving the time divides the error
    /// of l = 2 by eight.
    #[test]
    fn a_turn_has_the_means_of_the_heat_kernel() {
        let p = Vector3::new(0.36, -0.48, -0.8);
        let error = |d_t: f64, factor: f64| {
            const NODES: usize = 20_000;
            let mut sums = [0.0; 2];
            for node in 0..NODES {
                // Substituted such that the tail of the exponential is resolved.
                let u = (node as f64 + 0.5) / NODES as f64;
                let (r, weight) = (1.0 - (1.0 - u).powi(4), 4.0 * (1.0 - u).powi(3) / NODES as f64);
                let end = turned(<[f64; 3]>::from(p), factor * mean_turn(1.0, d_t), [r, 7.0 * u % 1.0]);
                let c = p.dot(&Vector3::from(end));
                sums[0] += weight * c;
                sums[1] += weight * (1.5 * c * c - 0.5);
            }
            [(sums[0] - (-2.0 * d_t).exp()).abs(), (sums[1] - (-6.0 * d_t).exp()).abs()]
        };
        let (long, short) = (error(0.02, 1.0), error(0.01, 1.0));
        assert!(long[0] < 1e-8 && short[0] < 1e-8, "{long:?} {short:?}");
        assert!((6.5..9.5).contains(&(long[1] / short[1])), "{long:?} {short:?}");
        assert!(error(0.02, 0.5)[0] > 1e-2);
    }

    /// Turns go towards every side alike: the sum over sides is along p, and its square across p is round.
    #[test]
    fn every_side_is_alike() {
        for p in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.8, 0.0], [0.36, -0.48, 0.8]] {
            let (p, mut sum, mut square) = (Vector3::from(p), Vector3::zeros(), nalgebra::Matrix3::zeros());
            for k in 0..12 {
                let end = Vector3::from(turned(<[f64; 3]>::from(p), 0.1, [0.5, f64::from(k) / 12.0]));
                sum += end / 12.0;
                square += end * end.transpose() / 12.0;
            }
            let c = sum.norm();
            assert!((sum - p * c).norm() < 1e-15, "{p}");
            let round = (nalgebra::Matrix3::identity() - p * p.transpose()) * (0.5 * (1.0 - c * c));
            assert!((square - p * p.transpose() * c * c - round).amax() < 1e-15, "{p}");
        }
    }
}
