//! Convergence in law as tables.

use super::Estimate;
use super::blocks::Block;
use super::law::{Change, JobMean, Law};
use crate::present::table::{ReportTable, estimate, field, number, words};

/// Against steps, rods and replicas; `strain` is that of a period.
pub fn law(law: &Law, strain: f64) -> Vec<ReportTable> {
    vec![steps(law, strain), paths(law), rods(law), replicas(law)]
}

fn signed(value: f64, se: f64) -> String {
    format!("{value:+.5} ± {se:.5}")
}

fn pair(estimate: &Estimate) -> (f64, f64) {
    (estimate.value, estimate.se)
}

fn five(number: f64) -> String {
    format!("{number:.5}")
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
    type Row<'a> = (&'a JobMean, Option<&'a Change>);
    let rows = (law.steps.iter().enumerate()).map(|(k, sample)| (sample, law.changes.get(k)));
    let change = |of: fn(&Change) -> Estimate| move |r: &Row| r.1.map(|change| pair(&of(change)));
    let readable = |r: &Row| match r.1.map(|change| change.x1.readable()) {
        Some(true) => "yes",
        Some(false) => "not readable",
        None => "–",
    };
    ReportTable::new(
        ["steps", "X̄₁ at t/T = 1 against the steps per period: convergence in law"],
        format!(
            "Differences are to the next finer step at the same seeds; not readable: below two standard errors. The last \
             two columns: the difference of the distribution functions of |p_1| and of C_b, of nine places where it is \
             largest in its standard errors (below 2.8 of them it is chance, 19 times in 20). {}",
            order_in_words(law)
        ),
        rows,
        vec![
            field("steps per period", |r: &Row| r.0.steps_per_period),
            number("GΔt", |x| format!("{x:.3}"), move |r: &Row| strain / r.0.steps_per_period as f64),
            field("replicas", |r: &Row| r.0.replicas),
            number("X̄₁", five, |r: &Row| r.0.x1),
            number("± se", five, |r: &Row| r.0.se),
            estimate("less the next", signed, change(|c| c.x1)),
            words("readable", readable),
            estimate("share below |p_1|", signed, change(|c| c.p1_distribution)),
            estimate("share below C_b", signed, change(|c| c.orbit_distribution)),
        ],
    )
}

fn paths(law: &Law) -> ReportTable {
    type Row<'a> = (&'a [JobMean], &'a Change);
    let three = |x: f64| format!("{x:.3}");
    ReportTable::new(
        ["paths", "Paths do not converge: the same rods at two steps, t/T = 1"],
        "A rod's direction is the exact motion plus kicks ∝ Δt/r at contact arms r down to 0. Halving Δt doubles the \
         collisions and halves what each does, but other draws decide which arms are met: the large kicks, at a rate \
         that does not depend on Δt, come at other times to other rods. So the angle between the same rod at two steps \
         does not fall, and the variance of a difference of X̄₁ stays of the size of the variance itself \
         (`paths-do-not-converge`).",
        law.steps.windows(2).zip(&law.changes),
        vec![
            words("steps per period", |r: &Row| {
                format!("{} and {}", r.0[0].steps_per_period, r.0[1].steps_per_period)
            }),
            number("same rod apart (rad, rms)", three, |r: &Row| r.1.apart_rad),
            number("other rods", three, |r: &Row| r.1.unrelated_rad),
            estimate(
                "correlation of X̄₁",
                |x, se| format!("{x:.3} ± {se:.3}"),
                |r: &Row| pair(&r.1.correlation),
            ),
            number(
                "variance of the difference / variance",
                |x| format!("{x:.2}"),
                |r: &Row| 2.0 * (1.0 - r.1.correlation.value),
            ),
        ],
    )
}

fn rods(law: &Law) -> ReportTable {
    let last = law.rods.last().copied();
    let less = move |sample: &&JobMean| {
        let last = last.filter(|last| last != *sample)?;
        Some((sample.x1 - last.x1, sample.se.hypot(last.se)))
    };
    let line = |k: usize, name: &str| match &law.rods_lines[k] {
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
    ReportTable::new(
        ["rods", "X̄₁ at t/T = 1 against the rods"],
        format!(
            "Rods near a face of the volume lack neighbours, and the share of the volume near faces is ∝ N^(−1/3) \
             (`faces-cost-collisions`). Fits: {}; {}. p is the probability that chance alone makes \
             a right line fit no better. N^(−1/2) is not told from N^(−1/3) by this.",
            line(0, "N^(−1/3)"),
            line(1, "/N")
        ),
        &law.rods,
        vec![
            field("rods", |s: &&JobMean| s.rods),
            field("replicas", |s: &&JobMean| s.replicas),
            number("X̄₁", five, |s: &&JobMean| s.x1),
            number("± se", five, |s: &&JobMean| s.se),
            estimate("less the most", signed, less),
        ],
    )
}

fn replicas(law: &Law) -> ReportTable {
    let exponent = match &law.replicas_exponent {
        Some(exponent) => {
            format!("The exponent of M is {:+.3} ± {:.3}; by theory −½.", exponent.value, exponent.se)
        }
        None => "Fewer than 1024 replicas: the exponent of M is not read.".into(),
    };
    ReportTable::new(
        ["replicas", "The scatter of X̄₁ at t/T = 1 against the replicas M"],
        format!(
            "The standard deviation of means over blocks of M replicas; the last column is constant where it falls as \
             1/√M. {exponent}"
        ),
        &law.blocks,
        vec![
            field("replicas", |b: &&Block| b.replicas),
            field("blocks", |b: &&Block| b.blocks),
            number("deviation of means", five, |b: &&Block| b.deviation),
            number(
                "deviation √M",
                |x| format!("{x:.4}"),
                |b: &&Block| b.deviation * (b.replicas as f64).sqrt(),
            ),
        ],
    )
}
