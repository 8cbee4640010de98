//! Starts that no number of harmonics resolves: a plane of directions, and one direction.

use super::*;
use nalgebra::Vector3;

const AXIS: [f64; 3] = [0.0, 0.0, 1.0];
/// A direction with |p| = 1 in doubles.
const SLANTED: [f64; 3] = [0.36, 0.48, 0.8];
const TIMES: [f64; 4] = [0.0, 0.01, 0.1, 1.0];

/// a_ij and a_ijkl of a start at rest: the parts of degree 0, 2 and 4 decay as e^{−l(l+1)D_r t}. Degrees
/// 0 and 2 of a_ijkl are the sum of (δ_ij a_kl + a_ij δ_kl)/7 − δ_ij δ_kl/35 over the three pairings.
pub(super) fn at_rest(second: &Matrix3<f64>, fourth: impl Fn([usize; 4]) -> f64, d_t: f64) -> ([f64; 6], [f64; 15]) {
    let (two, four) = ((-6.0 * d_t).exp(), (-20.0 * d_t).exp());
    let one = |i: usize, j: usize| f64::from(u8::from(i == j));
    let now = |i: usize, j: usize| one(i, j) / 3.0 + (second[(i, j)] - one(i, j) / 3.0) * two;
    let low = |a: &dyn Fn(usize, usize) -> f64, q: [usize; 4]| {
        let pairings = [[0, 1, 2, 3], [0, 2, 1, 3], [0, 3, 1, 2]].map(|order| order.map(|k| q[k]));
        let sum = pairings
            .map(|[i, j, k, l]| (one(i, j) * a(k, l) + one(k, l) * a(i, j)) / 7.0 - one(i, j) * one(k, l) / 35.0);
        sum.iter().sum::<f64>()
    };
    let fourths = QUADRUPLES.map(|q| {
        let q = q.map(|i| i - 1);
        low(&now, q) + (fourth(q) - low(&|i, j| second[(i, j)], q)) * four
    });
    (PAIRS.map(|(i, j)| now(i, j)), fourths)
}

/// At rest both starts fade by the closed form, to the digits of doubles.
#[test]
fn at_rest_moments_decay_by_the_closed_form() {
    let p = Vector3::from(SLANTED);
    let planar = Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 0.0));
    let of_plane = |q: [usize; 4]| {
        let count = |axis| q.iter().filter(|i| **i == axis).count();
        match [count(0), count(1), count(2)] {
            [4, 0, 0] | [0, 4, 0] => 0.375,
            [2, 2, 0] => 0.125,
            _ => 0.0,
        }
    };
    let error = |motion: &Motion, start| {
        let each = at(motion, start, &TIMES).unwrap().into_iter().zip(TIMES).map(|(found, time)| {
            let due = match start {
                Start::Plane(_) => at_rest(&planar, of_plane, 0.3 * time),
                _ => at_rest(&(p * p.transpose()), |q| q.iter().map(|i| p[*i]).product(), 0.3 * time),
            };
            apart(&found.second, &due.0).max(apart(&found.fourth, &due.1))
        });
        crate::worst(each)
    };
    let still = Motion::diffusing([[0.0; 3]; 3], 5.0, 0.3);
    for start in [Start::Plane(AXIS), Start::Direction(SLANTED)] {
        assert!(error(&still, start) < 1e-14, "{:e}", error(&still, start));
        assert!(error(&Motion { diffusivity: 0.301, ..still }, start) > 1e-4);
    }
    assert!(error(&still, Start::Plane([0.0, 1.0, 0.0])) > 0.1);
}

/// From a plane ⟨|p₃|⟩ starts as the mean size of a Gaussian of variance 2D_r t.
#[test]
fn a_plane_opens_as_a_gaussian_of_twice_the_diffusivity() {
    let still = Motion::diffusing([[0.0; 3]; 3], 5.0, 0.3);
    let time = 1e-3;
    let opened = |motion: &Motion| at(motion, Start::Plane(AXIS), &[time]).unwrap()[0].projections[2];
    let due = (4.0 * 0.3 * time / std::f64::consts::PI).sqrt();
    // The sphere's curvature is a share of the order of D_r t.
    assert!((opened(&still) / due - 1.0).abs() < 1e-3, "{}", opened(&still) / due);
    assert!((opened(&Motion { diffusivity: 0.6, ..still }) / due - 1.0).abs() > 0.3);
}

/// What a plane becomes is the mean of what its directions become, each cut in its own way.
#[test]
fn in_a_flow_a_plane_is_the_mean_of_its_directions() {
    const AROUND: usize = 24;
    for (gradient, r, d_r) in [(COUETTE, f64::INFINITY, 0.1), (ASKEW, 3.0, 0.05)] {
        let motion = Motion::diffusing(gradient, r, d_r);
        let plane = at(&motion, Start::Plane(AXIS), &[0.5]).unwrap()[0];
        assert!(plane.error > 0.0, "two solutions, or one twice");
        let error = |motion: &Motion| {
            let mut sum = [0.0; 6];
            for k in 0..AROUND {
                let (s, c) = (std::f64::consts::PI * k as f64 / AROUND as f64).sin_cos();
                let one = at(motion, Start::Direction([c, s, 0.0]), &[0.5]).unwrap()[0];
                sum.iter_mut().zip(one.second).for_each(|(sum, x)| *sum += x / AROUND as f64);
            }
            apart(&sum, &plane.second)
        };
        // Each is good to 4e-12, and harmonics of φ above 24 have no part in so early a mean.
        judge((gradient, r), motion, error, 2e-11, 1e-4);
    }
}

/// The means over several directions are the mean of those of each.
#[test]
fn directions_are_the_mean_of_each() {
    let [first, second] = [SLANTED, [0.0, -0.6, 0.8]];
    fn of(start: Start) -> Vec<Means> {
        at(&Motion::diffusing(ASKEW, 5.0, 0.3), start, &TIMES).unwrap()
    }
    let each = [first, second, first].map(|p| of(Start::Direction(p)));
    let error = |all: &[[f64; 3]]| {
        let mean = |at: usize| {
            let mut sum = Means::new(&[0.0; crate::diffusion::MEANS], 0.0);
            each.iter().for_each(|of_one| sum.add(1.0 / 3.0, &of_one[at]));
            sum
        };
        crate::worst(of(Start::Directions(all)).iter().enumerate().map(|(at, found)| found.apart(&mean(at))))
    };
    assert!(error(&[first, second, first.map(|x| -x)]) < 1e-11);
    assert!(error(&[first, second]) > 1e-2);
}
