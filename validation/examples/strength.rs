//! Tries the probabilities that the gate promises: the cases at many seeds, and how often each turned red, and why.
//!
//! `cargo run --release -p shearbed-validation --example strength -- SEEDS [full] [CASE...]` prints the tables of
//! `docs/src/verification/error-rates.md`, after every 20 seeds those until then. SEEDS is the last one, or the first
//! and the last as `61..200`. A case whose evidence is the same at the first five seeds draws nothing, and is not run
//! again.

use shearbed_validation::cases;
use shearbed_validation::judge::accept::{Rule, Verdict};
use shearbed_validation::judge::case::{Case, Effort, Outcome};
use std::collections::BTreeMap;

fn main() {
    let mut words = std::env::args().skip(1);
    let seeds = words.next().unwrap_or_else(|| "3".into());
    let (first, last) = seeds.split_once("..").unwrap_or(("1", &seeds));
    let [first, last]: [u64; 2] = [first, last].map(|seed| seed.parse().expect("SEEDS is 200, or 61..200"));
    let (full, names): (Vec<_>, Vec<_>) = words.partition(|word| word == "full");
    let full = !full.is_empty();
    let mut cases: Vec<Case> = cases::all();
    cases.retain(|case| names.is_empty() || names.iter().any(|name| name == case.about.name));
    let still = cases.len();
    let mut records: BTreeMap<&str, Record> = BTreeMap::new();
    let (mut red_runs, mut scores) = (0, Vec::new());
    for seed in first..=last {
        let effort = Effort { full, seed, data: None };
        let mut red = false;
        cases.retain(|case| {
            let outcome = case.run(&effort);
            let record = records.entry(case.about.name).or_default();
            red |= record.add(&outcome, &mut scores);
            record.draws() || record.runs < 5
        });
        red_runs += u32::from(red);
        eprintln!("seed {seed}: {}", if red { "RED" } else { "green" });
        if seed % 20 == 0 || seed == last {
            println!(
                "{red_runs} of {} runs red; {} of {still} cases draw random numbers",
                seed - first + 1,
                records.values().filter(|record| record.draws()).count()
            );
            print(&records, &mut scores);
        }
    }
}

/// The tables of all seeds until now: a run of an hour that is stopped keeps its last ones.
fn print(records: &BTreeMap<&str, Record>, scores: &mut [f64]) {
    scores.sort_by(f64::total_cmp);
    let count = scores.len() as f64;
    let square = scores.iter().map(|z| z * z).sum::<f64>() / count;
    if let (Some(first), Some(last)) = (scores.first(), scores.last()) {
        println!(
            "{count} z-scores of means without allowance: root mean square {:.3}, from {first:.2} to {last:.2}",
            square.sqrt()
        );
    }
    println!(
        "\n| case | judges | seeds | red | why | false alarm ≤ | s | controls: the least margin, its mean and \
         deviation, miss |"
    );
    println!("| --- | --- | ---: | ---: | --- | ---: | ---: | --- |");
    for (name, record) in records.iter().filter(|(_, record)| record.draws()) {
        println!("| `{name}` | {} |", record.row());
    }
    println!();
}

/// What a case said at all seeds.
#[derive(Default)]
struct Record {
    judges: &'static str,
    runs: u32,
    red: u32,
    why: BTreeMap<String, u32>,
    false_alarm: f64,
    seconds: f64,
    first: Option<String>,
    differs: bool,
    controls: BTreeMap<String, Vec<f64>>,
}

impl Record {
    /// Whether its evidence was seen to differ between seeds, or there was one seed alone.
    fn draws(&self) -> bool {
        self.differs || self.runs == 1
    }

    /// Whether the case was red.
    fn add(&mut self, outcome: &Outcome, scores: &mut Vec<f64>) -> bool {
        self.judges = outcome.about.judges.name();
        self.runs += 1;
        self.seconds += outcome.seconds;
        self.false_alarm = self.false_alarm.max(outcome.false_alarm());
        let said = format!("{:?}{:?}", outcome.evidence, outcome.controls);
        match &self.first {
            None => self.first = Some(said),
            Some(first) => self.differs |= *first != said,
        }
        for judged in &outcome.evidence {
            let what = match judged.verdict {
                Verdict::Fail => "failed",
                Verdict::Underpowered => "under-powered",
                _ => continue,
            };
            *self.why.entry(format!("{what}: {}", judged.evidence.what)).or_default() += 1;
        }
        for control in &outcome.controls {
            if !control.caught {
                *self.why.entry(format!("not caught: {}", control.mistake)).or_default() += 1;
            }
            if let Some(margin) = control.margin {
                self.controls.entry(control.mistake.to_string()).or_default().push(margin);
            }
        }
        for judged in &outcome.evidence {
            if let Rule::Mean { mean, se, reference, allowance: 0.0, .. } = judged.evidence.rule {
                scores.push((mean - reference) / se);
            }
        }
        let red = matches!(outcome.verdict, Verdict::Fail | Verdict::Underpowered);
        self.red += u32::from(red);
        red
    }

    fn row(&self) -> String {
        let why: Vec<_> = self.why.iter().map(|(why, times)| format!("{why} ({times})")).collect();
        let controls = self.controls.iter().map(|(mistake, margins)| {
            let (drawn, still): (Vec<f64>, Vec<_>) = margins.iter().partition(|m| m.is_finite());
            let still =
                if still.is_empty() { String::new() } else { format!(", without scatter at {} seeds", still.len()) };
            if drawn.is_empty() {
                return format!("{mistake}{still}");
            }
            let n = drawn.len() as f64;
            let mean = drawn.iter().sum::<f64>() / n;
            let sd = (drawn.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0)).sqrt();
            let least = drawn.iter().copied().fold(f64::INFINITY, f64::min);
            let miss = shearbed_validation::judge::accept::upper_tail(mean / sd.max(1.0));
            format!("{mistake}: {least:.1}, {mean:.1} ± {sd:.1}, {miss:.0e}{still}")
        });
        format!(
            "{} | {} | {} | {} | {:.0e} | {:.2} | {}",
            self.judges,
            self.runs,
            self.red,
            why.join("; "),
            self.false_alarm,
            self.seconds / f64::from(self.runs),
            controls.collect::<Vec<_>>().join("; ")
        )
    }
}
