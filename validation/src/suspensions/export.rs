//! The studies as files.

use super::free::Bench;
use super::law::Law;
use super::split::Scope;
use super::study::Study;
use crate::work_precision::export::csv;
use serde::Serialize;

/// A row of suspensions.csv.
#[derive(Serialize)]
struct StartRow<'a> {
    scene: &'a str,
    t_over_t: f64,
    start: &'a str,
    rods: usize,
    x1_rms_error: f64,
    trials: usize,
    seconds_min: f64,
    seconds_max: f64,
    measurements: usize,
}

/// suspensions.csv: free ones.
pub fn free_csv(benches: &[Bench]) -> Result<String, String> {
    let mut rows = Vec::new();
    for bench in benches {
        for curve in &bench.curves {
            rows.extend(curve.points.iter().map(|point| StartRow {
                scene: bench.free.scene,
                t_over_t: bench.free.turns,
                start: curve.start,
                rods: point.rods,
                x1_rms_error: point.error,
                trials: point.trials,
                seconds_min: point.seconds.least,
                seconds_max: point.seconds.most,
                measurements: point.seconds.measurements,
            }));
        }
    }
    csv(rows)
}

/// A row of splits.csv.
#[derive(Serialize)]
struct SplitRow<'a> {
    scene: &'a str,
    target: f64,
    counted_from: &'static str,
    steps_per_period: u64,
    rods: usize,
    replicas: u64,
    bias_at_most: f64,
    scatter: f64,
    rod_steps: u64,
    seconds: f64,
    repeats: Option<u64>,
    realised_error: Option<f64>,
    realised_bias: Option<f64>,
    realised_bias_se: Option<f64>,
    realised_scatter: Option<f64>,
}

/// splits.csv: the cheapest splits of an interacting scene.
pub fn splits_csv(study: &Study) -> Result<String, String> {
    let rows = study.answers.iter().map(|answer| {
        let (split, realised) = (&answer.split, answer.realised.as_ref());
        SplitRow {
            scene: &study.scene,
            target: split.target,
            counted_from: match split.scope {
                Scope::OwnRods(_) => "own_rods",
                Scope::Unbounded => "unbounded",
            },
            steps_per_period: split.steps_per_period,
            rods: split.rods,
            replicas: split.replicas,
            bias_at_most: split.bias,
            scatter: split.scatter,
            rod_steps: split.rod_steps(),
            seconds: answer.seconds,
            repeats: realised.map(|realised| realised.repeats),
            realised_error: realised.map(|realised| realised.error),
            realised_bias: realised.map(|realised| realised.bias.value),
            realised_bias_se: realised.map(|realised| realised.bias.se),
            realised_scatter: realised.map(|realised| realised.scatter.value),
        }
    });
    csv(rows)
}

/// A row of converge.csv for an interacting scene.
#[derive(Serialize)]
struct SampleRow {
    against: &'static str,
    steps_per_period: u64,
    rods: usize,
    replicas: u64,
    x1: f64,
    x1_se: f64,
    x1_less_next: Option<f64>,
    x1_less_next_se: Option<f64>,
    correlation: Option<f64>,
    p1_distribution: Option<f64>,
    p1_distribution_se: Option<f64>,
    orbit_distribution: Option<f64>,
    orbit_distribution_se: Option<f64>,
    same_rod_apart_rad: Option<f64>,
    other_rods_apart_rad: Option<f64>,
}

/// converge.csv of an interacting scene.
pub fn law_csv(law: &Law) -> Result<String, String> {
    let steps = (law.steps.iter().enumerate()).map(|(k, s)| ("steps_per_period", s, law.changes.get(k)));
    let rods = law.rods.iter().map(|s| ("rods", s, None));
    let rows = steps.chain(rods).map(|(against, s, change)| SampleRow {
        against,
        steps_per_period: s.steps_per_period,
        rods: s.rods,
        replicas: s.replicas,
        x1: s.x1,
        x1_se: s.se,
        x1_less_next: change.map(|c| c.x1.value),
        x1_less_next_se: change.map(|c| c.x1.se),
        correlation: change.map(|c| c.correlation.value),
        p1_distribution: change.map(|c| c.p1_distribution.value),
        p1_distribution_se: change.map(|c| c.p1_distribution.se),
        orbit_distribution: change.map(|c| c.orbit_distribution.value),
        orbit_distribution_se: change.map(|c| c.orbit_distribution.se),
        same_rod_apart_rad: change.map(|c| c.apart_rad),
        other_rods_apart_rad: change.map(|c| c.unrelated_rad),
    });
    csv(rows)
}

/// A row of replicas.csv.
#[derive(Serialize)]
struct BlockRow {
    replicas: u64,
    blocks: u64,
    deviation: f64,
}

/// replicas.csv of an interacting scene.
pub fn replicas_csv(law: &Law) -> Result<String, String> {
    csv(law.blocks.iter().map(|block| BlockRow {
        replicas: block.replicas,
        blocks: block.blocks,
        deviation: block.deviation,
    }))
}
