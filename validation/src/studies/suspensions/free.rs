//! Free suspensions: the error of X̄₁ against the rods and the run time, for every way to choose initial directions. No
//! time step is needed: the remaining error is that of the sample.

use super::*;
use crate::methods::starts::{self, Rod, Start};
use crate::oracle::isotropic;
use crate::studies::work_precision::{Budget, Seconds, measure};

/// The errors of X̄₁ for which the cheapest start is sought.
pub const TARGETS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-6];

/// A free suspension, isotropic at first, in plane Couette flow, and a time at which X̄₁ is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Free {
    /// The built-in scene with these rods.
    pub scene: &'static str,
    /// r_e, or its mean for unequal rods.
    pub aspect_ratio: f64,
    /// σ of r_e, in percent of its mean.
    pub sd_percent: f64,
    pub turns: f64,
}

/// The free suspensions of the paper's Fig. 6, shortly before the end of the first period.
pub const SCENES: [Free; 2] = [
    Free { scene: "fig6-uniform", aspect_ratio: 11.6, sd_percent: 0.0, turns: 0.95 },
    Free { scene: "fig6-polydisperse", aspect_ratio: 11.6, sd_percent: 3.6, turns: 0.95 },
];

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Point {
    pub rods: usize,
    /// The root mean square of X̄₁ less the closed form.
    pub error: f64,
    /// The number of trials, each with rods of its own.
    pub trials: usize,
    /// The time to choose and move the rods once.
    pub seconds: Seconds,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StartCurve {
    pub start: &'static str,
    /// The exponent by theory.
    pub theory: f64,
    /// The exponent found over the points with 10³ rods and more: with fewer, the lattice does not resolve the
    /// stretched rods yet.
    pub exponent: f64,
    pub exponent_se: f64,
    /// The points, from few rods to many.
    pub points: Vec<Point>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bench {
    pub free: Free,
    pub exact: f64,
    pub curves: Vec<StartCurve>,
}

#[derive(Clone, Copy, Debug)]
pub struct Amount {
    /// N = 10², 10^2.5, … up to 10^this/2.
    pub half_decades: i32,
    /// The number of trials, a multiple of [`GROUPS`].
    pub trials: usize,
}

impl Amount {
    pub const QUICK: Self = Self { half_decades: 10, trials: 32 };
    pub const FULL: Self = Self { half_decades: 12, trials: 64 };
}

/// Number of groups of trials; the spread of their exponents gives the standard error.
pub const GROUPS: usize = 8;

impl Free {
    fn unequal(&self) -> bool {
        self.sd_percent > 0.0
    }

    /// X̄₁ by the closed form, or by quadrature over it for unequal rods.
    pub fn exact(&self) -> f64 {
        isotropic::mean_projections_polydisperse(self.aspect_ratio, self.sd_percent, self.turns)[0]
    }

    /// X̄₁ of these rods, each moved directly to the time.
    pub fn mean(&self, rods: &[Rod]) -> f64 {
        starts::mean_x1(rods, self.aspect_ratio, self.sd_percent, self.turns)
    }

    /// The number of rods that `start` chooses for `count`, and the errors of X̄₁ in `trials` trials.
    pub fn errors(&self, start: &Start, count: usize, trials: usize, seed: u64) -> (usize, Vec<f64>) {
        let exact = self.exact();
        let tried: Vec<_> = lab::replicas(trials as u64, |trial| {
            let rods = (start.lay)(count, self.unequal(), &mut generator(seed, count, trial));
            (rods.len(), self.mean(&rods) - exact)
        });
        let rods = tried.first().map_or(0, |(rods, _)| *rods);
        (rods, tried.into_iter().map(|(_, error)| error).collect())
    }

    /// The curves of all starts; run times are of one core.
    pub fn bench(&self, amount: Amount, budget: Budget) -> Bench {
        let curves = starts::ALL.iter().map(|start| self.curve(start, amount, budget)).collect();
        Bench { free: *self, exact: self.exact(), curves }
    }

    fn curve(&self, start: &Start, amount: Amount, budget: Budget) -> StartCurve {
        let counts = (4..=amount.half_decades).map(|half| 10f64.powf(0.5 * f64::from(half)).round() as usize);
        let mut points = Vec::new();
        let mut tried = Vec::new();
        for count in counts {
            let (rods, errors) = self.errors(start, count, amount.trials, SEED);
            let once = || self.mean(&(start.lay)(count, self.unequal(), &mut generator(SEED, count, 0)));
            points.push(Point {
                rods,
                error: root_mean_square(&errors),
                trials: errors.len(),
                seconds: measure(budget, once),
            });
            tried.push((rods, errors));
        }
        tried.retain(|(rods, _)| *rods >= 1000);
        let exponents = exponents(&tried, GROUPS);
        let exponent = super::Estimate::mean_of(&exponents);
        StartCurve {
            start: start.name,
            theory: start.exponents[usize::from(self.unequal())],
            exponent: exponent.value,
            exponent_se: exponent.se,
            points,
        }
    }
}

impl StartCurve {
    /// The point with the fewest rods whose error is at most this.
    pub fn cheapest(&self, error: f64) -> Option<&Point> {
        self.points.iter().find(|point| point.error <= error)
    }
}

/// The seed of [`Free::bench`].
const SEED: u64 = 0;

/// A random stream for each seed, number of rods and trial.
fn generator(seed: u64, count: usize, trial: u64) -> Pcg64Dxsm {
    Pcg64Dxsm::seed_from_u64(seed ^ (count as u64) << 32 ^ trial)
}

/// The exponents of N in the root-mean-square error, by least squares of the logarithms, one for each of `groups`
/// groups of trials.
pub fn exponents(tried: &[(usize, Vec<f64>)], groups: usize) -> Vec<f64> {
    let slope = |group: usize| {
        let of_group = |errors: &[f64]| {
            let size = errors.len() / groups;
            root_mean_square(&errors[group * size..][..size]).ln()
        };
        let points: Vec<_> = (tried.iter()).map(|(rods, errors)| ((*rods as f64).ln(), of_group(errors))).collect();
        super::slope(&points)
    };
    (0..groups).map(slope).collect()
}

fn root_mean_square(errors: &[f64]) -> f64 {
    (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
}
