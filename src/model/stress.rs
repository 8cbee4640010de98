//! The particle stress of a dilute suspension of rigid bodies without Brownian motion, with their whole effect on the
//! liquid around them:
//!   σ = μ n a³ [k_A ⟨pppp⟩:D + k_B (⟨pp⟩·D + D·⟨pp⟩) + k_C D] + isotropic,
//! Here n is the number of bodies of length a per volume (Leal & Hinch 1971; docs/src/theory/coefficients.md).

use std::f64::consts::PI;

/// The body whose stress a rod has.
///
/// ```
/// use shearbed::model::stress::Body;
/// // A sphere of diameter a: 5μφD with φ = πna³/6, whatever p is (Einstein).
/// let [a, b, c] = Body::Spheroid.coefficients(1.0);
/// assert!(a == 0.0 && b == 0.0 && (c - 5.0 * std::f64::consts::PI / 6.0).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Body {
    /// A spheroid with the aspect ratio r_e of its Jeffery motion (Jeffery 1922).
    Spheroid,
    /// A cylinder with blunt ends: it turns with r_e, and its drag is that of its own length over diameter r.
    Cylinder {
        /// Length over diameter r.
        aspect_ratio: f64,
    },
}

impl Body {
    /// k_A, k_B and k_C at the aspect ratio `r_e`. For a cylinder, k_A is Batchelor's series in 1/ln 2r (1970b), and
    /// k_C is that of strain across an infinite cylinder.
    pub fn coefficients(self, r_e: f64) -> [f64; 3] {
        match self {
            // 2φ/(na³) = π/(3r²).
            Self::Spheroid => spheroid(r_e).map(|k| PI / (3.0 * r_e * r_e) * k),
            Self::Cylinder { aspect_ratio: r } => {
                let log = libm::log(2.0 * r);
                let short = 1.0 / log;
                let series = (1.0 + 0.64 * short) / (1.0 - 1.5 * short) + 1.659 * short * short;
                [PI / (6.0 * log) * series, 0.0, PI / (r * r)]
            }
        }
    }
}

/// Distance of r from 1 below which [`spheroid`] uses its series: at this distance both ways are good to 1e-8.
const NEARLY_ROUND: f64 = 1e-3;

/// A, B and C of σ = 2μφ[A ⟨pppp⟩:D + B (⟨pp⟩·D + D·⟨pp⟩) + C D], with φ the spheroids' volume fraction, from Jeffery's
/// integrals in closed form: the stress in strains along p (k_x), in a plane through p (k_y) and across p (k_z).
fn spheroid(r: f64) -> [f64; 3] {
    let d = r - 1.0;
    if d.abs() < NEARLY_ROUND {
        // Series of the integrals without terms of order d³.
        let c = 2.5 * (1.0 - 2.0 / 7.0 * d + 47.0 / 147.0 * d * d);
        return [395.0 / 147.0 * d * d, 15.0 / 14.0 * d - 895.0 / 588.0 * d * d, c];
    }
    let q = 1.0 / (r * r);
    let e = (1.0 - q).abs().sqrt();
    let angle = if r > 1.0 { libm::acosh(r) } else { libm::acos(r) };
    let e5 = e.powi(5);
    let k_x = 2.0 * e5 / (3.0 * q * ((2.0 + q) * angle - 3.0 * e));
    let k_y = 2.0 * e5 / ((1.0 + q) * (e * (1.0 + 2.0 * q) - 3.0 * q * angle));
    let k_z = 4.0 * e5 / (e * (2.0 - 5.0 * q) + 3.0 * q * q * angle);
    [1.5 * k_x - 2.0 * k_y + 0.5 * k_z, k_y - k_z, k_z]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Jeffery's integrals by quadrature in 30 digits.
    #[test]
    fn spheroids_have_the_values_of_the_integrals() {
        for (r, expected, tolerance) in [
            (11.6, [36.654_316_979_630_66, 0.063_528_879_597_003_64, 2.007_150_485_313_602_4], 1e-12),
            (2.0, [1.416_958_338_639_655_2, 0.329_968_777_760_879_76, 2.173_640_553_771_307_3], 1e-12),
            (0.5, [1.091_828_633_569_259_3, -1.203_282_817_282_500_4, 3.266_553_537_693_038_4], 1e-12),
            (1.0005, [6.714_948_135_242_478e-7, 5.353_339_330_335_213e-4, 2.499_643_056_868_923_6], 1e-9),
            (0.9995, [6.720_427_860_171_161e-7, -5.360_949_875_867_232e-4, 2.500_357_342_791_045_7], 1e-9),
        ] {
            let found = spheroid(r);
            for k in 0..3 {
                assert!((found[k] - expected[k]).abs() <= tolerance * expected[k].abs().max(1.0), "{r}: {found:?}");
            }
        }
        let [a, b, c] = spheroid(1.0 + 1e-6);
        assert!(a.abs() < 1e-11 && (b - 15.0 / 14.0 * 1e-6).abs() < 1e-11 && (c - 2.5).abs() < 1e-6, "{a} {b} {c}");
    }

    /// Batchelor's series at r = 10 by hand, and 4φ/(na³).
    #[test]
    fn cylinders_have_the_series() {
        let [a, b, c] = Body::Cylinder { aspect_ratio: 10.0 }.coefficients(7.0);
        assert!((a - 0.457_158_004_868_943_5).abs() < 1e-15 && b == 0.0, "{a} {b}");
        assert!((c - PI / 100.0).abs() < 1e-15);
    }

    /// A = r²/(2(ln 2r − 3/2)), B = (6 ln 2r − 11)/r² and C = 2 (Leal & Hinch 1971).
    #[test]
    fn slender_spheroids_have_the_published_limit() {
        let r = 1e4f64;
        let log = libm::log(2.0 * r);
        let [a, b, c] = spheroid(r);
        assert!((a / (0.5 * r * r / (log - 1.5)) - 1.0).abs() < 1e-6, "{a}");
        assert!((b * r * r / (6.0 * log - 11.0) - 1.0).abs() < 1e-3, "{b}");
        assert!((c - 2.0).abs() < 1e-6, "{c}");
    }

    /// docs/src/theory/coefficients.md: the leading order π/(6 ln 2r) is too small by 1.7 and 2.5 times at r = 11.6.
    #[test]
    fn at_r_11_6_the_leading_order_is_too_small_by_what_the_manual_says() {
        let leading = PI / (6.0 * libm::log(23.2));
        let times = |body: Body| body.coefficients(11.6)[0] / leading;
        assert!((times(Body::Spheroid) - 1.7).abs() < 0.05, "{}", times(Body::Spheroid));
        assert!((times(Body::Cylinder { aspect_ratio: 11.6 }) - 2.5).abs() < 0.05);
    }
}
