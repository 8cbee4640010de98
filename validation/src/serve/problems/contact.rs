//! Problems of the contact rule (A.7 to A.14).

use super::asked::{COUETTE, direction, period_s};
use super::check::{ANGLES, RATES};
use super::tolerance::rounded_up;
use super::{Built, Kind, Problem, ProblemDef};
use crate::files::csv::split;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Dxsm;
use std::f64::consts::TAU;
use std::sync::LazyLock;

pub(crate) const SNAPSHOTS: usize = 1000;
/// The longest arm in rod lengths: a code that clips arms, at an end or at a rod's length, must fail.
const LONGEST_ARM: f64 = 2.0;
/// The aspect ratio of the paper's rods.
pub(crate) const ASPECT_RATIO: f64 = 11.6;

pub(crate) use crate::methods::contact::{self as doubles, LENGTH_MM, RIGHT, Step, Variant, answers, within};
pub use certified::certify;

/// The pair of a row of `inputs.csv`, without its number: centre, axis and r_e of a, then of b.
type Pair = [f64; 14];

/// The question about each pair.
struct ContactProblem {
    name: &'static str,
    title: &'static str,
    /// The time step of A.14, s; none if rates are asked for.
    step_s: Option<f64>,
    /// The largest condition number of the pairs, rounded to a whole number.
    condition: f64,
    equation: &'static str,
    /// The certified answers, written by `examples/certify.rs`: a table is the same on every machine.
    table: &'static str,
}

static PROBLEMS: LazyLock<[ContactProblem; 2]> = LazyLock::new(|| {
    [
        ContactProblem {
            name: "contact-rule",
            title: "Two rods in, both ṗ′ out: A.7 to A.13",
            step_s: None,
            condition: 519.0,
            equation: "Jeffery's equation (A.1 of Lee & Springer 1982), their rule for two rods in contact (A.7 to \
                A.12), and ṗ′ = V′_r/r",
            table: include_str!("data/contact-rule.csv"),
        },
        ContactProblem {
            name: "contact-angles",
            title: "Two rods in, their angles after a step out: A.13 and A.14, corrected",
            step_s: Some(period_s(ASPECT_RATIO) / 200.0),
            condition: 58.0,
            equation: "Jeffery's equation (A.1 of Lee & Springer 1982), their rule for two rods in contact (A.7 to \
                A.12), its rates of angles (A.13, corrected as the summary says), and the step A.14",
            table: include_str!("data/contact-angles.csv"),
        },
    ]
});

pub(super) fn problems() -> Vec<ProblemDef> {
    let def = |problem: &'static ContactProblem| ProblemDef::new(problem.name, problem.title, |def| problem.built(def));
    PROBLEMS.iter().map(def).collect()
}

impl ContactProblem {
    /// The columns after the number of the snapshot.
    fn columns(&self) -> &'static [&'static str] {
        if self.step_s.is_some() { &ANGLES } else { &RATES }
    }

    fn built(&self, def: &ProblemDef) -> Built {
        let problem = Problem {
            summary: summary(self.step_s),
            aspect_ratio: ASPECT_RATIO,
            time_step_s: self.step_s,
            tolerance: rounded_up(100.0 * f64::EPSILON * self.condition),
            because: format!(
                "100 ε κ, rounded up to one digit. κ = {} is the largest condition number of the snapshots: by how \
                 much more an answer changes, relatively, than the 14 numbers of its pair when each is changed by a \
                 small fraction. A right code takes about 100 roundings from the pair to the answer, none worse than \
                 such a change by ε.",
                self.condition
            ),
            equations: vec![self.equation.into()],
            ..Problem::new(def, Kind::Contact, self.columns())
        };
        let inputs = pairs().iter().map(|pair| pair.to_vec()).collect();
        Built { inputs, ..Built::new(problem, self.table.lines().skip(1).map(split).collect()) }
    }
}

fn summary(step_s: Option<f64>) -> String {
    let asked = match step_s {
        None => "Asked for is ṗ′ of each, V′_r/r of A.13, in 1/s.".into(),
        Some(step) => format!(
            "Asked for are the rates of A.13 in its corrected form, φ̇′ = (-v_1 sin φ + v_2 cos φ)/(r sin θ) and θ̇′ = \
             (v_1 cos θ cos φ + v_2 cos θ sin φ - v_3 sin θ)/r with v = V′_r, and the angles of A.14, φ + φ̇′Δt and θ \
             + θ̇′Δt with Δt = {step} s, φ taken modulo 2π."
        ),
    };
    format!(
        "{SNAPSHOTS} pairs of rods, a = {LENGTH_MM} mm long, in contact. The contact line is along p_a × p_b; r is the \
         signed arm from a rod's centre along p to its contact point, which may lie beyond its end. V_c = L x + ṗ r, x \
         the rod's centre (A.7), with ṗ by A.1. Both parts along the contact line become their mean, all else stays \
         (A.8 to A.11), V′_r = V′_c - L x (A.12), made normal to p. {asked}"
    )
}

/// Pairs with fixed random numbers: directions isotropic, centres up to a rod length apart along each axis, r_e from 5
/// to 20.
///
/// Only pairs are kept for which the contact rule loses no digits: the lines cross at 17° or more, the arms are between
/// a tenth of a rod and two rods (an end is at half a rod), and both rods are 12° or more off the vorticity axis, where
/// φ is undefined.
fn pairs() -> Vec<Pair> {
    candidates().filter(is_kept).take(SNAPSHOTS).collect()
}

fn candidates() -> impl Iterator<Item = Pair> {
    let mut random = Pcg64Dxsm::seed_from_u64(1982);
    let mut uniform = move |from: f64, to: f64| from + (to - from) * random.random::<f64>();
    std::iter::repeat_with(move || {
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
        pair
    })
}

fn is_kept(pair: &Pair) -> bool {
    let geometry = doubles::geometry(pair);
    let arms = geometry.arms.map(|arm| arm.abs() / LENGTH_MM);
    let tilted = [pair[5], pair[12]].iter().all(|p3| p3.abs() < 0.978);
    geometry.sine >= 0.3 && arms.iter().all(|arm| (0.1..=LONGEST_ARM).contains(arm)) && tilted
}

mod certified;
#[cfg(test)]
mod tests;
