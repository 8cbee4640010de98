//! Published series, and values of a public spectral code, `hifabian/rigid_spheroids` 3.1
//! (doi:10.5281/zenodo.17984051).

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
        crate::worst(each.flatten().map(f64::abs))
    };
    assert!(apart(10.0) < 1e-10, "{:e}", apart(10.0));
    assert!(apart(10.001) > 1e-7);
}

/// Peterlin & Stuart 1939, Z. Phys. 112, 129: in shear at α = G/D_r, (a_22 − a_11)² + 4a_12² is the square of
/// αΛ/15 (1 − α²/72 (1 + 6Λ²/35) + …), and χ = π/4 − α/12 (1 − α²/108 (1 + 24Λ²/35) + …).
#[test]
fn weak_shear_follows_the_series_of_peterlin_and_stuart() {
    let shape: f64 = 0.8;
    let off = |alpha: f64, [of_order, of_angle]: [f64; 2]| {
        let means = steady(&Motion::diffusing(COUETTE, 3.0, 1.0 / alpha)).unwrap();
        let square = shape * shape;
        let order = (means.second[1] - means.second[0]).hypot(2.0 * means.second[3]);
        let due = alpha * shape / 15.0 * (1.0 - alpha * alpha / 72.0 * (1.0 + of_order * square / 35.0));
        let bent = alpha / 12.0 * (1.0 - alpha * alpha / 108.0 * (1.0 + of_angle * square / 35.0));
        let angle = std::f64::consts::FRAC_PI_4 - means.extinction_angle_deg().to_radians();
        [(order / due - 1.0).abs(), (angle / bent - 1.0).abs()]
    };
    // What is left is of order α⁴: a sixteenth at half the rate.
    let [coarse, fine] = [0.4, 0.2].map(|alpha| off(alpha, [6.0, 24.0]));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(fine < 1e-5 && (14.0..18.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
    let [coarse, fine] = [0.4, 0.2].map(|alpha| off(alpha, [7.0, 25.0]));
    assert!((0..2).all(|k| coarse[k] / fine[k] < 12.0), "{coarse:?} {fine:?}");
}

/// Hinch & Leal 1972, J. Fluid Mech. 52, 683: slender rods in strong shear lie in a layer as wide as Pe^(−1/3).
#[test]
fn strong_shear_approaches_its_layer() {
    let angle_deg = |peclet: f64| {
        let motion = Motion::diffusing(COUETTE, f64::INFINITY, 1.0 / peclet);
        steady(&motion).unwrap().extinction_angle_deg()
    };
    let exponent = |peclet: f64| (angle_deg(8.0 * peclet) / angle_deg(peclet)).ln() / 8f64.ln();
    let [first, second, third] = [100.0, 800.0, 6400.0].map(exponent);
    // The rest falls as Pe^(−1/3) too: by half a factor of 8.
    let off = [first, second, third].map(|exponent| (exponent + 1.0 / 3.0).abs());
    assert!((2.0 * third - second + 1.0 / 3.0).abs() < 5e-3, "{first} {second} {third}");
    assert!(off[0] / off[1] > 1.7 && off[1] / off[2] > off[0] / off[1], "{off:?}");
}
