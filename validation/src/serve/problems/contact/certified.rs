//! The contact rule in extended precision, for the tables of certified answers.

use super::{COUETTE, ContactProblem, PROBLEMS, pairs};
use crate::oracle::reference::big::{Big, Bits, angle, digits, length};
use rayon::prelude::*;

pub(super) const BITS: Bits = Bits(192);
const DIGITS: usize = 25;

pub(super) type Vector = [Big; 3];

/// Computes the certified answers of both problems, by name: a header, and one row per pair.
pub fn certify() -> Vec<(&'static str, String)> {
    let pairs = pairs();
    let rods: Vec<_> = pairs.par_iter().map(|pair| touched(&pair.map(|x| BITS.of(x)))).collect();
    let table = |problem: &ContactProblem| {
        let row = |(snapshot, rods): (usize, &[Touched; 2])| {
            let values = rods.iter().flat_map(|rod| problem.answer(rod));
            let values = values.map(|x| digits(&x, DIGITS));
            std::iter::once(snapshot.to_string()).chain(values).collect::<Vec<_>>().join(",") + "\n"
        };
        let rows: String = rods.par_iter().enumerate().map(row).collect();
        (problem.name, format!("snapshot,{}\n{rows}", problem.columns().join(",")))
    };
    PROBLEMS.iter().map(table).collect()
}

impl ContactProblem {
    /// The answer for a rod after the contact: ṗ′, or the angles and their rates.
    pub(super) fn answer(&self, rod: &Touched) -> Vec<Big> {
        match self.step_s {
            None => rod.rate.to_vec(),
            Some(step_s) => angles(rod, &BITS.of(step_s)),
        }
    }
}

/// A rod of a pair after the contact: its axis, and ṗ′ in 1/s.
pub(super) struct Touched {
    pub(super) p: Vector,
    pub(super) rate: Vector,
}

/// The signed arms, mm: x_a + r_a p_a and x_b + r_b p_b are the feet of the shortest segment between the two lines.
pub(super) fn arms(pair: &[Big; 14], a: &Vector, b: &Vector) -> [Big; 2] {
    let apart: Vector = [0, 1, 2].map(|i| &pair[7 + i] - &pair[i]);
    let normal = cross(a, b);
    let square = dot(&normal, &normal);
    // (d × p_b)·n/|n|² and (d × p_a)·n/|n|².
    [b, a].map(|p| dot(&cross(&apart, p), &normal) / &square)
}

/// Both rods after the contact, by A.7 to A.12 and the division by the arm of A.13.
pub(super) fn touched(pair: &[Big; 14]) -> [Touched; 2] {
    let [a, b] = [axis(&pair[3..6]), axis(&pair[10..13])];
    let normal = cross(&a, &b);
    let size = length(&normal);
    let line = normal.map(|x| x / &size);
    let arms = arms(pair, &a, &b);
    let free = [jeffery(&a, &pair[6]), jeffery(&b, &pair[13])];
    // u_2 = G x_1 at the centre, and A.7, A.8.
    let carried = [0, 7].map(|at| BITS.of(COUETTE[1][0]) * &pair[at]);
    let speed = [0, 1].map(|rod| &line[1] * &carried[rod] + dot(&line, &free[rod]) * &arms[rod]);
    let mean = (&speed[0] + &speed[1]) / BITS.of(2.0);
    // The component along the line becomes the mean; all else, u included, stays: ṗ′ = ṗ + ℓ(v̄ − v)/r.
    let mut axes = [a, b].into_iter();
    [0, 1].map(|rod| Touched {
        p: axes.next().expect("two rods"),
        rate: [0, 1, 2].map(|i| &free[rod][i] + &line[i] * (&mean - &speed[rod]) / &arms[rod]),
    })
}

/// ṗ by A.1 in u_2 = G x_1: ṗ = Ap − p(p·Ap), A₁₂ = −G/(r_e² + 1), A₂₁ = G r_e²/(r_e² + 1).
fn jeffery(p: &Vector, r: &Big) -> Vector {
    let (rate, square) = (BITS.of(COUETTE[1][0]), r.sqr());
    let whole = &square + BITS.of(1.0);
    let pull = [-(&rate * &p[1] / &whole), &rate * square * &p[0] / whole, BITS.of(0.0)];
    let along = dot(p, &pull);
    [0, 1, 2].map(|i| &pull[i] - &p[i] * &along)
}

/// φ̇′, θ̇′ by A.13, corrected, and φ, θ by A.14.
pub(super) fn angles(rod: &Touched, step: &Big) -> Vec<Big> {
    let [p1, p2, p3] = &rod.p;
    let [v1, v2, v3] = &rod.rate;
    let sine = (p1.sqr() + p2.sqr()).sqrt();
    let (along, across) = (p1 / &sine, p2 / &sine);
    let phi_rate = (v2 * &along - v1 * &across) / &sine;
    let theta_rate = (v1 * &along + v2 * &across) * p3 - v3 * &sine;
    let phi = angle(p2, p1) + &phi_rate * step;
    let theta = angle(&sine, p3) + &theta_rate * step;
    vec![phi_rate, theta_rate, phi, theta]
}

pub(super) fn axis(p: &[Big]) -> Vector {
    let p = [0, 1, 2].map(|i| p[i].clone());
    let size = length(&p);
    p.map(|x| x / &size)
}

fn dot(a: &Vector, b: &Vector) -> Big {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|i| &a[(i + 1) % 3] * &b[(i + 2) % 3] - &a[(i + 2) % 3] * &b[(i + 1) % 3])
}
