//! Problems whose answer is the solution of a closed equation: they test whether a tensor code solves its own equation.

use super::asked::{ASKEW, COUETTE, NEEDLE, SECOND, SHEAR_RATE_PER_S, UNIAXIAL, matrix};
use super::formula::RATE;
use super::table::twelve_decimals;
use super::{Built, Closed, Kind, Problem, ProblemDef};
use crate::files::csv::split;
use crate::methods::tensors::fourth::PAIRS;
use crate::methods::tensors::{self, APART, Closure, Equation, Model, at};
use nalgebra::Matrix3;

const THIRD: f64 = 1.0 / 3.0;
const RANDOM: [[f64; 3]; 3] = [[THIRD, 0.0, 0.0], [0.0, THIRD, 0.0], [0.0, 0.0, THIRD]];

/// An a_ij with six components, none of which equals another, in axes of its own.
const UNEVEN: [[f64; 3]; 3] = [[0.25, 0.125, -0.0625], [0.125, 0.4375, 0.09375], [-0.0625, 0.09375, 0.3125]];

/// Times in 1/G, G = 0.5/s.
const TIMES: [f64; 6] = [1.0, 2.0, 4.0, 7.0, 12.0, 20.0];
const TO_REST: [f64; 6] = [1.0, 2.0, 4.0, 6.25, 10.0, 65.0];

struct ClosureProblem {
    name: &'static str,
    gradient_per_s: [[f64; 3]; 3],
    aspect_ratio: f64,
    closed: Closed,
    times: [f64; 6],
}

const fn shear(name: &'static str, closure: Closure, model: Model, start: [[f64; 3]; 3]) -> ClosureProblem {
    let closed = Closed { closure, model, start };
    ClosureProblem { name, gradient_per_s: COUETTE, aspect_ratio: NEEDLE, closed, times: TIMES }
}

const fn ft(name: &'static str, closure: Closure, c_i: f64) -> ClosureProblem {
    shear(name, closure, Model::FolgarTucker { c_i }, RANDOM)
}

/// All components of a_ij, L and 𝔸 differ: mistakes that shear from random rods hides show.
const fn mixed(name: &'static str, closure: Closure) -> ClosureProblem {
    let closed = Closed { closure, model: Model::FolgarTucker { c_i: 0.02 }, start: UNEVEN };
    ClosureProblem { name, gradient_per_s: ASKEW, aspect_ratio: 5.0, closed, times: TIMES }
}

const PROBLEMS: [ClosureProblem; 18] = [
    ft("closed-ft-linear-0.1", Closure::Linear, 0.1),
    ft("closed-ft-quadratic-0.01", Closure::Quadratic, 0.01),
    ft("closed-ft-hybrid-0.01", Closure::Hybrid, 0.01),
    ft("closed-ft-natural-0.01", Closure::Natural, 0.01),
    ft("closed-ft-ore-0.01", Closure::Ore, 0.01),
    // ORW is not exactly isotropic where a is: its answer from there depends on the axes that an eigensolver happens to
    // return.
    shear("closed-ft-orw-0.01", Closure::Orw, Model::FolgarTucker { c_i: 0.01 }, APART),
    ft("closed-ft-ibof-0.01", Closure::Ibof, 0.01),
    ClosureProblem { times: TO_REST, ..ft("closed-ft-ibof-0.0311", Closure::Ibof, 0.0311) },
    ClosureProblem {
        gradient_per_s: UNIAXIAL,
        aspect_ratio: 11.6,
        ..ft("closed-ft-hybrid-extension", Closure::Hybrid, 0.05)
    },
    mixed("closed-ft-quadratic-mixed", Closure::Quadratic),
    mixed("closed-ft-hybrid-mixed", Closure::Hybrid),
    ClosureProblem { gradient_per_s: ASKEW, aspect_ratio: 3.0, ..ft("closed-ft-ibof-mixed", Closure::Ibof, 0.02) },
    shear("closed-rsc-hybrid-0.02", Closure::Hybrid, Model::Rsc { c_i: 0.02, kappa: 0.2 }, APART),
    shear("closed-rsc-ore-0.01", Closure::Ore, Model::Rsc { c_i: 0.01, kappa: 0.1 }, APART),
    // The parameters of the other settings are published: see `published/README.md` and fiberoripy's comparison in
    // perfect shear.
    shear(
        "closed-phelps-tucker-ibof",
        Closure::Ibof,
        Model::PhelpsTucker { b: [1.924e-4, 5.839e-3, 0.04, 1.168e-5, 0.0], kappa: 1.0 },
        RANDOM,
    ),
    shear("closed-iard-ore-0.0562", Closure::Ore, Model::Iard { c_i: 0.0562, c_m: 0.9977 }, RANDOM),
    shear("closed-pard-ibof-0.0218", Closure::Ibof, Model::Pard { c_i: 0.0218, omega: 0.9673 }, APART),
    shear("closed-mrd-ore-0.0198", Closure::Ore, Model::Mrd { c_i: 0.0198, d: [1.0, 0.4796, 0.012] }, APART),
];

impl ClosureProblem {
    fn equation(&self) -> Equation {
        self.closed.equation(&self.gradient_per_s, self.aspect_ratio)
    }

    fn times_s(&self) -> Vec<f64> {
        self.times.iter().map(|time| time / SHEAR_RATE_PER_S).collect()
    }
}

/// The certified answers, written by `examples/certify.rs`: a table is the same on every machine.
pub(super) const TABLE: &str = include_str!("data/closed.csv");

/// The largest difference of two solutions.
const AGREED: f64 = 1e-12;

/// Computes the table: each value from two formulations of the equation with two integrators.
pub(super) fn certify() -> Result<String, String> {
    let mut table = format!("setting,time_s,{}\n", SECOND.join(","));
    for problem in &PROBLEMS {
        let (equation, times_s, name) = (problem.equation(), problem.times_s(), problem.name);
        let start = problem.closed.start();
        let first = at(&equation, &start, &times_s, 1e-14).ok_or_else(|| format!("{name}: no solution"))?;
        let second = tensors::second::at(&equation, &start, &times_s);
        for ((time, first), second) in times_s.iter().zip(first).zip(second) {
            let off = (first - second).amax();
            if off.is_nan() || off > AGREED {
                return Err(format!("{name} at {time} s: two solutions differ by {off:e}"));
            }
            let values = twelve_decimals(PAIRS.map(|place| 0.5 * (first[place] + second[place])));
            table += &format!("{name},{time:?},{values}\n");
        }
    }
    Ok(table)
}

pub(super) fn problems() -> Vec<ProblemDef> {
    let def = |problem: &'static ClosureProblem| {
        let Closed { closure, model, .. } = problem.closed;
        let title: &'static str =
            Box::leak(format!("a_ij(t) by {} with the {} closure", model.name(), closure.name()).into());
        ProblemDef::new(problem.name, title, |def| built(def, problem))
    };
    PROBLEMS.iter().map(def).collect()
}

fn built(def: &ProblemDef, problem: &ClosureProblem) -> Built {
    let rows = TABLE.lines().map(split);
    let Closed { closure, model, .. } = problem.closed;
    let certified = rows.filter(|row| row[0] == problem.name).map(|row| row[1..].into()).collect();
    let problem = Problem {
        summary: format!(
            "The orientation tensor a_ij(t) by the model {} with the {} closure of a_ijkl, {} The answer is that of \
             this closed equation, not of the distribution of rods, which the problems folgar-tucker-* ask for.",
            model.name(),
            closure.name(),
            if problem.closed.start == RANDOM {
                "from a_ij = δ_ij/3 at t = 0."
            } else {
                "from the a_ij(0) of problem.json, whose axes are apart."
            }
        ),
        gradient_per_s: problem.gradient_per_s,
        aspect_ratio: problem.aspect_ratio,
        closed: Some(problem.closed),
        times_s: problem.times_s(),
        tolerance: 1e-10,
        because: "A fourth-order method comes to about 10 ε^(4/5) = 3e-12 per unit of strain, and an error fades \
            within some 17 units: 5e-11; twice that is left. Certified values are good to 1e-12: two writings of the \
            equation with two integrators agree to that. Closures differ from each other by 1e-4 to 1e-1."
            .into(),
        equations: [model.source(), closure.source(), RATE]
            .map(String::from)
            .into_iter()
            .chain(closure.polynomials())
            .collect(),
        ..Problem::new(def, Kind::Tensor, &SECOND)
    };
    Built::new(problem, certified)
}

impl Closed {
    /// The equation in a flow with this velocity gradient, 1/s.
    pub fn equation(&self, gradient_per_s: &[[f64; 3]; 3], aspect_ratio: f64) -> Equation {
        Equation {
            gradient_per_s: matrix(gradient_per_s),
            // (r² − 1)/(r² + 1), also where r² overflows a double.
            shape_factor: 1.0 - 2.0 / (1.0 + aspect_ratio * aspect_ratio),
            closure: self.closure,
            model: self.model,
        }
    }

    /// a_ij at t = 0.
    pub fn start(&self) -> Matrix3<f64> {
        matrix(&self.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every problem detects another closure, another model and another start.
    #[test]
    fn every_problem_tells_its_equation_from_others() {
        for problem in &PROBLEMS {
            let times_s = problem.times_s();
            let right = at(&problem.equation(), &problem.closed.start(), &times_s, 1e-11).unwrap();
            let off = |equation: Equation| {
                // A failed solution counts as different.
                let found = at(&equation, &problem.closed.start(), &times_s, 1e-11);
                let apart =
                    |all: Vec<Matrix3<f64>>| crate::oracle::worst(all.iter().zip(&right).map(|(a, b)| (a - b).amax()));
                found.map_or(f64::INFINITY, apart)
            };
            for closure in Closure::ALL.into_iter().filter(|closure| *closure != problem.closed.closure) {
                let found = off(Equation { closure, ..problem.equation() });
                assert!(found > 1e-6, "{} {closure:?}: {found:e}", problem.name);
            }
            let shape_factor = problem.equation().shape_factor * 0.999;
            assert!(off(Equation { shape_factor, ..problem.equation() }) > 1e-6, "{}", problem.name);
        }
    }
}
