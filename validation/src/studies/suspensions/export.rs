//! The records of the studies as files.

use super::free::{Bench, Point, StartCurve};
use super::law::{Change, JobMean, Law};
use super::split::{Realised, Scope};
use super::study::{Answer, Interacting};
use crate::present::table::{Datum, ReportTable, field};

/// suspensions.csv: free ones.
pub fn free_csv(benches: &[Bench]) -> Result<String, String> {
    type Row<'a> = (&'a Bench, &'a StartCurve, &'a Point);
    let points = benches.iter().flat_map(|bench| {
        let curves = bench.curves.iter();
        curves.flat_map(move |curve| curve.points.iter().map(move |point| (bench, curve, point)))
    });
    let columns = vec![
        field("scene", |r: &Row| r.0.free.scene),
        field("t_over_t", |r: &Row| r.0.free.turns),
        field("start", |r: &Row| r.1.start),
        field("rods", |r: &Row| r.2.rods),
        field("x1_rms_error", |r: &Row| r.2.error),
        field("trials", |r: &Row| r.2.trials),
        field("seconds_min", |r: &Row| r.2.seconds.least),
        field("seconds_max", |r: &Row| r.2.seconds.most),
        field("measurements", |r: &Row| r.2.seconds.measurements),
    ];
    ReportTable::new(["suspensions", ""], "", points, columns).csv()
}

/// splits.csv: the cheapest splits of an interacting scene.
pub fn splits_csv(study: &Interacting) -> Result<String, String> {
    let realised =
        |of: fn(&Realised) -> Datum| move |a: &&Answer| a.realised.as_ref().map_or(Datum::Nothing, of);
    let columns = vec![
        field("scene", |_: &&Answer| study.scene.as_str()),
        field("target", |a: &&Answer| a.split.target),
        field("counted_from", |a: &&Answer| match a.split.scope {
            Scope::OwnRods(_) => "own_rods",
            Scope::Unbounded => "unbounded",
        }),
        field("steps_per_period", |a: &&Answer| a.split.steps_per_period),
        field("rods", |a: &&Answer| a.split.rods),
        field("replicas", |a: &&Answer| a.split.replicas),
        field("bias_at_most", |a: &&Answer| a.split.bias),
        field("scatter", |a: &&Answer| a.split.scatter),
        field("rod_steps", |a: &&Answer| a.split.rod_steps()),
        field("seconds", |a: &&Answer| a.seconds),
        field("repeats", realised(|r| r.repeats.into())),
        field("realised_error", realised(|r| r.error.into())),
        field("realised_bias", realised(|r| r.bias.value.into())),
        field("realised_bias_se", realised(|r| r.bias.se.into())),
        field("realised_scatter", realised(|r| r.scatter.value.into())),
    ];
    ReportTable::new(["splits", ""], "", &study.answers, columns).csv()
}

/// converge.csv of an interacting scene.
pub fn law_csv(law: &Law) -> Result<String, String> {
    type Row<'a> = (&'static str, &'a JobMean, Option<&'a Change>);
    let steps = (law.steps.iter().enumerate()).map(|(k, s)| ("steps_per_period", s, law.changes.get(k)));
    let rods = law.rods.iter().map(|sample| ("rods", sample, None));
    let change = |of: fn(&Change) -> f64| move |r: &Row| r.2.map(of);
    let columns = vec![
        field("against", |r: &Row| r.0),
        field("steps_per_period", |r: &Row| r.1.steps_per_period),
        field("rods", |r: &Row| r.1.rods),
        field("replicas", |r: &Row| r.1.replicas),
        field("x1", |r: &Row| r.1.x1),
        field("x1_se", |r: &Row| r.1.se),
        field("x1_less_next", change(|c| c.x1.value)),
        field("x1_less_next_se", change(|c| c.x1.se)),
        field("correlation", change(|c| c.correlation.value)),
        field("p1_distribution", change(|c| c.p1_distribution.value)),
        field("p1_distribution_se", change(|c| c.p1_distribution.se)),
        field("orbit_distribution", change(|c| c.orbit_distribution.value)),
        field("orbit_distribution_se", change(|c| c.orbit_distribution.se)),
        field("same_rod_apart_rad", change(|c| c.apart_rad)),
        field("other_rods_apart_rad", change(|c| c.unrelated_rad)),
    ];
    ReportTable::new(["converge", ""], "", steps.chain(rods), columns).csv()
}

/// replicas.csv of an interacting scene.
pub fn replicas_csv(law: &Law) -> Result<String, String> {
    let columns = vec![
        field("replicas", |b: &&super::blocks::Block| b.replicas),
        field("blocks", |b: &&super::blocks::Block| b.blocks),
        field("deviation", |b: &&super::blocks::Block| b.deviation),
    ];
    ReportTable::new(["replicas", ""], "", &law.blocks, columns).csv()
}
