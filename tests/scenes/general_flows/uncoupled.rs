//! Flows whose axes do not couple, and a rod that is refused.

use super::{moved, scene, slanted};
use crate::{file_of, parsed, planned, run};
use shearbed::nalgebra::{UnitVector3, Vector3};
use shearbed::run::ensemble;
use std::f64::consts::FRAC_1_SQRT_2;

/// ∂u_i/∂x_j, r_e, start, strain and the direction there.
type Answered = ([[f64; 3]; 3], f64, [f64; 3], f64, [f64; 3]);

/// The double next to 1.
const NEXT: f64 = 1.0 + f64::EPSILON;

/// Starts of which little lies in the coordinates that the flow draws out, where N couples these with no others, so
/// that no digit of the end is lost. The ends are exp(At)p/|exp(At)p| of the doubles given, in arithmetic of 1400
/// digits (mpmath 1.3: Taylor's series, scaled and squared; at a strain of 3e16 the exponentials of the diagonal),
/// rounded to doubles.
#[rustfmt::skip]
const UNCOUPLED: [Answered; 13] = [
    // Nearly equal rates, equal ones, and other orders of the axes.
    ([[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, NEXT]], 100.0, [7.06e-16, 1.0, -5.4e-15], 1861.0,
     [0.12963747943857756, 0.0, -0.9915614574623262]),
    ([[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, 1.0]], 100.0, [7.06e-16, 1.0, -5.4e-15], 2550.0,
     [0.12963747943859275, 0.0, -0.9915614574623242]),
    ([[-2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, NEXT]], 100.0, [1.0, -5.4e-15, 7.06e-16], 1e5,
     [0.0, -0.9915614574622174, 0.1296374794394096]),
    ([[NEXT, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -2.0]], 100.0, [7.06e-16, -5.4e-15, 1.0], 1861.0,
     [0.12963747943860796, -0.9915614574623222, 0.0]),
    // So long that the nearly equal rates come apart.
    ([[NEXT, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -2.0]], 100.0, [7.06e-16, -5.4e-15, 1.0], 3e16,
     [0.6665225509932107, -0.7454848684027751, 0.0]),
    // The other sign: a disc that moves as the rod of 1/r_e above, and a rod.
    ([[-1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, -NEXT]], 0.01, [7.06e-16, 1.0, -5.4e-15], 1861.0,
     [0.12963747943857756, 0.0, -0.9915614574623262]),
    ([[-1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, -NEXT]], 100.0, [0.6, 1e-200, -0.8], 531.9,
     [0.4179019797048527, 0.717553589479119, -0.5572026396064513]),
    // A start below the normal numbers.
    ([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.0]], 100.0, [5e-320, 0.6, 0.8], 1475.0,
     [0.9955530888533654, 0.0, 0.09420216172956544]),
    // A slow rotation of two axes that grows against the third, on other axes, of a disc; and as fast as the third to a
    // rounding.
    ([[0.5, -0.001, 0.0], [0.001, 0.5, 0.0], [0.0, 0.0, -1.0]], 11.6, [3e-16, 1e-16, 1.0], 3e3,
     [-0.46444253748300623, 0.8856032573203118, 0.0]),
    ([[-1.0, 0.0, 0.0], [0.0, 0.5, 0.001], [0.0, -0.001, 0.5]], 11.6, [1.0, 1e-16, -3e-16], 3e3,
     [0.0, -0.9871481283460531, -0.1598079244057821]),
    ([[1.0, 0.0, 0.0], [0.0, -0.5, -0.001], [0.0, 0.001, -0.5]], 0.08, [1.0, 1e-16, -3e-16], 3e3,
     [0.0, 0.8856032573203118, 0.46444253748300623]),
    ([[1.0, -2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, NEXT]], 11.6, [1e-14, -2e-14, 1.0], 1e4,
     [-9.324567374151727e-15, 2.0323691674595243e-14, 1.0]),
    // Two coupled axes beside one of its own.
    ([[1.0, 0.0, 0.25], [0.0, -2.0, 0.0], [0.25, 0.0, 1.0]], 100.0, [7e-16, 1.0, -5e-15], 1861.0,
     [-FRAC_1_SQRT_2, 0.0, -FRAC_1_SQRT_2]),
];

#[test]
fn coordinates_that_are_not_coupled_keep_their_digits() {
    let mut lost = Vec::new();
    for (rows, r, p, strain, expected) in UNCOUPLED {
        let moved = moved(rows, r, &UnitVector3::new_unchecked(p.into()), strain);
        let off = (moved.p.into_inner() - Vector3::from(expected)).norm();
        // The end is rounded to 4 ε; 106 bits of the largest exponent, 3e16, leave 1e-14. Terms of one block may cancel
        // a little.
        if !(off <= moved.error && moved.error < 1e-13 && moved.condition < 1.5) {
            lost.push((rows, r, p, strain, off, moved));
        }
    }
    assert!(lost.is_empty(), "{} of 13: {lost:#?}", lost.len());
}

/// A scene whose rods start in a file, as read.
fn from_file(rows: [[f64; 3]; 3], r: f64, strain: f64, p: [f64; 3]) -> shearbed::Scene {
    let time = format!("strain = {strain}\noutputs_per_strain = 1");
    let text = scene(rows, r, 0.0, "\"isotropic\"", &time);
    let mut scene = parsed(&text);
    scene.particles.rods = file_of(p.map(|component| vec![component; 3]));
    scene
}

#[test]
fn a_scene_of_rates_that_nearly_meet_ends() {
    let (rows, r, p, strain, expected) = UNCOUPLED[0];
    let results = run(&from_file(rows, r, strain, p));
    for (name, expected) in ["x1", "x2", "x3"].iter().zip(expected) {
        let last = *results.column(name).unwrap().mean.last().unwrap();
        assert!((last - expected.abs()).abs() <= 8.0 * f64::EPSILON, "{name}: {last}");
    }
}

/// On a dividing plane to a rounding: the bound first exceeds 1e-6 rad at some output on the way.
#[test]
fn a_refused_rod_is_named_with_its_bound_and_the_time() {
    let rows = [[0.25, 0.75, 0.0], [0.75, 0.25, 0.0], [0.0, 0.0, -0.5]];
    let (sine, cosine) = slanted();
    let mut scene = from_file(rows, 11.6, 100.0, [cosine, sine, 0.0]);
    // The first rod lies on the flow's axis.
    let p = [vec![0.5f64.sqrt(), cosine], vec![0.5f64.sqrt(), sine], vec![0.0; 2]];
    scene.particles.count = 2;
    scene.particles.rods = file_of(p);
    let error = ensemble::run(&planned(&scene)).unwrap_err().to_string();
    // The start's rounding, 4 ε, grows by e^{1.5Λ strain/√3}, which is 1e-6/4 ε = 1.1e9 at a strain of 24.4.
    assert!(error.starts_with("rod 1, output 25 (strain = 25) of replica 0, seed "), "{error}");
    for part in [" rad, more than the 1e-6 rad allowed", "r_e = 11.6", "this flow amplifies the rounding of the start"]
    {
        assert!(error.contains(part), "{part}: {error}");
    }
    assert!(!error.contains("NaN"), "{error}");
}
