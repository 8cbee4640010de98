//! Problems of free rods in flows other than u₂ = G x₁.

use super::asked::{ANY_FLOW, Asked, COUETTE, SHEAR_RATE_PER_S, direction, period_s};

pub(super) fn extension(rates_per_s: [f64; 3], name: &str) -> Asked {
    let diagonal = |i: usize| {
        let mut row = [0.0; 3];
        row[i] = rates_per_s[i];
        row
    };
    Asked {
        gradient_per_s: [0, 1, 2].map(diagonal),
        aspect_ratio: 11.6,
        start: vec![
            direction(1.5, 1.3),
            direction(0.1, 0.7),
            direction(2.5, 2.0),
            // Near the repelling direction.
            direction(1.57, 1.57),
            direction(4.7, 1.5),
        ],
        times_s: vec![0.25, 1.0, 2.0, 4.0],
        summary: format!(
            "Five free rods of r_e = 11.6 in {name}, with rates in 1/s. Each turns to the stretched axis; those that \
             start near the compressed plane or axis leave it slowly, and what is lost there grows. There is no \
             rotation and no period."
        ),
        equations: ANY_FLOW,
    }
}

pub(super) fn turned() -> Asked {
    // Couette flow in axes turned by Euler angles 0.7, 0.4, 1.1: L' = R L Rᵀ, rounded to doubles, which are exact here.
    let (r1, r2, r3) = (rotation(0.7), rotation(1.1), tilt(0.4));
    let turn = product(&product(&r1, &r3), &r2);
    let gradient_per_s = product(&product(&turn, &COUETTE), &transposed(&turn));
    let aspect_ratio = 5.0;
    let t = period_s(aspect_ratio);
    Asked {
        gradient_per_s,
        aspect_ratio,
        start: vec![direction(0.2, 1.0), direction(2.4, 1.9), direction(5.0, 0.4)],
        times_s: vec![0.1 * t, 0.35 * t, 0.5 * t, 1.05 * t],
        summary: "Three free rods of r_e = 5 in plane Couette flow whose axes lie askew: all nine entries of the \
            gradient are different from 0. The entries are rounded to doubles and taken as they are. A transposed \
            gradient, or axes of the wrong hand, show here."
            .into(),
        equations: ANY_FLOW,
    }
}

pub(super) fn mirrored() -> Asked {
    let aspect_ratio = 5.0;
    let t = period_s(aspect_ratio);
    Asked {
        gradient_per_s: [[0.0, SHEAR_RATE_PER_S, 0.0], [0.0; 3], [0.0; 3]],
        aspect_ratio,
        start: vec![direction(0.2, 1.0), direction(2.4, 1.9), direction(5.0, 0.4)],
        times_s: vec![0.1 * t, 0.35 * t, 0.5 * t, 1.05 * t],
        summary: "Three free rods of r_e = 5 in u_1 = G x_2: plane Couette flow with the axes of gradient and flow \
            exchanged, which turns the other way round. A code that has its own flow built in fails here."
            .into(),
        equations: ANY_FLOW,
    }
}

pub(super) fn spiral() -> Asked {
    Asked {
        gradient_per_s: [[-0.25, -1.0, 0.5], [0.75, -0.25, 0.125], [0.25, -0.5, 0.5]],
        aspect_ratio: 3.0,
        start: vec![direction(0.2, 1.0), direction(2.4, 1.9), direction(4.0, 1.57)],
        times_s: vec![0.5, 2.0, 5.0, 10.0],
        summary: "Three free rods of r_e = 3 in a flow that turns and stretches at once: W + ΛD has one real \
            eigenvalue and a complex pair, and rods spiral into an axis that is none of the coordinate axes."
            .into(),
        equations: ANY_FLOW,
    }
}

fn rotation(angle: f64) -> [[f64; 3]; 3] {
    let (s, c) = angle.sin_cos();
    [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
}

fn tilt(angle: f64) -> [[f64; 3]; 3] {
    let (s, c) = angle.sin_cos();
    [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]
}

fn transposed(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| m[j][i]))
}

fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}
