//! Convergence in law as tables, rows of CSV and a picture.

use super::blocks::Block;
use super::fit::FEWEST;
use super::job::PLACES;
use super::law::{AtTime, Change, FINER, JobMean, Law};
use super::*;
use shearbed::plan::counted;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Tables of the scene as it is, and against steps, rods and replicas; `strain` is that of a period.
pub fn law(law: &Law, strain: f64) -> [ReportTable; 5] {
    [as_it_is(law), steps(law, strain), paths(law), rods(law), replicas(law)]
}

/// The largest of some parts of an error, with its time.
fn largest(times: &[AtTime], of: impl Fn(&AtTime) -> Option<f64>) -> Option<(f64, f64)> {
    let parts = times.iter().filter_map(|at| Some((of(at)?, at.time)));
    parts.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs()))
}

/// What limits the scene as it is and what to change first, in words.
fn advice(law: &Law) -> String {
    let (own, times) = (law.own, &law.times);
    let Some((scatter, at)) = largest(times, |at| Some(at.scatter)) else {
        return String::new();
    };
    let replicas = |se: f64| (own.replicas as f64 * (scatter / se).powi(2)).ceil().max(1.0);
    let mut said = format!("The replicas' standard error is up to {scatter:.1e} (t/T = {at})");
    let readable = |bias: Option<Estimate>| bias.filter(Estimate::readable).map(|bias| bias.value);
    let steps = largest(times, |at| readable(at.steps_bias));
    let room = largest(times, |at| at.steps_bias.map(|bias| bias.value.abs() + 2.0 * bias.se));
    said += &match (steps, room) {
        (Some((bias, at)), _) => format!(", the steps' bias {bias:+.1e} (t/T = {at})"),
        (None, Some((room, _))) => format!(", no bias of the steps is seen, one of up to {room:.1e} may be hidden"),
        (None, None) => ", its steps were not compared with much finer ones".into(),
    };
    let rods = largest(times, |at| readable(at.rods_bias));
    said += &rods.map_or(String::new(), |(bias, at)| format!(", that of the few rods {bias:+.1e} (t/T = {at})"));
    let [steps, rods] = [steps, rods].map(|bias| bias.map_or(0.0, |(bias, _)| bias.abs()));
    let first = if rods > scatter.max(steps) {
        " More rods first, in a larger volume.".to_owned()
    } else if steps > 2.0 * scatter {
        " Finer steps first.".to_owned()
    } else if steps > 0.5 * scatter {
        " Half of both takes twice the steps or more, and four times the replicas.".to_owned()
    } else if steps > 0.0 {
        format!(" More replicas first: {:.0} for a standard error like that of the steps.", replicas(steps))
    } else {
        String::new()
    };
    let asked = [1e-2, 3e-3, 1e-3].map(|se| format!("{:.0} for {se}", replicas(se)));
    format!("{said}.{first} Replicas for a standard error: {}.", asked.join(", "))
}

/// What the scene's own steps, rods and replicas leave of an error.
fn as_it_is(law: &Law) -> ReportTable {
    let own = law.own;
    let most = law.rods.last().map_or(own.rods, |sample| sample.rods);
    let of = [(own.steps_per_period, "step"), (own.rods as u64, "rod"), (own.replicas, "replica")];
    let [steps, rods, replicas] = of.map(|(count, name)| counted(count, name));
    ReportTable::new(
        ["as-it-is", &format!("The scene as it is: {steps} a period, {rods}, {replicas}")],
        format!(
            "{} Bias of its steps: X̄₁ less that at {FINER} times as many steps and more. Rods near a face of the \
             volume lack neighbours: a larger volume has fewer of them.",
            advice(law)
        ),
        &law.times,
        vec![
            number("t/T", decimals(2), |at: &AtTime| at.time),
            number("X̄₁", decimals(4), |at: &AtTime| at.x1.value),
            number("se of its replicas", decimals(4), |at: &AtTime| at.scatter),
            difference("bias of its steps", |at: &AtTime| at.steps_bias.map(Into::into)),
            difference(format!("less {most} rods"), |at: &AtTime| at.rods_bias.map(Into::into)),
        ],
    )
}

/// A sentence on the weak order, or on why there is none.
fn order_in_words(law: &Law) -> String {
    let from = law.steps.get(law.resolved_from).map_or(0, |s| s.steps_per_period);
    let order = match &law.order {
        Some(order) => format!("the weak order is {:.2} ± {:.2}", order.order, order.se),
        None => "noise hides the weak order: it is not readable".into(),
    };
    let line = match &law.steps_line {
        Some(line) => {
            let from = law.steps.get(law.line_from).map_or(0, |s| s.steps_per_period);
            let fits = line.p.map_or("–".into(), |p| format!("{p:.2}"));
            let read = if line.slope.abs() >= 2.0 * line.slope_se { "" } else { " (not readable)" };
            format!(
                " A first-order bias b/S fits from {from} steps on with b = {:+.3} ± {:.3}{read}, p = {fits}; at Δt = \
                 0 X̄₁ = {:.5} ± {:.5}.",
                line.slope, line.slope_se, line.intercept, line.intercept_se
            )
        }
        None => too_few(&law.steps).unwrap_or(" No straight line in 1/steps fits X̄₁.".into()),
    };
    format!("Over the levels that resolve a flip (GΔt ≤ 1, from {from} steps on) {order}.{line}")
}

/// What too few replicas leave unknown, as a sentence; `None` if all levels have enough.
fn too_few(levels: &[JobMean]) -> Option<String> {
    let are_few = levels.iter().any(|level| level.replicas < FEWEST as u64);
    are_few.then(|| format!(" Fewer than {FEWEST} replicas of a level: no straight line is read."))
}

/// The standard errors that the largest of nine differences exceeds by chance once in 20 times at most, with the fewest
/// replicas of a level: by Student's t.
fn by_chance(levels: &[JobMean]) -> f64 {
    let fewest = levels.iter().map(|level| level.replicas).min().unwrap_or(2);
    let law = StudentsT::new(0.0, 1.0, fewest.saturating_sub(1).max(1) as f64);
    law.map_or(f64::NAN, |law| law.inverse_cdf(1.0 - 0.05 / 2.0 / PLACES as f64))
}

fn steps(law: &Law, strain: f64) -> ReportTable {
    type Row<'a> = (&'a JobMean, Option<&'a Change>);
    let rows = (law.steps.iter().enumerate()).map(|(k, sample)| (sample, law.changes.get(k)));
    let change = |of: fn(&Change) -> Estimate| move |r: &Row| r.1.map(|change| of(change).into());
    let readable = |r: &Row| match r.1.map(|change| change.x1.readable()) {
        Some(true) => "yes",
        Some(false) => "not readable",
        None => "–",
    };
    ReportTable::new(
        ["steps", &format!("X̄₁ at t/T = {} against the steps per period: convergence in law", law.end)],
        format!(
            "Coarse steps are here to show what they change. Differences are to the next finer step at the same seeds; \
             not readable: below two standard errors. The last two columns: the difference of the distribution \
             functions of |p_1| and of C_b, of nine places where it is largest in its standard errors (below {:.1} of \
             them it is chance, 19 times in 20). {}",
            by_chance(&law.steps),
            order_in_words(law)
        ),
        rows,
        vec![
            field("steps per period", |r: &Row| r.0.steps_per_period),
            number("GΔt", decimals(3), move |r: &Row| strain / r.0.steps_per_period as f64),
            field("replicas", |r: &Row| r.0.replicas),
            number("X̄₁", decimals(5), |r: &Row| r.0.x1),
            number("± se", decimals(5), |r: &Row| r.0.se),
            difference("less the next", change(|c| c.x1)),
            words("readable", readable),
            difference("share below |p_1|", change(|c| c.p1_distribution)),
            difference("share below C_b", change(|c| c.orbit_distribution)),
        ],
    )
}

fn paths(law: &Law) -> ReportTable {
    type Row<'a> = (&'a [JobMean], &'a Change);
    ReportTable::new(
        ["paths", &format!("Paths do not converge: the same rods at two steps, t/T = {}", law.end)],
        "A rod's direction is the exact motion plus kicks ∝ Δt/r at contact arms r down to 0. Halving Δt doubles the \
         collisions and halves what each does, but other draws decide which arms are met: the large kicks, at a rate \
         that does not depend on Δt, come at other times to other rods. So the angle between the same rod at two steps \
         does not fall, and the variance of a difference of X̄₁ stays of the size of the variance itself \
         (`paths-do-not-converge`).",
        law.steps.windows(2).zip(&law.changes),
        vec![
            words("steps per period", |r: &Row| format!("{} and {}", r.0[0].steps_per_period, r.0[1].steps_per_period)),
            number("same rod apart (rad, rms)", decimals(3), |r: &Row| r.1.apart_rad),
            number("other rods", decimals(3), |r: &Row| r.1.unrelated_rad),
            estimate("correlation of X̄₁", |r: &Row| r.1.correlation.and_then(Into::into)),
            number("variance of the difference / variance", decimals(2), |r: &Row| {
                r.1.correlation.map(|correlation| 2.0 * (1.0 - correlation.value))
            }),
        ],
    )
}

fn rods(law: &Law) -> ReportTable {
    let last = law.rods.last().copied();
    let less = move |sample: &JobMean| {
        let last = last.filter(|last| last != sample)?;
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
        None => format!("no straight line in {name}"),
    };
    /// Below this p a line does not fit.
    const POOR: f64 = 0.01;
    let poor = law.rods_lines.iter().all(|line| line.as_ref().and_then(|line| line.p).is_none_or(|p| p < POOR));
    let power = if poor {
        format!("Neither fits, as p < {POOR}: no power of N is claimed.")
    } else {
        "These points cannot distinguish N^(−1/2) from N^(−1/3).".into()
    };
    let fitted = || {
        format!(
            " Fitted: {}; {}. p is the probability that a right line fits no better by chance. {power}",
            line(0, "N^(−1/3)"),
            line(1, "N^(−1)")
        )
    };
    let lines = too_few(&law.rods).unwrap_or_else(fitted);
    ReportTable::new(
        ["rods", &format!("X̄₁ at t/T = {} against the rods", law.end)],
        format!(
            "Rods near a face of the volume lack neighbours, and the share of the volume near faces is ∝ N^(−1/3) \
             (`faces-cost-collisions`).{lines}"
        ),
        &law.rods,
        vec![
            field("rods", |s: &JobMean| s.rods),
            field("replicas", |s: &JobMean| s.replicas),
            number("X̄₁", decimals(5), |s: &JobMean| s.x1),
            number("± se", decimals(5), |s: &JobMean| s.se),
            difference("less the most", less),
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
        ["replicas", &format!("The scatter of X̄₁ at t/T = {} against the replicas M", law.end)],
        format!(
            "The standard deviation of means over blocks of M replicas; the last column is constant where it falls as \
             1/√M. {exponent}"
        ),
        &law.blocks,
        vec![
            field("replicas", |b: &Block| b.replicas),
            field("blocks", |b: &Block| b.blocks),
            number("deviation of means", decimals(5), |b: &Block| b.deviation),
            number("deviation √M", decimals(4), |b: &Block| b.deviation * (b.replicas as f64).sqrt()),
        ],
    )
}

/// X̄₁ against the step, and the straight line of first order.
pub fn steps_figure(law: &Law) -> ReportFigure {
    let step = |sample: &JobMean| 1.0 / sample.steps_per_period as f64;
    let [coarsest, finest] = [law.steps.get(law.line_from), law.steps.last()].map(|level| level.map_or(1.0, step));
    let line = law.steps_line.as_ref().map(|line| {
        let steps = (0..=60).map(|k| coarsest * (finest / coarsest).powf(f64::from(k) / 60.0));
        Curve::of("first order", steps, |x| (x, line.intercept + line.slope * x))
    });
    ReportFigure::new(
        ["steps", &format!("Interacting rods: X̄₁ at t/T = {} against the step", law.end)],
        "Convergence in law: the mean, with 95 % bars, tends to a limit as Δt → 0, to the left; the line is a + bΔt, \
         where one fits.",
        ["log step Δt/T", "X̄₁ (rod lengths)"],
    )
    .curves(line)
    .points([Points::with_bars("simulated", &law.steps, |s| (step(s), s.x1, 1.96 * s.se))])
    .judged("eqs 4 to 14", &["cheapest-split", "paths-do-not-converge"])
}

/// times.csv of an interacting scene.
pub fn times_csv(law: &Law) -> Result<String, String> {
    columns_csv(
        &law.times,
        vec![
            field("t_over_T", |at: &AtTime| at.time),
            field("x1", |at: &AtTime| at.x1.value),
            field("se_of_own_replicas", |at: &AtTime| at.scatter),
            field("steps_bias", |at: &AtTime| at.steps_bias.map(|bias| bias.value)),
            field("steps_bias_se", |at: &AtTime| at.steps_bias.map(|bias| bias.se)),
            field("less_most_rods", |at: &AtTime| at.rods_bias.map(|bias| bias.value)),
            field("less_most_rods_se", |at: &AtTime| at.rods_bias.map(|bias| bias.se)),
        ],
    )
}

/// converge.csv of an interacting scene.
pub fn law_csv(law: &Law) -> Result<String, String> {
    type Row<'a> = (&'static str, &'a JobMean, Option<&'a Change>);
    let steps = law.steps.iter().enumerate();
    let steps = steps.map(|(k, mean)| ("steps_per_period", mean, law.changes.get(k)));
    let rods = law.rods.iter().map(|mean| ("rods", mean, None));
    let change = |name: &str, of: fn(&Change) -> f64| field(name, move |r: &Row| r.2.map(of));
    let columns = vec![
        words("against", |r: &Row| r.0),
        field("steps_per_period", |r: &Row| r.1.steps_per_period),
        field("rods", |r: &Row| r.1.rods),
        field("replicas", |r: &Row| r.1.replicas),
        field("x1", |r: &Row| r.1.x1),
        field("x1_se", |r: &Row| r.1.se),
        change("x1_less_next", |c| c.x1.value),
        change("x1_less_next_se", |c| c.x1.se),
        field("correlation", |r: &Row| r.2.and_then(|c| c.correlation).map(|correlation| correlation.value)),
        change("p1_distribution", |c| c.p1_distribution.value),
        change("p1_distribution_se", |c| c.p1_distribution.se),
        change("orbit_distribution", |c| c.orbit_distribution.value),
        change("orbit_distribution_se", |c| c.orbit_distribution.se),
        change("same_rod_apart_rad", |c| c.apart_rad),
        change("other_rods_apart_rad", |c| c.unrelated_rad),
    ];
    columns_csv(steps.chain(rods), columns)
}
