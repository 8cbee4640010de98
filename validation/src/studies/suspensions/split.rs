//! The cost of a given error of X̄₁ at a run's end: the cheapest steps per period, rods and replicas, from measured
//! constants alone.
//!
//! Mean-square error = (b/S + c N^(−1/3))² + v/(N M) for S steps per period, N rods and M replicas; cost = N M S rods
//! times steps.

use super::job::{Job, x1};
use super::law::{FACES, JobMean, Law};
use super::*;

/// The errors of X̄₁ for which splits are sought.
pub const TARGETS: [f64; 3] = [1e-2, 3e-3, 1e-3];

/// The smallest number of replicas: fewer do not show their scatter.
const FEWEST_REPLICAS: u64 = 8;

/// The constants of a scene's error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Constants {
    /// b: the bias of the steps is at most b/S. The largest value that the measurement allows: |slope| + 2 standard
    /// errors.
    pub steps_bias: f64,
    /// True if the slope differs from 0 by two standard errors: else b is what its noise leaves room for.
    pub steps_bias_seen: bool,
    /// The smallest number of steps per period for which that holds.
    pub fewest_steps: u64,
    /// c: the bias of the rods is at most c N^(−1/3), estimated in the same way.
    pub rods_bias: f64,
    /// v: the variance of X̄₁ over replicas, times N.
    pub variance_per_rod: f64,
}

/// The exact value against which the error is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Scope {
    /// The scene with its own number of rods, as Δt → 0: that number is part of the model.
    OwnRods(usize),
    /// A suspension without faces: also N → ∞.
    Unbounded,
}

/// A choice of steps, rods and replicas, with its predicted error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Split {
    pub(crate) target: f64,
    pub(crate) scope: Scope,
    pub(crate) steps_per_period: u64,
    pub(crate) rods: usize,
    pub(crate) replicas: u64,
    /// The largest bias.
    pub bias: f64,
    /// The scatter, one standard deviation.
    pub scatter: f64,
}

/// The results of a split that was run several times with new seeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Realised {
    pub(crate) split: Split,
    pub(crate) repeats: u64,
    /// The runs' mean less the reference; the standard error includes the reference's.
    pub bias: Estimate,
    /// The standard deviation of one run.
    pub scatter: Estimate,
    /// The root mean square difference of a run from the reference, without the reference's own error.
    pub error: f64,
}

impl Constants {
    /// The constants from a study of the scene. `None` if the study has no lines.
    pub fn of(law: &Law) -> Option<Self> {
        let steps = law.steps_line?;
        let rods = law.rods_lines[0]?;
        Some(Self {
            steps_bias: steps.slope.abs() + 2.0 * steps.slope_se,
            steps_bias_seen: steps.slope.abs() > 2.0 * steps.slope_se,
            fewest_steps: law.steps.get(law.line_from)?.steps_per_period,
            rods_bias: rods.slope.abs() + 2.0 * rods.slope_se,
            variance_per_rod: law.variance_per_rod,
        })
    }

    /// The largest bias at these steps per period and rods.
    pub fn bias(&self, scope: Scope, steps: f64, rods: f64) -> f64 {
        self.steps_bias / steps
            + match scope {
                Scope::OwnRods(_) => 0.0,
                Scope::Unbounded => self.rods_bias * rods.powf(FACES),
            }
    }

    /// The split with the least cost for an error > 0.
    ///
    /// With the scene's own rods: S = √3 b/ε, where the bias is 1/√3 of the error and the scatter √(2/3) (Duffie &
    /// Glynn 1995), but not below the fewest steps; then N M = v/(ε² − (b/S)²). Without faces: as few replicas as
    /// allowed, because scatter depends only on N M and the bias falls with N; then S by trial.
    pub fn cheapest(&self, scope: Scope, target: f64) -> Split {
        let fewest = self.fewest_steps as f64;
        let best = 3f64.sqrt() * self.steps_bias / target;
        let tried: Vec<f64> = match scope {
            Scope::OwnRods(_) => vec![best.max(fewest)],
            Scope::Unbounded => (0..400).map(|k| best.max(fewest) * 1.01f64.powi(k - 50)).collect(),
        };
        let splits = tried.into_iter().map(|steps| steps.max(fewest).ceil());
        let splits = splits.filter_map(|steps| self.filled(scope, target, steps));
        let cheapest = splits.min_by_key(Split::rod_steps);
        cheapest.expect("√3 b/ε steps leave room for the scatter")
    }

    /// The fewest rods and replicas at these steps; `None` if the steps' bias alone is too large.
    fn filled(&self, scope: Scope, target: f64, steps: f64) -> Option<Split> {
        let split = |rods: f64, replicas: f64| Split {
            target,
            scope,
            steps_per_period: steps as u64,
            rods: rods as usize,
            replicas: replicas as u64,
            bias: self.bias(scope, steps, rods),
            scatter: (self.variance_per_rod / (rods * replicas)).sqrt(),
        };
        let room = target.powi(2) - (self.steps_bias / steps).powi(2);
        if room <= 0.0 {
            return None;
        }
        let fewest = FEWEST_REPLICAS as f64;
        Some(match scope {
            Scope::OwnRods(rods) => {
                let rods = rods as f64;
                split(rods, (self.variance_per_rod / (room * rods)).ceil().max(fewest))
            }
            Scope::Unbounded => {
                // The error falls with N: bisects the interval of ln N.
                let [_, enough] = bisect(0.0, 100.0, 60, |ln_n| split(ln_n.exp(), fewest).error() > target);
                split(enough.exp().ceil(), fewest)
            }
        })
    }
}

impl Split {
    /// The predicted upper bound of the root-mean-square error.
    pub fn error(&self) -> f64 {
        self.bias.hypot(self.scatter)
    }

    /// The cost: rods times steps over a period.
    pub fn rod_steps(&self) -> u64 {
        (self.rods as u64).saturating_mul(self.replicas).saturating_mul(self.steps_per_period)
    }

    /// The split of a scene as a job.
    pub fn job(&self, scene: &Scene) -> Job {
        Job::new(scene, self.steps_per_period, self.rods, self.replicas, 1)
    }

    /// Runs the split `repeats` times with new seeds, and compares the results with a reference.
    pub fn realise(&self, scene: &Scene, repeats: u64, reference: Estimate) -> Result<Realised, String> {
        let run = |repeat: u64| {
            let mut job = self.job(scene);
            job.scene.ensemble.seed = scene.ensemble.seed + 1 + repeat;
            let x1 = x1(&job.run(&|| ())?);
            Ok::<_, String>(x1.iter().sum::<f64>() / x1.len() as f64)
        };
        let values = (0..repeats).map(run).collect::<Result<Vec<_>, _>>()?;
        let Estimate { value: mean, se } = Estimate::mean_of(&values);
        let off = mean - reference.value;
        let deviation = se * (repeats as f64).sqrt();
        let mean_square = values.iter().map(|x| (x - reference.value).powi(2)).sum::<f64>() / repeats as f64;
        Ok(Realised {
            split: *self,
            repeats,
            bias: Estimate { value: off, se: se.hypot(reference.se) },
            scatter: Estimate { value: deviation, se: deviation / (2.0 * (repeats as f64 - 1.0)).sqrt() },
            error: (mean_square - reference.se.powi(2)).max(0.0).sqrt(),
        })
    }
}

/// X̄₁ of a scene at steps and rods much finer than a split's, with other seeds; with 100 replicas or more, the free
/// rods serve as control variate.
pub fn reference(scene: &Scene, steps: u64, rods: usize, replicas: u64) -> Result<JobMean, String> {
    let mut job = Job::new(scene, steps, rods, replicas, 1);
    job.scene.ensemble.seed = scene.ensemble.seed + 1_000_000;
    let x1 = x1(&job.run(&|| ())?);
    let mean = if replicas < 100 {
        Estimate::mean_of(&x1)
    } else {
        let free = coupled::at(&coupled::free(&job.scene, 4, replicas)?, 3);
        coupled::controlled(&x1, &free, coupled::free_mean(scene, 1.0))
    };
    Ok(JobMean { steps_per_period: steps, rods, replicas, x1: mean.value, se: mean.se })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SYNTHETIC: Constants =
        Constants { steps_bias: 0.6, steps_bias_seen: true, fewest_steps: 100, rods_bias: 0.04, variance_per_rod: 0.1 };

    /// The cheapest cost of all splits on a fine grid.
    fn by_trial(scope: Scope, target: f64) -> f64 {
        let mut least = f64::INFINITY;
        for s in 0..600 {
            let steps = 100.0 * 1.01f64.powi(s);
            let room = |rods: f64| target.powi(2) - SYNTHETIC.bias(scope, steps, rods).powi(2);
            for n in 0..3000 {
                let total = 8.0 * 1.01f64.powi(n);
                // With the largest N: as few replicas as allowed.
                if room(total / 8.0) > 0.0 && SYNTHETIC.variance_per_rod / total <= room(total / 8.0) {
                    least = least.min(steps * total);
                    break;
                }
            }
        }
        least
    }

    #[test]
    fn no_split_on_a_grid_is_cheaper() {
        for target in [3e-3, 1e-3] {
            for scope in [Scope::OwnRods(100), Scope::Unbounded] {
                let split = SYNTHETIC.cheapest(scope, target);
                assert!(split.error() <= target * (1.0 + 1e-12), "{split:?}");
                let ratio = split.rod_steps() as f64 / by_trial(scope, target);
                // Errors by whole rods, replicas and steps, and the grid's 1 %.
                assert!((0.97..1.02).contains(&ratio), "{scope:?} {target} {ratio}");
            }
        }
    }

    /// A bias within its noise is not given as if it were measured.
    #[test]
    fn a_bias_that_was_not_seen_is_said_to_be_none() {
        let of = |steps_bias_seen| {
            let table = interacting::splits_table(&Constants { steps_bias_seen, ..SYNTHETIC }, &[], 1.0);
            (table.caption.contains("Bias of the steps: none seen"), table.columns[2].ends_with('≤'))
        };
        assert_eq!([of(true), of(false)], [(false, false), (true, true)]);
    }

    #[test]
    fn a_third_of_the_mean_square_is_bias_unless_the_steps_are_few() {
        let split = SYNTHETIC.cheapest(Scope::OwnRods(100), 1e-3);
        assert!((split.bias / 1e-3 - 1.0 / 3f64.sqrt()).abs() < 1e-3, "{split:?}");
        let coarse = SYNTHETIC.cheapest(Scope::OwnRods(100), 0.1);
        assert_eq!((coarse.steps_per_period, coarse.replicas), (100, 8));
    }
}
