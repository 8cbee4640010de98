//! `run --until-se`: adds replicas until standard errors are small enough.
//!
//! The number of replicas is one of 32, 40, 48, … ([`next`]): the first at which every rule holds. It depends on the
//! scene, the seed and the rules alone, never on threads, load, or the place where an earlier run of the same rules
//! stopped. A checkpoint of other rules may have more replicas: then all of them are used.

use super::Failure;
use super::duration::UNASKED_H;
use super::scene::Named;
use serde::Serialize;
use shearbed::observable::Channel;
use shearbed::run::ensemble::{self, Tally};
use shearbed::scene::MAX_REPLICAS;
use shearbed::{Error, Plan};
use shearbed_validation::oracle::reference::big::finite;
use std::time::{Duration, Instant};

/// The smallest number of replicas: a standard error over 32 is itself known to 13 %.
pub(super) const LEAST: u64 = 32;

/// Options of `run` and `plan`.
#[derive(clap::Args)]
pub(super) struct Until {
    /// Add replicas until the standard error of this column is at most VALUE at every output, as x1=0.001; repeatable.
    /// At least 32 run
    #[arg(long = "until-se", value_name = "CHANNEL=VALUE", value_parser = rule)]
    rules: Vec<(String, f64)>,
}

/// Parses a column and its largest allowed standard error.
fn rule(text: &str) -> Result<(String, f64), String> {
    let parts = text.split_once('=').map(|(name, value)| (name.trim(), finite(value)));
    match parts {
        Some((name, Some(value))) if !name.is_empty() && value > 0.0 => Ok((name.to_owned(), value)),
        _ => Err("a column and a number above 0 are allowed, as x1=0.001".to_owned()),
    }
}

/// Parses a time limit such as `90s`, `10min` or `1.5h`.
pub(super) fn time_limit(text: &str) -> Result<Duration, String> {
    let units = [("min", 60.0), ("s", 1.0), ("h", 3600.0)];
    let value = units.into_iter().find_map(|(unit, seconds)| Some(finite(text.trim().strip_suffix(unit)?)? * seconds));
    match value {
        Some(seconds) if (0.01..=31_536_000.0).contains(&seconds) => Ok(Duration::from_secs_f64(seconds)),
        _ => Err("a time from 0.01s to 8760h is allowed, as 90s, 10min or 1.5h".to_owned()),
    }
}

/// A column with its largest standard error over the outputs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Reached {
    channel: String,
    /// The largest allowed standard error.
    asked: f64,
    /// The largest one at any output.
    reached: f64,
}

/// The outcome of adding replicas, for `run.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Ended {
    pub(super) replicas: u64,
    pub(super) holds: bool,
    /// Each rule's column, with its standard error.
    columns: Vec<Reached>,
    #[serde(skip_serializing_if = "Option::is_none")]
    time_limit_s: Option<f64>,
    /// The hours that more replicas would take, if that was too long to go on unasked.
    #[serde(skip)]
    unasked_h: Option<f64>,
}

/// The number of replicas in a sum, and for each rule the largest standard error.
pub(super) type Look = (u64, Vec<f64>);

/// A function that measures a sum of replicas.
pub(super) type Measure<'a> = dyn Fn(&Tally) -> Look + Sync + 'a;

impl Until {
    pub(super) fn is_empty(&self) -> bool {
        self.rules.is_empty()
    }

    /// Refuses rules beside a number of replicas, for a column that the scene does not have or that is named twice, and
    /// for a scene that requests rods of every replica.
    pub(super) fn check(&self, plan: &Plan, named: &Named) -> Result<(), Failure> {
        let refused = |what: String| Err(Failure::Input(format!("{}: --until-se {what}", named.source)));
        if !self.is_empty() && named.settings.iter().any(|setting| setting.key == "ensemble.replicas") {
            let why = "and a number of replicas (--replicas, or --set ensemble.replicas): --until-se finds the number; \
                       one of the two is allowed";
            return refused(why.to_owned());
        }
        for (k, (name, value)) in self.rules.iter().enumerate() {
            if channel(plan, name).is_none() {
                return refused(format!("{name}={value}: this scene has no such column; {}", allowed(plan)));
            }
            if self.rules[..k].iter().any(|(other, _)| other == name) {
                return refused(format!("{name}={value}: the column is named twice; once is allowed"));
            }
        }
        match plan.scene().output.rods_key() {
            Some(key) if !self.is_empty() => refused(format!(
                "and {key}: how many rods rods.csv would list is not known before the run; give --replicas, or leave \
                 {key} out"
            )),
            _ => Ok(()),
        }
    }

    /// The rules as an input of a run: `until_se x1=0.001`.
    pub(super) fn input(&self) -> String {
        let rules: Vec<_> = self.rules.iter().map(|(name, value)| format!("{name}={value:?}")).collect();
        format!("until_se {}", rules.join(" "))
    }

    fn words(&self) -> String {
        self.rules.iter().map(|(name, value)| format!("{name} ≤ {value}")).collect::<Vec<_>>().join(", ")
    }

    /// A text on the rules before the run, where a pilot takes long.
    pub(super) fn planned(&self) -> String {
        format!(
            "replicas: {LEAST}, as planned here, and then an eighth more (at least 8) at a time until the standard \
             errors hold: {}; how many that takes is not known before\n",
            self.words()
        )
    }

    /// The number of replicas that is expected from the first ones, and a text on it; `None` if one of them fails.
    pub(super) fn piloted(&self, plan: &Plan) -> Option<(u64, String)> {
        let plan = plan.with_replicas(LEAST);
        let mut tally = Tally::new(&plan);
        let run = |replicas| ensemble::replicas_of(&plan, replicas, &|| ());
        ensemble::extend(&plan, &mut tally, 0..LEAST, run).ok()?;
        let expected = self.ended(LEAST, self.reached(&plan, &tally), None).expected();
        let mut replicas = std::iter::successors(Some(LEAST), |replicas| Some(next(*replicas)));
        let replicas = replicas.find(|replicas| *replicas >= expected)?;
        let until = format!("until standard errors hold: {}", self.words());
        Some((replicas, format!("replicas: some {replicas} by a pilot of {LEAST}, {until}\n")))
    }

    /// The outcome with so many replicas and these standard errors, if no more are added.
    fn ended(&self, replicas: u64, reached: Vec<f64>, limit: Option<Duration>) -> Ended {
        let columns: Vec<_> = (self.rules.iter().zip(reached))
            .map(|((name, asked), reached)| Reached { channel: name.clone(), asked: *asked, reached })
            .collect();
        let holds = replicas >= LEAST && columns.iter().all(|column| column.reached <= column.asked);
        Ended { replicas, holds, columns, time_limit_s: limit.map(|limit| limit.as_secs_f64()), unasked_h: None }
    }

    /// The largest standard error so far for each rule.
    fn reached(&self, plan: &Plan, tally: &Tally) -> Vec<f64> {
        let largest = |name: &str| {
            let errors = tally.standard_errors(plan, channel(plan, name)?)?;
            // NaN is kept, so that no rule holds.
            errors.into_iter().reduce(|a, b| if a.is_nan() || a > b { a } else { b })
        };
        self.rules.iter().map(|(name, _)| largest(name).unwrap_or(f64::NAN)).collect()
    }

    /// Adds replicas to the existing ones (`has`) until every rule holds, or no more may be added: after a time limit,
    /// or where the rest would take more than `most_h` hours. `add` runs the replicas up to a number, or fewer after
    /// the deadline, and measures their sum; it must return the same on every rank.
    pub(super) fn grow(
        &self,
        plan: &Plan,
        (has, limit, most_h): (u64, Option<Duration>, f64),
        mut add: impl FnMut(u64, Option<Instant>, &Measure) -> Result<Look, Error>,
        progress: impl Fn(&Ended),
    ) -> Result<Ended, Error> {
        let measure = |tally: &Tally| (tally.replicas(), self.reached(plan, tally));
        let begun = Instant::now();
        let deadline = limit.map(|limit| begun + limit);
        let mut target = LEAST;
        while target < has {
            target = next(target);
        }
        loop {
            let (replicas, reached) = add(target, deadline, &measure)?;
            let ended = self.ended(replicas, reached, limit);
            if ended.holds || replicas < target || target >= MAX_REPLICAS {
                return Ok(ended);
            }
            let each_h = begun.elapsed().as_secs_f64() / 3600.0 / (replicas - has).max(1) as f64;
            let left_h = each_h * (ended.expected() - replicas) as f64;
            if left_h > most_h {
                return Ok(Ended { unasked_h: Some(left_h), ..ended });
            }
            progress(&ended);
            target = next(target);
        }
    }
}

/// The number of replicas after `replicas` at which the rules are checked: an eighth more, and at least 8 more.
fn next(replicas: u64) -> u64 {
    (replicas + (replicas / 8).max(8)).min(MAX_REPLICAS)
}

fn channels(plan: &Plan) -> impl Iterator<Item = Channel> {
    plan.observables().into_iter().flat_map(|observable| observable.channels())
}

fn channel(plan: &Plan, name: &str) -> Option<Channel> {
    channels(plan).find(|channel| channel.name() == name)
}

fn allowed(plan: &Plan) -> String {
    let names: Vec<_> = channels(plan).map(Channel::name).collect();
    match names.as_slice() {
        [first, .., last] if names.len() > 24 => format!("allowed: {first} to {last}, the columns of its tables"),
        _ => format!("allowed: {}; output.observables adds others", names.join(", ")),
    }
}

impl Ended {
    /// The expected final number of replicas, from the standard errors so far.
    pub(super) fn expected(&self) -> u64 {
        let times = |column: &Reached| (column.reached / column.asked).powi(2);
        let most = self.columns.iter().map(times).fold(1.0, f64::max);
        ((self.replicas as f64 * most).ceil() as u64).clamp(self.replicas, MAX_REPLICAS)
    }

    /// A text on each rule, with the standard error reached and the allowed one.
    pub(super) fn text(&self) -> String {
        let of = |Reached { channel, asked, reached }: &Reached| {
            format!("largest standard error of {channel}: {:?}, asked for: {asked:?}", two_digits(*reached))
        };
        self.columns.iter().map(of).collect::<Vec<_>>().join("; ")
    }

    /// A failure if a rule does not hold; the results have been written before.
    pub(super) fn failure(&self) -> Result<(), Failure> {
        if self.holds {
            return Ok(());
        }
        let why = match (self.time_limit_s, self.unasked_h) {
            (_, Some(hours)) => {
                format!(
                    "the rest takes some {hours:.0} h; more than {UNASKED_H} h go on with --yes or --time-limit alone"
                )
            }
            (Some(seconds), _) if self.replicas < MAX_REPLICAS => {
                format!("the time limit of {seconds} s came first")
            }
            _ => format!("{MAX_REPLICAS} replicas are the most"),
        };
        let needed = match self.expected() {
            MAX_REPLICAS => format!("more than {MAX_REPLICAS}"),
            expected => format!("some {expected}"),
        };
        Err(Failure::Failed(format!(
            "--until-se was not reached: {why}; {} after {} replicas, and {needed} are needed; the results of these \
             replicas are written",
            self.text(),
            self.replicas
        )))
    }
}

fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// The ratio of the true standard error σ/√N to the allowed one, which `enough` replicas have, if N is found from
    /// the noisy one, for a single column at a single output, the hardest case: its mean and its 95 % quantile.
    fn excess(least: u64, enough: f64) -> (f64, f64) {
        let mut random = rand_pcg::Pcg64Dxsm::seed_from_u64(82);
        let mut ratios: Vec<f64> = (0..4000)
            .map(|_| {
                let (mut n, mut mean, mut squares, mut target) = (0_u64, 0.0, 0.0, least);
                loop {
                    while n < target {
                        n += 1;
                        let value: f64 = StandardNormal.sample(&mut random);
                        let change = value - mean;
                        mean += change / n as f64;
                        squares += change * (value - mean);
                    }
                    let replicas = n as f64;
                    if squares / (replicas - 1.0) / replicas <= 1.0 / enough {
                        break (enough / replicas).sqrt();
                    }
                    target = next(target);
                }
            })
            .collect();
        ratios.sort_by(f64::total_cmp);
        (ratios.iter().sum::<f64>() / 4000.0, ratios[3800])
    }

    /// More replicas begin only where the rest takes no longer than allowed.
    #[test]
    fn work_that_takes_too_long_ends_with_what_there_is() {
        let plan = Plan::new(&shearbed::Scene::default()).unwrap();
        let until = Until { rules: vec![("x1".into(), 0.001)] };
        let grow = |most_h: f64| {
            let add = |target: u64, _: Option<Instant>, _: &Measure| Ok((target, vec![0.1 / target as f64]));
            until.grow(&plan, (0, None, most_h), add, |_| ()).unwrap()
        };
        let (whole, stopped) = (grow(f64::INFINITY), grow(0.0));
        assert!(whole.holds && whole.failure().is_ok(), "{whole:?}");
        assert_eq!((whole.replicas, stopped.replicas), (102, LEAST));
        let why = stopped.failure().unwrap_err().message_and_code().0;
        assert!(why.contains("go on with --yes or --time-limit alone"), "{why}");
    }

    #[test]
    fn a_noisy_standard_error_ends_the_run_little_too_early() {
        // Two standard deviations of a standard error over 32 replicas, 2/√62, are 25 %.
        for enough in [100.0, 200.0, 1000.0] {
            let (mean, worst) = excess(LEAST, enough);
            assert!(mean < 1.0 && worst < 1.25, "{enough}: {mean} {worst}");
        }
        // A control: from two replicas on, luck ends many runs far too early.
        let (_, worst) = excess(2, 200.0);
        assert!(worst > 1.6, "{worst}");
    }
}
