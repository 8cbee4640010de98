//! Steps of methods with up to four stages, for rods and tensors: the steps of codes with slips.

use crate::turning::{angles_of, by_angles};
use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, Mul};

/// A method of four stages: the factors of h before k1 to k3 in the arguments of k2 to k4, and those in the step.
pub type Stages = ([[f64; 3]; 3], [f64; 4]);

/// The times of a problem that lie after whole numbers of equal steps, of which the last is one.
pub struct Times {
    /// The length of a step, s.
    step_s: f64,
    /// The place of each time among all, and the number of steps until it.
    pub at: Vec<(usize, u64)>,
}

impl Times {
    /// Those of the problem's times that lie after whole steps.
    pub fn new(times_s: &[f64], steps: u64) -> Self {
        let step_s = times_s.iter().fold(0.0, |a: f64, b| a.max(*b)) / steps as f64;
        let count = |(place, time_s): (usize, &f64)| {
            let count = (time_s / step_s).round();
            ((time_s / step_s - count).abs() < 1e-6).then_some((place, count as u64))
        };
        Self { step_s, at: times_s.iter().enumerate().filter_map(count).collect() }
    }

    /// The states at the times, by equal steps with these stages.
    pub fn states<V: Copy + Add<Output = V> + Mul<f64, Output = V>>(
        &self,
        (rows, weights): &Stages,
        start: V,
        rate: &dyn Fn(V) -> V,
        ended: &dyn Fn(V) -> V,
    ) -> Vec<V> {
        let h = self.step_s;
        let mut state = start;
        let mut found = Vec::with_capacity(self.at.len());
        for step in 0..self.at.last().map_or(0, |(_, count)| *count) {
            let mut k = [rate(state); 4];
            for (stage, row) in rows.iter().enumerate() {
                k[stage + 1] = rate(state + (k[0] * row[0] + k[1] * row[1] + k[2] * row[2]) * h);
            }
            state = ended(state + (k[0] * weights[0] + k[1] * weights[1] + k[2] * weights[2] + k[3] * weights[3]) * h);
            found.extend(self.at.iter().filter(|(_, count)| *count == step + 1).map(|_| state));
        }
        found
    }

    /// The tensors at the times.
    pub fn tensors(
        &self,
        stages: &Stages,
        start: Matrix3<f64>,
        rate: &dyn Fn(Matrix3<f64>) -> Matrix3<f64>,
    ) -> Vec<Matrix3<f64>> {
        self.states(stages, start, rate, &|a| a)
    }
}

/// The variable in which a code turns a rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// p.
    Raw,
    /// p, divided by |p| after each step.
    Normalised,
    /// q with q̇ = Aq.
    Linear,
    /// φ and θ, and 0.
    Angles,
}

/// All of them.
pub const FORMS: [Form; 4] = [Form::Raw, Form::Normalised, Form::Linear, Form::Angles];

/// The directions of a rod at the times, which turns by ṗ = Ap − p(p·Ap).
pub fn directions(
    form: Form,
    a: &Matrix3<f64>,
    stages: &Stages,
    times: &Times,
    start: Vector3<f64>,
) -> Vec<Vector3<f64>> {
    let rate = |state: Vector3<f64>| match form {
        Form::Linear => a * state,
        Form::Angles => {
            let ((sin, cos), (sin_phi, cos_phi)) = (state.y.sin_cos(), state.x.sin_cos());
            let pull = a * by_angles([state.x, state.y]);
            let phi = Vector3::new(-sin_phi, cos_phi, 0.0);
            let theta = Vector3::new(cos * cos_phi, cos * sin_phi, -sin);
            Vector3::new(phi.dot(&pull) / sin, theta.dot(&pull), 0.0)
        }
        Form::Raw | Form::Normalised => {
            let pull = a * state;
            pull - state * state.dot(&pull)
        }
    };
    let ended = |state: Vector3<f64>| if form == Form::Normalised { state.normalize() } else { state };
    if form != Form::Angles {
        return times.states(stages, start, &rate, &ended);
    }
    let [phi, theta] = angles_of(&start);
    let found = times.states(stages, Vector3::new(phi, theta, 0.0), &rate, &ended);
    found.iter().map(|state| by_angles([state.x, state.y])).collect()
}
