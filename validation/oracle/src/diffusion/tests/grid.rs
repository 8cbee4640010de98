//! A second method that shares nothing with harmonics: values on a grid of angles.

use super::*;
use crate::angle_grid;

const PLANAR: [[f64; 3]; 3] = [[-0.25, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0; 3]];
const ALONG_FIRST: [[f64; 3]; 3] = [[0.5, 0.0, 0.0], [0.0, -0.25, 0.0], [0.0, 0.0, -0.25]];
const UNEQUAL: [[f64; 3]; 3] = [[-0.7, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.5]];

/// Half a unit of the last decimal that is printed.
const CLAIMED: f64 = 5e-12;

fn shape_of(r: f64) -> f64 {
    if r.is_infinite() { 1.0 } else { (r * r - 1.0) / (r * r + 1.0) }
}

/// The largest difference between the grid and a solution by harmonics.
fn apart(gradient: [[f64; 3]; 3], r: f64, c_i: f64, rings: usize, time: f64) -> impl Fn(&Motion) -> f64 {
    let d = Matrix3::from_fn(|i, j| 0.5 * (gradient[i][j] + gradient[j][i]));
    let rate = (2.0 * d.norm_squared()).sqrt();
    let grid = angle_grid::means(gradient, shape_of(r), c_i * rate, rings, time).unwrap();
    assert!((grid.mass - 1.0).abs() < 1e-10);
    move |motion| {
        let found =
            if time.is_finite() { at(motion, Start::Isotropic, &[time]).unwrap()[0] } else { steady(motion).unwrap() };
        crate::apart(&grid.second, &found.second)
            .max(crate::apart(&grid.fourth, &found.fourth))
            .max((grid.third_projection - found.projections[2]).abs())
    }
}

/// Flows whose distribution couples even orders alone, and others, each through 32 rings or as many as its peak needs.
#[test]
fn both_methods_agree() {
    for (gradient, r, c_i, rings, time) in [
        (PLANAR, f64::INFINITY, 0.1, 32, 8.0),
        (PLANAR, f64::INFINITY, 0.1, 32, f64::INFINITY),
        (ALONG_FIRST, 0.3, 0.1, 32, 8.0),
        (ALONG_FIRST, 0.3, 0.1, 32, f64::INFINITY),
        ([[-0.25, 0.0, 0.0], [0.0, -0.25, 0.0], [0.0, 0.0, 0.5]], 0.3, 0.1, 32, f64::INFINITY),
        (UNEQUAL, 4.0, 0.1, 32, 3.0),
        (UNEQUAL, 0.4, 0.1, 32, 3.0),
        (COUETTE, f64::INFINITY, 0.2, 24, 2.0),
        (COUETTE, f64::INFINITY, 0.3, 28, f64::INFINITY),
        (COUETTE, 3.0, 0.15, 28, f64::INFINITY),
        (COUETTE, 0.3, 0.15, 28, f64::INFINITY),
        ([[-0.2, 0.5, 0.0], [0.9, 0.2, 0.0], [0.0; 3]], 11.6, 0.3, 28, f64::INFINITY),
        (ASKEW, 3.0, 0.2, 20, 2.0),
        (ASKEW, 3.0, 0.2, 20, f64::INFINITY),
    ] {
        let motion = Motion::new(gradient, r, c_i);
        judge((gradient, r, c_i, time), motion, apart(gradient, r, c_i, rings, time), CLAIMED, 1e-5);
        let stated = at(&motion, Start::Isotropic, &[2.0]).unwrap()[0].error;
        assert!(stated > 0.0 && stated < CLAIMED, "two solutions, or one twice: {stated:e}");
    }
}

/// A plane of directions, which no grid holds, by the backward equation.
#[test]
fn both_methods_agree_from_a_plane() {
    for (gradient, r, d_r, rings, time) in [(COUETTE, f64::INFINITY, 0.2, 20, 2.0), (ASKEW, 0.3, 0.3, 20, 0.5)] {
        let grid = angle_grid::planar_moments(gradient, shape_of(r), d_r, rings, time);
        let error = |motion: &Motion| {
            let found = at(motion, Start::Plane([0.0, 0.0, 1.0]), &[time]).unwrap()[0];
            crate::apart(&grid.0, &found.second).max(crate::apart(&grid.1, &found.fourth))
        };
        judge((gradient, r), Motion::diffusing(gradient, r, d_r), error, CLAIMED, 1e-5);
    }
}

/// Values that four further programs agree on (issue of 2026-11-26): even orders alone, at a peak as narrow as a
/// problem's.
#[test]
fn extension_has_the_values_that_others_found() {
    let of = |gradient, r, c_i, time| at(&Motion::new(gradient, r, c_i), Start::Isotropic, &[time]).unwrap()[0].second;
    let planar = [8.0, 16.0].map(|time| of(PLANAR, f64::INFINITY, 0.01, time));
    assert!((planar[0][1] - 0.849_603_7).abs() < 1e-7 && (planar[0][2] - 0.133_251_8).abs() < 1e-7, "{planar:?}");
    assert!((planar[1][2] - 0.039_547_5).abs() < 1e-7, "{planar:?}");
    let discs = of(ALONG_FIRST, 0.3, 0.03, 8.0);
    assert!((discs[0] - 0.041_867_0).abs() < 1e-7, "{discs:?}");
    assert!((discs[1] - 0.479_066_5).abs() < 1e-7 && (discs[1] - discs[2]).abs() < 1e-13, "{discs:?}");
}
