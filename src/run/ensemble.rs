//! Runs replicas on all cores; means and standard errors over them.

#[cfg(test)]
mod tests;

use crate::model::work::Counters;
use crate::observable::{self, Channel, Observable, Observe, Sum};
use crate::plan::{Elapsed, Plan, Stage};
use crate::run::{Replica, run_replica};
use crate::scene::Error;
use crate::suspension::snapshot::Snapshot;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// One channel of an observable against time: a column of its table.
///
/// ```
/// let plan = shearbed::Plan::new(&shearbed::Scene::default())?;
/// let results = shearbed::run::ensemble::run(&plan)?;
/// let x1 = results.column("x1").expect("projections are the default");
/// assert!((x1.mean[0] - 0.5).abs() < 4.0 * x1.se[0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name of the channel.
    pub name: String,
    /// The mean over rods and replicas, per output.
    pub mean: Vec<f64>,
    /// The standard error of the mean: over replicas, or over the rods of a single replica. NaN for a single rod of a
    /// single replica.
    pub se: Vec<f64>,
    /// The means over all replicas but those of one group, for each of [`group_sizes`]: whatever is derived from a mean
    /// has its standard error from them, by the jackknife. Empty for a single replica, and where they would take more
    /// than 64 MB.
    pub without: Vec<Vec<f64>>,
}

/// The number of groups of replicas.
const GROUPS: usize = 16;

/// The largest number of sums, outputs times channels, for which those of groups are kept.
pub const MOST_GROUPED: usize = 1 << 19;

/// The number of replicas in each group: replica k belongs to group k modulo 16.
pub fn group_sizes(replicas: u64) -> impl Iterator<Item = u64> {
    let groups = GROUPS as u64;
    (0..groups.min(replicas)).map(move |group| (replicas - group).div_ceil(groups))
}

/// The number of sums over groups for `len` sums.
pub(crate) fn grouped(len: usize) -> usize {
    if len <= MOST_GROUPED { len * GROUPS } else { 0 }
}

/// One observable against time.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The observable.
    pub observable: Observable,
    /// Its channels, in the order of [`Observable::channels`].
    pub columns: Vec<Column>,
}

/// The results of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// Name of the time column: `t_over_T`, `strain` or `time_s`.
    pub time_name: &'static str,
    /// Times of the outputs, in periods or units of strain.
    pub times: Vec<f64>,
    /// The same times in s and in strain.
    pub elapsed: Vec<Elapsed>,
    /// One per observable, in the order of the plan.
    pub series: Vec<Series>,
    /// All rods at the outputs for which the scene asks for them, ordered by replica, then by time.
    pub snapshots: Vec<Snapshot>,
    /// Work over all replicas.
    pub counters: Counters,
    /// The mean number of collisions of a replica, and its standard error: NaN for a single replica.
    pub collisions: [f64; 2],
}

impl Results {
    /// The column called `name`, or `None`.
    pub fn column(&self, name: &str) -> Option<&Column> {
        let mut all = self.series.iter().flat_map(|series| &series.columns);
        all.find(|column| column.name == name)
    }
}

/// Runs every replica of the plan on the threads of the current rayon pool. The results are the same bits for any
/// number of threads. To show progress, or to run replicas elsewhere, use [`fold`] and [`replicas_of`].
///
/// # Errors
///
/// The error of the first replica that fails.
pub fn run(plan: &Plan) -> Result<Results, Error> {
    fold(plan, |replicas| replicas_of(plan, replicas, &|| ()))
}

/// Runs `replicas` of the plan on the threads of the current rayon pool and returns them in order; calls `finished`
/// after each.
///
/// # Errors
///
/// As [`run()`].
pub fn replicas_of(plan: &Plan, replicas: Range<u64>, finished: &(impl Fn() + Sync)) -> Result<Vec<Replica>, Error> {
    let one = |replica| {
        let result = run_replica(plan, replica);
        finished();
        result
    };
    replicas.into_par_iter().map(one).collect()
}

/// The results of a plan. `run` runs a range of replicas, on any machine, and returns them in order; the results' bits
/// do not depend on where.
///
/// # Errors
///
/// The first error of `run`.
pub fn fold<E>(plan: &Plan, mut run: impl FnMut(Range<u64>) -> Result<Vec<Replica>, E>) -> Result<Results, E> {
    let mut tally = Tally::new(plan);
    extend(plan, &mut tally, 0..plan.scene().ensemble.replicas, &mut run)?;
    Ok(tally.results(plan))
}

/// Adds the next replicas of a plan to `tally`, as [`fold`] does from the first on. The bits are the same as if all
/// replicas had been added at once.
///
/// ```
/// use shearbed::run::ensemble::{Tally, extend, replicas_of, run};
/// let plan = shearbed::Plan::new(&shearbed::Scene::default())?.with_replicas(5);
/// let mut tally = Tally::new(&plan);
/// extend(&plan, &mut tally, 0..2, |replicas| replicas_of(&plan, replicas, &|| ()))?;
/// extend(&plan, &mut tally, 2..5, |replicas| replicas_of(&plan, replicas, &|| ()))?;
/// assert_eq!(tally.results(&plan), run(&plan)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// The first error of `run`.
pub fn extend<E>(
    plan: &Plan,
    tally: &mut Tally,
    replicas: Range<u64>,
    mut run: impl FnMut(Range<u64>) -> Result<Vec<Replica>, E>,
) -> Result<(), E> {
    in_batches(batch(plan, width(plan)), replicas, |replicas| {
        // `run` may return no replicas, if another process collects them.
        run(replicas).map(|replicas| replicas.into_iter().for_each(|replica| tally.add(replica)))
    })
}

/// Calls `each` for all `replicas`, at most `most` at a time.
pub(crate) fn in_batches<E>(
    most: u64,
    replicas: Range<u64>,
    mut each: impl FnMut(Range<u64>) -> Result<(), E>,
) -> Result<(), E> {
    let mut first = replicas.start;
    while first < replicas.end {
        let last = replicas.end.min(first + most);
        each(first..last)?;
        first = last;
    }
    Ok(())
}

/// Number of sums per output.
pub(crate) fn width(plan: &Plan) -> usize {
    observable::width(&plan.observables())
}

/// Number of replicas held in memory at a time: about 256 MB of sums, `width` per output.
pub(crate) fn batch(plan: &Plan, width: usize) -> u64 {
    let bytes = plan.outputs() * width * size_of::<Sum>();
    ((256 << 20) / bytes.max(1)).clamp(1, 4096) as u64
}

/// Running means and squared deviations over replicas, added one after the other (Welford 1962).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Tally {
    replicas: u64,
    counters: Counters,
    /// The running mean and squared deviation of the collisions of a replica.
    collisions: [f64; 2],
    mean: Vec<f64>,
    deviation: Vec<f64>,
    /// Standard errors over the rods of a single replica.
    over_rods: Vec<f64>,
    /// Sums over the replicas of each group, group by group.
    groups: Vec<f64>,
    /// All rods at the outputs for which the scene asks for them.
    snapshots: Vec<Snapshot>,
}

impl Tally {
    /// An empty tally for `plan`.
    pub fn new(plan: &Plan) -> Self {
        Self::of(plan.outputs() * width(plan))
    }

    /// An empty tally of `len` sums.
    pub(crate) fn of(len: usize) -> Self {
        Self {
            replicas: 0,
            counters: Counters::default(),
            collisions: [0.0; 2],
            mean: vec![0.0; len],
            deviation: vec![0.0; len],
            over_rods: vec![f64::NAN; len],
            groups: vec![0.0; grouped(len)],
            snapshots: Vec::new(),
        }
    }

    /// The number of replicas added: the first ones of the plan.
    pub fn replicas(&self) -> u64 {
        self.replicas
    }

    /// Checks that the tally fits the plan.
    ///
    /// # Errors
    ///
    /// A sentence that says what does not fit.
    pub fn check(&self, plan: &Plan) -> Result<(), &'static str> {
        let len = plan.outputs() * width(plan);
        if [&self.mean, &self.deviation, &self.over_rods].map(Vec::len) != [len; 3]
            || self.groups.len() != grouped(len)
            || self.replicas > plan.scene().ensemble.replicas
        {
            return Err("its means are not those of this scene");
        }
        let rods_at = plan.rods_outputs().len() as u64;
        if !Snapshot::all_fit(&self.snapshots, self.replicas * rods_at, plan) {
            return Err("its rods are not those of this scene");
        }
        let deviations = self.deviation.iter().all(|x| x.is_finite() && *x >= 0.0);
        if !deviations || !self.mean.iter().chain(&self.groups).all(|x| x.is_finite()) {
            return Err("it has a mean that is not finite, or a negative deviation");
        }
        Ok(())
    }

    /// Adds the next replica.
    pub fn add(&mut self, replica: Replica) {
        self.counters.add(&replica.counters);
        self.add_sums(replica.rods, &replica.sums);
        let [mean, deviation] = &mut self.collisions;
        add(mean, deviation, replica.counters.collisions as f64, self.replicas as f64);
        self.snapshots.extend(replica.snapshots);
    }

    /// Adds the sums of the next replica, which has `rods` rods.
    pub(crate) fn add_sums(&mut self, rods: usize, sums: &[Sum]) {
        let n = rods as f64;
        let group = self.replicas as usize % GROUPS * sums.len();
        self.replicas += 1;
        let replicas = self.replicas as f64;
        for (k, sum) in sums.iter().enumerate() {
            let value = sum.value / n;
            add(&mut self.mean[k], &mut self.deviation[k], value, replicas);
            if let Some(of_group) = self.groups.get_mut(group + k) {
                *of_group += value;
            }
            if let Some(spread) = &sum.spread {
                self.over_rods[k] = spread.standard_error();
            }
        }
    }

    /// The standard errors of a channel's mean at each output; `None` if the plan does not observe the channel.
    pub fn standard_errors(&self, plan: &Plan, channel: Channel) -> Option<Vec<f64>> {
        let place = channel.place(&plan.observables())?;
        Some(self.errors_of(plan, &*channel.observable, place, width(plan)))
    }

    /// The standard errors of an observable's channel, in its unit. Of rods that count by their cubed lengths a mean is
    /// a quotient of two sums, whose error one replica cannot give.
    fn errors_of(&self, plan: &Plan, of: &dyn Observe, place: usize, width: usize) -> Vec<f64> {
        let unknown = self.replicas == 1 && plan.runs(Stage::Lengths) && of.weighs_rods();
        let unit = if unknown { f64::NAN } else { plan.scene().unit(of).abs() };
        (place..self.mean.len()).step_by(width).map(|k| self.se(k) * unit).collect()
    }

    /// [`Self::column`] of an observable, in its unit.
    pub(crate) fn column_of(&self, plan: &Plan, of: &dyn Observe, name: String, place: usize, width: usize) -> Column {
        let mut column = self.column(name, place, width);
        // Only here, as squares of very small and large numbers are 0 and infinite.
        let unit = plan.scene().unit(of);
        column.mean.iter_mut().chain(column.without.iter_mut().flatten()).for_each(|mean| *mean *= unit);
        column.se = self.errors_of(plan, of, place, width);
        column
    }

    fn se(&self, k: usize) -> f64 {
        if self.replicas > 1 { se_of(self.deviation[k], self.replicas) } else { self.over_rods[k] }
    }

    /// The column at index `place` of the `width` sums of each output.
    pub(crate) fn column(&self, name: String, place: usize, width: usize) -> Column {
        let all = || (place..self.mean.len()).step_by(width);
        Column {
            name,
            mean: all().map(|k| self.mean[k]).collect(),
            se: all().map(|k| self.se(k)).collect(),
            without: if self.replicas > 1 && !self.groups.is_empty() { self.without(all) } else { Vec::new() },
        }
    }

    /// The means at the indices `all` without each of the groups.
    fn without<I: Iterator<Item = usize>>(&self, all: impl Fn() -> I) -> Vec<Vec<f64>> {
        let of_group = |(group, size): (usize, u64)| {
            let others = (self.replicas - size) as f64;
            let own = &self.groups[group * self.mean.len()..];
            all().map(|k| (self.mean[k] * self.replicas as f64 - own[k]) / others).collect()
        };
        group_sizes(self.replicas).enumerate().map(of_group).collect()
    }

    /// The results of the replicas added.
    pub fn results(self, plan: &Plan) -> Results {
        let width = width(plan);
        let [collisions, deviation] = self.collisions;
        let mut start = 0;
        let series = (plan.observables().into_iter())
            .map(|observable| {
                let channels = observable.channels().enumerate();
                let columns = channels
                    .map(|(place, channel)| self.column_of(plan, &*observable, channel.name(), start + place, width));
                let columns = columns.collect();
                start += observable.width();
                Series { observable, columns }
            })
            .collect();
        Results {
            time_name: plan.time_name(),
            times: plan.times(),
            elapsed: plan.times().into_iter().map(|time| plan.elapsed(time)).collect(),
            series,
            snapshots: self.snapshots,
            counters: self.counters,
            collisions: [collisions, se_of(deviation, self.replicas)],
        }
    }
}

/// Adds the value of the last of `replicas` to a running mean and its squared deviations (Welford 1962).
#[inline]
fn add(mean: &mut f64, deviation: &mut f64, value: f64, replicas: f64) {
    let change = value - *mean;
    *mean += change / replicas;
    *deviation += change * (value - *mean);
}

/// The standard error of a mean over `replicas` with these squared deviations; NaN, 0/0, for a single one.
fn se_of(deviation: f64, replicas: u64) -> f64 {
    let replicas = replicas as f64;
    (deviation / (replicas - 1.0) / replicas).sqrt()
}
