//! How fast the core is, against the naive reference and against what the machine can do: all measured side by side in
//! one run, as plain data. Pictures and tables are in [`figures`] and [`tables`].

pub mod figures;
mod measure;
pub mod tables;

use crate::files::build;
use crate::present::study::{Exhibit, Extent, Found, Study};
pub use measure::measure;
use serde::Serialize;

/// The core's speed beside targets.
pub const STUDY: Study = Study {
    name: "speed",
    title: "Speed of the core",
    question: "How fast is the core against the naive reference and against what the machine can do?",
    cases: &["naive-reference"],
    command: "cargo run --release -- bench --case speed",
    benches: || vec!["speed".into()],
    shared: false,
    run,
};

fn run(extent: &Extent) -> Result<Option<Found>, String> {
    if !(extent.wanted)("speed") {
        return Ok(None);
    }
    let speed = measure(extent.effort.pick(Amount::QUICK, Amount::FULL))?;
    let mut exhibits: Vec<Exhibit> = figures::figures(&speed).into_iter().map(Exhibit::from).collect();
    exhibits[0].table = Some(tables::table(&speed));
    Ok(Some(Found {
        answer: answer(&speed.checks),
        exhibits,
        files: vec![("speed.json".into(), build::json(&speed)?)],
        ..Default::default()
    }))
}

/// The study's answer: how many of the checks that have a target meet it.
fn answer(checks: &[Check]) -> String {
    let judged = checks.iter().filter(|check| check.target != Target::None);
    let (met, all) = judged.fold((0, 0), |(met, all), check| (met + usize::from(check.met()), all + 1));
    format!("{met} of {all} targets are met on this machine; times depend on what else runs on it.")
}

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amount {
    /// Measurements, of which the least counts.
    repeats: usize,
    /// Rods for the memory rate.
    free_rods: usize,
    /// Seconds that the steps of one measurement take, about.
    seconds: f64,
}

impl Amount {
    /// For `shearbed bench`.
    pub const FULL: Self = Self { repeats: 7, free_rods: 10_000_000, seconds: 0.2 };
    /// For the report of every day.
    pub const QUICK: Self = Self { repeats: 3, free_rods: 2_000_000, seconds: 0.02 };
}

/// What was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Speed {
    /// Threads of the runs that share their work.
    pub threads: usize,
    /// A target each.
    pub checks: Vec<Check>,
    /// A step of the paper's suspension against the number of rods, on one core.
    pub by_rods: Vec<Step>,
    /// A step against the concentration, from dilute to dense, on one core.
    pub by_concentration: Vec<Step>,
}

/// A target and what was measured.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// What it is about.
    pub what: &'static str,
    /// The measured number.
    pub measured: f64,
    /// What it ought to be at most or at least.
    pub target: Target,
    /// Its unit.
    pub unit: &'static str,
    /// The numbers behind it.
    pub behind: String,
}

/// What a number ought to be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Target {
    /// No larger than this.
    AtMost(f64),
    /// No smaller than this.
    AtLeast(f64),
    /// There is none.
    None,
}

impl Check {
    /// What was measured over what it ought to be.
    pub fn over_target(&self) -> Option<f64> {
        match self.target {
            Target::AtMost(target) | Target::AtLeast(target) => Some(self.measured / target),
            Target::None => None,
        }
    }

    /// Whether the target is met.
    pub fn met(&self) -> bool {
        match self.target {
            Target::AtMost(most) => self.measured <= most,
            Target::AtLeast(least) => self.measured >= least,
            Target::None => true,
        }
    }
}

/// The time of a step of interacting rods.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Step {
    /// Rods in the control volume.
    pub rods: usize,
    /// n.
    pub concentration_per_cm3: f64,
    /// The core's time per rod and step in ns.
    pub core_ns: f64,
    /// That of the naive reference, where it was measured.
    pub naive_ns: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(measured: f64, target: Target) -> Check {
        Check { what: "", measured, target, unit: "", behind: String::new() }
    }

    #[test]
    fn the_answer_counts_the_checks_that_have_a_target() {
        let checks = [
            check(3.0, Target::AtMost(3.0)),
            check(1.0, Target::None),
            check(3.1, Target::AtMost(3.0)),
            check(9.0, Target::AtLeast(8.0)),
        ];
        assert!(answer(&checks).starts_with("2 of 3 targets are met "));
    }

    #[test]
    fn targets_are_bounds_from_their_own_side() {
        assert!(check(3.0, Target::AtMost(3.0)).met() && !check(3.1, Target::AtMost(3.0)).met());
        assert!(check(8.0, Target::AtLeast(8.0)).met() && !check(7.9, Target::AtLeast(8.0)).met());
        assert!(!check(f64::NAN, Target::AtMost(3.0)).met() && check(0.0, Target::None).met());
    }
}
