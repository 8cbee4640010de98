//! Problems of the contact rule (A.7 to A.14).

use super::asked::{AXES, COUETTE, direction, period_s};
use super::tolerance::rounded_up;
use super::{Built, FORMAT, Kind, Metric, Problem, ProblemDef};
use crate::oracle::reference::big::{Big, Bits, angle, digits, double, length};
use nalgebra::Matrix3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;
use std::f64::consts::TAU;

const BITS: Bits = Bits(192);
const DIGITS: usize = 25;
const SNAPSHOTS: usize = 1000;
/// The paper's rods.
const LENGTH_MM: f64 = 0.72;
const ASPECT_RATIO: f64 = 11.6;

pub(crate) use doubles::{Variant, answers};

type Vector = [Big; 3];

/// The pair of a row of `inputs.csv`, without its number: centre, axis and r_e of a, then of b.
type Pair = [f64; 14];

pub(super) fn problems() -> Vec<ProblemDef> {
    vec![
        ProblemDef::new("contact-rule", "Two rods in, both ṗ′ out: A.7 to A.13", |def| {
            let columns = ["a_pdot1_per_s", "a_pdot2_per_s", "a_pdot3_per_s"];
            let equation = "Jeffery's equation (A.1 of Lee & Springer 1982), their rule for two rods in contact (A.7 to A.12), \
                            and ṗ′ = V′_r/r";
            built(def, None, &columns, equation, |rod, _| rod.rate.to_vec())
        }),
        ProblemDef::new(
            "contact-angles",
            "Two rods in, their angles after a step out: A.13 and A.14, corrected",
            |def| {
                let step_s = period_s(ASPECT_RATIO) / 200.0;
                let columns = ["a_phi_rate_per_s", "a_theta_rate_per_s", "a_phi_rad", "a_theta_rad"];
                let equation = "Jeffery's equation (A.1 of Lee & Springer 1982), their rule for two rods in contact (A.7 to A.12), \
                                its rates of angles (A.13, corrected as the summary says), and the step A.14";
                built(def, Some(step_s), &columns, equation, angles)
            },
        ),
    ]
}

/// A rod of a pair after the contact: its axis, and ṗ′ in 1/s.
struct Touched {
    p: Vector,
    rate: Vector,
}

/// What is asked of a rod after the contact, with Δt.
type Answer = fn(&Touched, &Big) -> Vec<Big>;

fn built(
    def: &ProblemDef,
    step_s: Option<f64>,
    columns_of_a: &[&str],
    equation: &str,
    answer: Answer,
) -> Built {
    let step = BITS.of(step_s.unwrap_or_default());
    let pairs = pairs();
    let row = |(snapshot, pair): (usize, &Pair)| {
        let rods = touched(&pair.map(|x| BITS.of(x)));
        let values = rods.iter().flat_map(|rod| answer(rod, &step));
        let values = values.map(|x| digits(&x, DIGITS));
        std::iter::once(snapshot.to_string()).chain(values).collect()
    };
    let certified = pairs.par_iter().enumerate().map(row).collect();
    let worst = (pairs.par_iter()).map(|pair| condition(pair, step_s)).reduce(|| 0.0, f64::max);
    let columns_of_b = columns_of_a.iter().map(|name| name.replacen("a_", "b_", 1));
    let columns = std::iter::once("snapshot".into())
        .chain(columns_of_a.iter().map(|name| (*name).to_owned()))
        .chain(columns_of_b);
    Built {
        problem: Problem {
            format: FORMAT,
            name: def.name.into(),
            title: def.title.into(),
            summary: summary(step_s),
            kind: Kind::Contact,
            gradient_per_s: COUETTE,
            aspect_ratio: ASPECT_RATIO,
            aspect_ratio_sd_percent: 0.0,
            times_s: Vec::new(),
            c_i: None,
            closed: None,
            time_step_s: step_s,
            columns: columns.collect(),
            metric: Metric::Relative,
            tolerance: rounded_up(100.0 * f64::EPSILON * worst),
            because: format!(
                "100 ε κ, rounded up to one digit. κ = {worst:.0} is the largest condition number of the snapshots: by how much more an \
                 answer changes, relatively, than the 14 numbers of its pair when each is changed by a small fraction. A right code \
                 takes about 100 roundings from the pair to the answer, none worse than such a change by ε."
            ),
            equations: vec![equation.into()],
            axes: AXES.into(),
            ensemble: None,
        },
        start: Vec::new(),
        inputs: pairs.iter().map(|pair| pair.to_vec()).collect(),
        certified,
    }
}

fn summary(step_s: Option<f64>) -> String {
    let asked = match step_s {
        None => "Asked for is ṗ′ of each, V′_r/r of A.13, in 1/s.".into(),
        Some(step) => format!(
            "Asked for are the rates of A.13 in its corrected form, φ̇′ = (-v_1 sin φ + v_2 cos φ)/(r sin θ) and θ̇′ = (v_1 cos θ cos φ + \
             v_2 cos θ sin φ - v_3 sin θ)/r with v = V′_r, and the angles of A.14, φ + φ̇′Δt and θ + θ̇′Δt with Δt = {step} s, φ in \
             (-π, π] before the step and not folded after it."
        ),
    };
    format!(
        "{SNAPSHOTS} pairs of rods, a = {LENGTH_MM} mm long, in contact. The contact line is along p_a × p_b; r is the signed arm \
         from a rod's centre along p to its contact point, which may lie beyond its end. V_c = L x + ṗ r, x the rod's centre (A.7), \
         with ṗ by A.1. Both parts along the contact line become their mean, all else stays (A.8 to A.11), V′_r = V′_c - L x (A.12), \
         made normal to p. {asked}"
    )
}

/// Pairs with fixed random numbers: directions isotropic, centres up to a rod length apart along each axis, r_e from 5 to 20.
///
/// Kept are those that a contact rule can be asked about without losing digits: the lines cross at 17° or more, the arms are
/// between a tenth of a rod and a rod, and both rods are 12° or more off the vorticity axis, where φ has no value.
fn pairs() -> Vec<Pair> {
    let mut random = Pcg64Dxsm::seed_from_u64(1982);
    let mut uniform = |from: f64, to: f64| from + (to - from) * random.random::<f64>();
    let mut pairs = Vec::new();
    while pairs.len() < SNAPSHOTS {
        let mut pair = [0.0; 14];
        for rod in 0..2 {
            let at = 7 * rod;
            for axis in 0..3 {
                pair[at + axis] = uniform(-0.5, 0.5) * LENGTH_MM + if axis == 0 { 1.5 } else { 0.0 };
            }
            let (phi, cosine) = (uniform(0.0, TAU), uniform(-1.0, 1.0));
            let p = direction(phi, cosine.acos());
            pair[at + 3..at + 6].copy_from_slice(&p);
            pair[at + 6] = uniform(5.0, 20.0);
        }
        if is_kept(&pair) {
            pairs.push(pair);
        }
    }
    pairs
}

fn is_kept(pair: &Pair) -> bool {
    let numbers = pair.map(|x| BITS.of(x));
    let [a, b] = [axis(&numbers[3..6]), axis(&numbers[10..13])];
    let sine = double(&length(&cross(&a, &b)));
    let arms = arms(&numbers, &a, &b).map(|arm| double(&arm).abs() / LENGTH_MM);
    let tilted = [pair[5], pair[12]].iter().all(|p3| p3.abs() < 0.978);
    sine >= 0.3 && arms.iter().all(|arm| (0.1..=1.0).contains(arm)) && tilted
}

/// The signed arms, mm: x_a + r_a p_a and x_b + r_b p_b are the feet of the shortest line between the two.
fn arms(pair: &[Big; 14], a: &Vector, b: &Vector) -> [Big; 2] {
    let apart: Vector = [0, 1, 2].map(|i| &pair[7 + i] - &pair[i]);
    let normal = cross(a, b);
    let square = dot(&normal, &normal);
    // (d × p_b)·n/|n|² and (d × p_a)·n/|n|².
    [b, a].map(|p| dot(&cross(&apart, p), &normal) / &square)
}

/// A.7 to A.12 and the division by the arm of A.13.
fn touched(pair: &[Big; 14]) -> [Touched; 2] {
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
    // The part along the line becomes the mean; all else, u included, stays: ṗ′ = ṗ + ℓ(v̄ − v)/r.
    let mut axes = [a, b].into_iter();
    [0, 1].map(|rod| Touched {
        p: axes.next().expect("two rods"),
        rate: [0, 1, 2].map(|i| &free[rod][i] + &line[i] * (&mean - &speed[rod]) / &arms[rod]),
    })
}

/// A.1 in u_2 = G x_1: ṗ = Ap − p(p·Ap), A₁₂ = −G/(r_e² + 1), A₂₁ = G r_e²/(r_e² + 1).
fn jeffery(p: &Vector, r: &Big) -> Vector {
    let (rate, square) = (BITS.of(COUETTE[1][0]), r.sqr());
    let whole = &square + BITS.of(1.0);
    let pull = [-(&rate * &p[1] / &whole), &rate * square * &p[0] / whole, BITS.of(0.0)];
    let along = dot(p, &pull);
    [0, 1, 2].map(|i| &pull[i] - &p[i] * &along)
}

/// φ̇′, θ̇′ of A.13, corrected, and φ, θ of A.14.
fn angles(rod: &Touched, step: &Big) -> Vec<Big> {
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

/// The sum over the pair's numbers of |∂answer/∂x||x|/|answer|, of the worse of the two rods. A few digits of it are
/// enough: central differences in doubles, whose truncation and rounding meet at ε^(2/3).
fn condition(pair: &Pair, step_s: Option<f64>) -> f64 {
    let small = f64::EPSILON.cbrt();
    let gradient = Matrix3::from_fn(|i, j| COUETTE[i][j]);
    let of = |pair: &Pair| doubles::answers(&gradient, pair, step_s, doubles::RIGHT);
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let size = of(pair).map(|answer| norm(&answer));
    let mut sums = [0.0; 2];
    for at in 0..pair.len() {
        let [before, after] = [-small, small].map(|part| {
            let mut moved = *pair;
            moved[at] *= 1.0 + part;
            of(&moved)
        });
        for rod in 0..2 {
            let change: Vec<_> = after[rod].iter().zip(&before[rod]).map(|(x, y)| x - y).collect();
            sums[rod] += norm(&change) / (2.0 * small * size[rod]);
        }
    }
    sums[0].max(sums[1])
}

/// The unit vector along three numbers.
fn axis(p: &[Big]) -> Vector {
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

mod doubles;
#[cfg(test)]
mod tests;
