//! Values of a public spectral code, `hifabian/rigid_spheroids` 3.1 (doi:10.5281/zenodo.17984051).

use super::*;

/// What its `fp_steady` prints at a degree of 64 for r_e = 10 under Octave, without its cache of matrices: Pe = G/D_r,
/// S = ((a_22 − a_11)² + 4a_12²)^½ and χ in degrees in shear, and S in planar extension with γ̇ = G.
const ROWS: [(f64, f64, f64, f64); 3] = [
    (1.0, 0.06432064993416, 40.296724987484, 0.06519753227263),
    (10.0, 0.35560271450073, 19.395931632155, 0.54004052309014),
    (100.0, 0.62166385613496, 6.042068168691, 0.95850863888299),
];

#[test]
fn steady_shear_and_planar_extension_are_those_of_a_public_code() {
    let apart = |aspect_ratio: f64| {
        let each = ROWS.iter().map(|(peclet, order, angle_deg, extended)| {
            let planar = [[-0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0; 3]];
            let [shear, planar] =
                [COUETTE, planar].map(|l| steady(&Motion::diffusing(l, aspect_ratio, 1.0 / peclet)).unwrap());
            let order_of = |means: &Means| (means.second[1] - means.second[0]).hypot(2.0 * means.second[3]);
            let (off, extended) = (order_of(&shear) - order, order_of(&planar) - extended);
            [off, extended, (shear.extinction_angle_deg() - angle_deg).to_radians()]
        });
        each.flatten().map(f64::abs).fold(0.0, crate::larger)
    };
    assert!(apart(10.0) < 1e-10, "{:e}", apart(10.0));
    assert!(apart(10.001) > 1e-7);
}
