//! Problems of free rods in flows other than u₂ = G x₁.

use super::asked::{Asked, COUETTE, SHEAR_RATE_PER_S, direction, matrix};
use nalgebra::{Matrix3, Rotation3, Vector3};

pub(super) fn extension(rates_per_s: [f64; 3], name: &str) -> Asked {
    Asked {
        gradient_per_s: Matrix3::from_diagonal(&rates_per_s.into()).into(),
        rotation_rad_per_s: None,
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
    }
}

/// Three rods in a flow with the period of plane Couette flow.
fn three(gradient_per_s: [[f64; 3]; 3], summary: &str) -> Asked {
    let start = vec![direction(0.2, 1.0), direction(2.4, 1.9), direction(5.0, 0.4)];
    Asked { gradient_per_s, ..Asked::couette(5.0, start, &[0.1, 0.35, 0.5, 1.05], summary) }
}

pub(super) fn turned() -> Asked {
    // Couette flow in axes turned by Euler angles 0.7, 0.4, 1.1: L' = R L Rᵀ, rounded to doubles, which are exact here.
    let about = |axis, angle| Rotation3::from_axis_angle(&axis, angle).into_inner();
    let turn = about(Vector3::z_axis(), 0.7) * about(Vector3::x_axis(), 0.4) * about(Vector3::z_axis(), 1.1);
    let gradient: Matrix3<f64> = turn * matrix(&COUETTE) * turn.transpose();
    three(
        gradient.transpose().into(),
        "Three free rods of r_e = 5 in plane Couette flow whose axes lie askew: all nine entries of the gradient are \
         different from 0. The entries are rounded to doubles and taken as they are. A transposed gradient, or axes of \
         the wrong hand, show here.",
    )
}

pub(super) fn mirrored() -> Asked {
    three(
        [[0.0, SHEAR_RATE_PER_S, 0.0], [0.0; 3], [0.0; 3]],
        "Three free rods of r_e = 5 in u_1 = G x_2: plane Couette flow with the axes of gradient and flow exchanged, \
         which turns the other way round. A code that has its own flow built in fails here.",
    )
}

pub(super) fn turning() -> Asked {
    let summary = "Three free rods of r_e = 5 in plane Couette flow, seen from axes that turn: the velocity gradient \
        L(t) changes in time. A code that takes L once a step falls to order 1, and one that takes it at wrong times \
        within a step loses its order too: no steady flow shows that.";
    Asked { rotation_rad_per_s: Some([0.375, -0.25, 0.5]), ..three(COUETTE, summary) }
}

pub(super) fn spiral() -> Asked {
    Asked {
        gradient_per_s: [[-0.25, -1.0, 0.5], [0.75, -0.25, 0.125], [0.25, -0.5, 0.5]],
        rotation_rad_per_s: None,
        aspect_ratio: 3.0,
        start: vec![direction(0.2, 1.0), direction(2.4, 1.9), direction(4.0, 1.57)],
        times_s: vec![0.5, 2.0, 5.0, 10.0],
        summary: "Three free rods of r_e = 3 in a flow that turns and stretches at once: W + ΛD has one real \
            eigenvalue and a complex pair, and rods spiral into an axis that is none of the coordinate axes."
            .into(),
    }
}
