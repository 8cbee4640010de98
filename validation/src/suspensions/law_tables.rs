//! Convergence in law as tables.

use super::Estimate;
use super::law::{Block, Change, Law, Sample};
use crate::report::ReportTable;
use crate::work_precision::tables::table;

/// Against steps, rods and replicas; `strain` is that of a period.
pub fn law(law: &Law, strain: f64) -> Vec<ReportTable> {
    vec![steps(law, strain), paths(law), rods(law), replicas(law)]
}

fn plus_minus(estimate: &Estimate) -> String {
    format!("{:+.5} ± {:.5}", estimate.value, estimate.se)
}

/// How the weak order was read, or that it was not.
pub fn order_in_words(law: &Law) -> String {
    let from = law.steps.get(law.resolved_from).map_or(0, |s| s.steps_per_period);
    let order = match &law.order {
        Some(order) => format!(
            "Over the levels that resolve a flip (GΔt ≤ 1, from {from} steps on) the weak order is {:.2} ± {:.2}.",
            order.order, order.se
        ),
        None => format!(
            "Over the levels that resolve a flip (GΔt ≤ 1, from {from} steps on) noise hides the weak order: it is not \
             readable."
        ),
    };
    let line = match &law.steps_line {
        Some(line) => {
            let from = law.steps.get(law.line_from).map_or(0, |s| s.steps_per_period);
            let fits = line.p.map_or("–".into(), |p| format!("{p:.2}"));
            let read = match line.slope.abs() >= 2.0 * line.slope_se {
                true => "",
                false => " (not readable)",
            };
            format!(
                " A first-order bias b/S fits from {from} steps on with b = {:+.3} ± {:.3}{read}, p = {fits}; at Δt = 0 X̄₁ = \
                 {:.5} ± {:.5}.",
                line.slope, line.slope_se, line.intercept, line.intercept_se
            )
        }
        None => " No bias b/S fits.".into(),
    };
    order + &line
}

fn steps(law: &Law, strain: f64) -> ReportTable {
    let row = |k: usize, sample: &Sample| {
        let mut row = vec![
            sample.steps_per_period.to_string(),
            format!("{:.3}", strain / sample.steps_per_period as f64),
            sample.replicas.to_string(),
            format!("{:.5}", sample.x1),
            format!("{:.5}", sample.se),
        ];
        row.extend(match law.changes.get(k) {
            Some(change) => [
                plus_minus(&change.x1),
                match change.x1.readable() {
                    true => "yes".into(),
                    false => "not readable".into(),
                },
                plus_minus(&change.p1_distribution),
                plus_minus(&change.orbit_distribution),
            ],
            None => ["–"; 4].map(String::from),
        });
        row
    };
    table(
        "steps",
        "X̄₁ at t/T = 1 against the steps per period: convergence in law",
        &format!(
            "Differences are to the next finer step at the same seeds; not readable: below two standard errors. The last \
             two columns: the difference of the distribution functions of |p_1| and of C_b, of nine places where it is \
             largest in its standard errors (below 2.8 of them it is chance, 19 times in 20). {}",
            order_in_words(law)
        ),
        &[
            "steps per period",
            "GΔt",
            "replicas",
            "X̄₁",
            "± se",
            "less the next",
            "readable",
            "share below |p_1|",
            "share below C_b",
        ],
        law.steps.iter().enumerate().map(|(k, s)| row(k, s)).collect(),
    )
}

fn paths(law: &Law) -> ReportTable {
    let row = |(pair, change): (&[Sample], &Change)| {
        vec![
            format!("{} and {}", pair[0].steps_per_period, pair[1].steps_per_period),
            format!("{:.3}", change.apart_rad),
            format!("{:.3}", change.unrelated_rad),
            format!("{:.3} ± {:.3}", change.correlation.value, change.correlation.se),
            format!("{:.2}", 2.0 * (1.0 - change.correlation.value)),
        ]
    };
    table(
        "paths",
        "Paths do not converge: the same rods at two steps, t/T = 1",
        "A rod's direction is the exact motion plus kicks ∝ Δt/r at contact arms r down to 0. Halving Δt doubles the \
         collisions and halves what each does, but other draws decide which arms are met: the large kicks, at a rate \
         that does not depend on Δt, come at other times to other rods. So the angle between the same rod at two steps \
         does not fall, and the variance of a difference of X̄₁ stays of the size of the variance itself \
         (`paths-do-not-converge`).",
        &[
            "steps per period",
            "same rod apart (rad, rms)",
            "other rods",
            "correlation of X̄₁",
            "variance of the difference / variance",
        ],
        law.steps.windows(2).zip(&law.changes).map(row).collect(),
    )
}

fn rods(law: &Law) -> ReportTable {
    let last = law.rods.last().copied();
    let row = |sample: &Sample| {
        let apart = last
            .filter(|last| last != sample)
            .map_or("–".into(), |last| plus_minus(&less(sample, &last)));
        vec![
            sample.rods.to_string(),
            sample.replicas.to_string(),
            format!("{:.5}", sample.x1),
            format!("{:.5}", sample.se),
            apart,
        ]
    };
    let words = |k: usize, name: &str| match &law.rods_lines[k] {
        Some(line) => format!(
            "X̄₁ = {:.5} ± {:.5} {:+.4} {name} (± {:.4}; p = {})",
            line.intercept,
            line.intercept_se,
            line.slope,
            line.slope_se,
            line.p.map_or("–".into(), |p| format!("{p:.1e}"))
        ),
        None => format!("no line in {name}"),
    };
    table(
        "rods",
        "X̄₁ at t/T = 1 against the rods",
        &format!(
            "Rods near a face of the volume lack neighbours, and the share of the volume near faces is ∝ N^(−1/3) \
             (`faces-cost-collisions`). Fits: {}; {}. A line with p below 0.001 is refuted; \
             N^(−1/2) is not told from N^(−1/3) by this.",
            words(0, "N^(−1/3)"),
            words(1, "/N")
        ),
        &["rods", "replicas", "X̄₁", "± se", "less the most"],
        law.rods.iter().map(row).collect(),
    )
}

fn less(one: &Sample, other: &Sample) -> Estimate {
    Estimate {
        value: one.x1 - other.x1,
        se: one.se.hypot(other.se),
    }
}

fn replicas(law: &Law) -> ReportTable {
    let row = |block: &Block| {
        vec![
            block.replicas.to_string(),
            block.blocks.to_string(),
            format!("{:.5}", block.deviation),
            format!("{:.4}", block.deviation * (block.replicas as f64).sqrt()),
        ]
    };
    let exponent = match &law.replicas_exponent {
        Some(exponent) => format!(
            "The exponent of M is {:+.3} ± {:.3}; by theory −½.",
            exponent.value, exponent.se
        ),
        None => "Fewer than 1024 replicas: the exponent of M is not read.".into(),
    };
    table(
        "replicas",
        "The scatter of X̄₁ at t/T = 1 against the replicas M",
        &format!(
            "The standard deviation of means over blocks of M replicas; the last column is constant where it falls as \
             1/√M. {exponent}"
        ),
        &["replicas", "blocks", "deviation of means", "deviation √M"],
        law.blocks.iter().map(row).collect(),
    )
}
