//! Replicas over all cores, and the means and standard errors over them.

use crate::observable::{Observable, Sum};
use crate::plan::{Plan, Unit};
use crate::run::{self, Replica, run_replica};
use crate::snapshot::Snapshot;
use crate::work::{Counters, RunError};
use rayon::prelude::*;
use std::ops::Range;

/// A channel of an observable against time: a column of its table.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// The mean over rods and replicas, per output.
    pub mean: Vec<f64>,
    /// The standard error of the mean: over replicas, or over rods where there is one replica. NaN where
    /// there is one replica of one rod.
    pub se: Vec<f64>,
}

/// An observable against time.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Which observable.
    pub observable: Observable,
    /// Its columns, in the order of [`Observable::channels`].
    pub columns: Vec<Column>,
}

/// The results of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// `t_over_T` or `strain`.
    pub time_name: &'static str,
    /// The outputs' times.
    pub times: Vec<f64>,
    /// What their unit is.
    pub unit: Unit,
    /// One per observable, in the order of the plan.
    pub series: Vec<Series>,
    /// Every rod at each output that the scene asks for them: replica by replica, and in each in the order of time.
    pub snapshots: Vec<Snapshot>,
    /// Work over all replicas.
    pub counters: Counters,
}

impl Results {
    /// The column with this name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        let mut all = self.series.iter().flat_map(|series| &series.columns);
        all.find(|column| column.name == name)
    }
}

/// Runs every replica of the plan on the threads of the current rayon pool; `finished` is called after each
/// replica. The results are the same bits for any number of threads.
///
/// # Errors
///
/// The first replica that stopped, or had a result that is none.
pub fn run(plan: &Plan, finished: impl Fn() + Sync) -> Result<Results, RunError> {
    fold(plan, |replicas| replicas_of(plan, replicas, &finished))
}

/// Runs some replicas of the plan on the threads of the current rayon pool, and returns them in order; `finished`
/// is called after each.
///
/// # Errors
///
/// As [`run()`].
pub fn replicas_of(
    plan: &Plan,
    replicas: Range<u64>,
    finished: &(impl Fn() + Sync),
) -> Result<Vec<Replica>, RunError> {
    let one = |replica| {
        let result = run_replica(plan, replica);
        finished();
        result
    };
    replicas.into_par_iter().map(one).collect()
}

/// The results of a plan whose replicas `run` runs, a range of them at a time and wherever it likes, as long as it
/// returns them in order. The results' bits do not depend on where.
///
/// # Errors
///
/// The first of `run`.
pub fn fold<E>(
    plan: &Plan,
    mut run: impl FnMut(Range<u64>) -> Result<Vec<Replica>, E>,
) -> Result<Results, E> {
    let replicas = plan.scene().ensemble.replicas;
    let mut moments = Moments::new(plan.outputs() * width(plan));
    let mut counters = Counters::default();
    let mut snapshots = Vec::new();
    let mut first = 0;
    while first < replicas {
        let last = replicas.min(first + batch(plan));
        for replica in run(first..last)? {
            counters.add(&replica.counters);
            moments.add(&replica.sums, plan.scene().particles.count);
            snapshots.extend(replica.snapshots);
        }
        first = last;
    }
    Ok(Results {
        snapshots,
        ..collect(plan, &moments, counters)
    })
}

/// Sums per output.
pub(crate) fn width(plan: &Plan) -> usize {
    run::width(&plan.observables())
}

/// Replicas held in memory at a time: about 256 MB of sums.
pub(crate) fn batch(plan: &Plan) -> u64 {
    let bytes = plan.outputs() * width(plan) * size_of::<Sum>();
    ((256 << 20) / bytes.max(1)).clamp(1, 4096) as u64
}

/// Running means and squared deviations over replicas (Welford 1962).
struct Moments {
    replicas: f64,
    mean: Vec<f64>,
    deviation: Vec<f64>,
    /// Standard errors over the rods of one replica.
    over_rods: Vec<f64>,
}

impl Moments {
    fn new(len: usize) -> Self {
        Self {
            replicas: 0.0,
            mean: vec![0.0; len],
            deviation: vec![0.0; len],
            over_rods: vec![f64::NAN; len],
        }
    }

    fn add(&mut self, sums: &[Sum], count: usize) {
        let n = count as f64;
        self.replicas += 1.0;
        for (k, sum) in sums.iter().enumerate() {
            let value = sum.value / n;
            let change = value - self.mean[k];
            self.mean[k] += change / self.replicas;
            self.deviation[k] += change * (value - self.mean[k]);
            if let Some(square) = sum.square {
                let variance = (square / n - value * value).max(0.0);
                self.over_rods[k] = (variance / (n - 1.0)).sqrt();
            }
        }
    }

    fn se(&self, k: usize) -> f64 {
        if self.replicas > 1.0 {
            (self.deviation[k] / (self.replicas - 1.0) / self.replicas).sqrt()
        } else {
            self.over_rods[k]
        }
    }
}

fn collect(plan: &Plan, moments: &Moments, counters: Counters) -> Results {
    let width = width(plan);
    let mut start = 0;
    let series = (plan.observables().into_iter())
        .map(|observable| {
            let columns = observable.channels().enumerate().map(|(place, channel)| {
                let at = |output: usize| output * width + start + place;
                Column {
                    name: channel.name(),
                    mean: (0..plan.outputs()).map(|k| moments.mean[at(k)]).collect(),
                    se: (0..plan.outputs()).map(|k| moments.se(at(k))).collect(),
                }
            });
            let columns = columns.collect();
            start += observable.width();
            Series { observable, columns }
        })
        .collect();
    Results {
        time_name: plan.time_name(),
        times: plan.times(),
        unit: plan.unit(),
        series,
        snapshots: Vec::new(),
        counters,
    }
}
