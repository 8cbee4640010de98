//! Tables of what is derived from each mean of a run: extremes and amplitudes, and damping rates and steady values.

use super::tables;
use shearbed::motion::Propagator;
use shearbed::plan::Stage;
use shearbed::run::ensemble::{Column, MOST_GROUPED};
use shearbed::{Observable, Plan, Results};
use shearbed_validation::files::csv;
use shearbed_validation::files::output::Output;
use shearbed_validation::methods::coefficients;
use shearbed_validation::methods::derived::{Derived, Estimate, Extreme, FEWEST, NO_RATE};
use std::collections::BTreeMap;

/// Maxima, minima and amplitudes, a row each.
pub(super) const EXTREMES: &str = "extremes.csv";
/// Damping rates and steady values, collisions and C_I, in one row.
pub(super) const DERIVED: &str = "derived.csv";

/// The largest number of extremes of each channel in a table: the first.
const MOST: usize = 1000;

/// What is derived from a run: of each channel, except those of densities, and of the whole.
pub(super) struct All<'a> {
    channels: Vec<(&'a Column, Derived)>,
    /// By name; the names depend on the scene's keys of output and collisions alone.
    whole: Vec<(&'static str, Option<Estimate>)>,
    /// The largest strain between outputs, if a rod can flip unseen in it: then there are no extremes.
    sparse: Option<f64>,
}

/// The strain in which a rod of any length flips from 45° before the gradient axis to 45° behind it.
pub(super) const FLIP: f64 = 2.0;

pub(super) fn of<'a>(plan: &Plan, results: &'a Results) -> All<'a> {
    let replicas = plan.scene().ensemble.replicas;
    let series = results.series.iter().filter(|series| !series.observable.is_density());
    let columns = series.flat_map(|series| &series.columns);
    let sparse = Some(plan.strain_between_outputs()).filter(|strain| *strain > FLIP);
    let one = |column: &'a Column| {
        let derived = Derived::new(&results.times, column, replicas);
        (column, if sparse.is_some() { derived.without_extremes() } else { derived })
    };
    All { channels: columns.map(one).collect(), whole: whole(plan, results), sparse }
}

/// The tables [`EXTREMES`] and [`DERIVED`].
pub(super) fn files(plan: &Plan, results: &Results, all: &All) -> Result<[Output; 2], String> {
    Ok([(EXTREMES.to_owned(), extremes(plan, results, all)?), (DERIVED.to_owned(), scalars(plan, results, all)?)])
}

/// The endings of the columns of [`EXTREMES`].
const OF_EXTREMES: [&str; 3] = ["maximum", "minimum", "amplitude"];

/// True for a column of [`EXTREMES`], such as `x1_amplitude`.
pub(super) fn is_extreme(column: &str) -> bool {
    column.rsplit_once('_').is_some_and(|(_, kind)| OF_EXTREMES.contains(&kind))
}

/// True for a column of [`DERIVED`], such as `x1_steady`.
pub(super) fn is_of_run(column: &str) -> bool {
    is_rate(column) || column.ends_with("_steady") || [COLLISIONS, C_I, C_I_PER_COLLISION].contains(&column)
}

pub(super) fn is_rate(column: &str) -> bool {
    column.ends_with("_damping_rate")
}

/// What a run without the value `channel` lacks, in words.
pub(super) fn lacks(channel: &str) -> String {
    if is_extreme(channel) {
        format!(
            "none is beyond noise with these replicas and periods, or outputs are more than a strain of {FLIP} apart"
        )
    } else if is_rate(channel) {
        format!("{NO_RATE}, and outputs at most a strain of {FLIP} apart")
    } else if channel == COLLISIONS {
        "its flow has no period".into()
    } else if [C_I, C_I_PER_COLLISION].contains(&channel) {
        "it needs both orientation tensors, plane Couette flow, one aspect ratio, two periods, and outputs at most a \
         strain of 1 apart"
            .into()
    } else {
        format!("the mean drifts in the second half of the run, or seems to, or replicas are fewer than {FEWEST}")
    }
}

/// How often a rod collides in a period.
const COLLISIONS: &str = "collisions_per_rod_and_period";
/// Folgar & Tucker's coefficient, over the last whole periods of the run's second half.
const C_I: &str = "c_i";
/// That over the collisions of a rod in a unit of strain.
const C_I_PER_COLLISION: &str = "c_i_per_collision";

/// The collisions of a rod in each of `units` that the run takes. Both rods of a pair collide.
fn per_rod(plan: &Plan, results: &Results, units: f64) -> Option<Estimate> {
    let [value, se] = results.collisions.map(|all| 2.0 * all / plan.scene().particles.count as f64 / units);
    let collide = plan.runs(Stage::Contacts) && value.is_finite();
    collide.then_some(Estimate { value, se: Some(se).filter(|se| se.is_finite()) })
}

/// How often a rod collides in a period; none without collisions or a period.
pub(super) fn per_rod_and_period(plan: &Plan, results: &Results) -> Option<Estimate> {
    let period_s = Propagator::new(plan.flow(), plan.scene().particles.aspect_ratio).period_s()?;
    per_rod(plan, results, results.elapsed.last()?.seconds / period_s)
}

fn whole(plan: &Plan, results: &Results) -> Vec<(&'static str, Option<Estimate>)> {
    let scene = plan.scene();
    let mut all = Vec::new();
    if scene.interaction.is_some() {
        all.push((COLLISIONS, per_rod_and_period(plan, results)));
    }
    let observed = |of| scene.output.observables.contains(&of);
    if observed(Observable::OrientationTensor) && observed(Observable::OrientationTensor4) {
        let g = plan.flow().shear_rate_per_s().filter(|_| !plan.runs(Stage::AspectRatios));
        let (r_e, replicas) = (scene.particles.aspect_ratio, scene.ensemble.replicas);
        let c_i = g.and_then(|g| coefficients::of_run(results, r_e, g, replicas));
        all.push((C_I, c_i));
        if scene.interaction.is_some() {
            let each = results.elapsed.last().and_then(|end| per_rod(plan, results, end.strain));
            all.push((C_I_PER_COLLISION, c_i.zip(each).and_then(|(c_i, each)| c_i.over(each))));
        }
    }
    all
}

type Cells = Vec<Option<f64>>;

fn cells(estimate: Option<Estimate>) -> [Option<f64>; 2] {
    [estimate.map(|estimate| estimate.value), estimate.and_then(|estimate| estimate.se)]
}

fn time_cells(plan: &Plan, results: &Results, time: f64) -> Cells {
    tables::time_cells(results, time, plan.elapsed(time)).into_iter().map(Some).collect()
}

fn head(results: &Results, kinds: &[&str], all: &All) -> Vec<String> {
    let time = tables::time_names(results).iter().map(|name| (*name).to_owned());
    let of_channel = |(column, _): &(&Column, Derived)| {
        let name = column.name.clone();
        kinds.iter().map(move |kind| format!("{name}_{kind}")).collect::<Vec<_>>()
    };
    time.chain(all.channels.iter().flat_map(of_channel)).collect()
}

fn extremes(plan: &Plan, results: &Results, all: &All) -> Result<String, String> {
    let kinds = OF_EXTREMES.map(|kind| [kind.to_owned(), format!("{kind}_se")]).concat();
    let mut header = head(results, &kinds.iter().map(String::as_str).collect::<Vec<_>>(), all);
    let times = tables::time_names(results).len();
    header.insert(times, format!("{}_se", results.time_name));
    let mut rows: Vec<(f64, Cells)> = Vec::new();
    for (k, (_, derived)) in all.channels.iter().enumerate() {
        for Extreme { is_maximum, time, value, amplitude } in derived.extremes.iter().take(MOST) {
            let mut row: Cells = time_cells(plan, results, time.value);
            row.push(time.se);
            row.resize(header.len(), None);
            let own = &mut row[times + 1 + 6 * k..];
            let place = if *is_maximum { 0 } else { 2 };
            own[place..place + 2].copy_from_slice(&cells(Some(*value)));
            own[4..6].copy_from_slice(&cells(*amplitude));
            rows.push((time.value, row));
        }
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    table(header, rows.into_iter().map(|(_, row)| row))
}

fn scalars(plan: &Plan, results: &Results, all: &All) -> Result<String, String> {
    let kinds = ["damping_rate", "damping_rate_se", "damping_from", "damping_to", "steady", "steady_se", "steady_from"];
    let last = results.times.last().copied().unwrap_or(0.0);
    let mut row = time_cells(plan, results, last);
    for (_, derived) in &all.channels {
        row.extend(cells(derived.damping.map(|damping| damping.rate)));
        row.extend([0, 1].map(|end| derived.damping.map(|damping| damping.between[end])));
        row.extend(cells(derived.steady.map(|steady| steady.value)));
        row.push(derived.steady.map(|steady| steady.from));
    }
    let mut header = head(results, &kinds, all);
    for (name, value) in &all.whole {
        header.extend([(*name).to_owned(), format!("{name}_se")]);
        row.extend(cells(*value));
    }
    table(header, [row])
}

/// The CSV text; undefined values are empty.
fn table(header: Vec<String>, rows: impl IntoIterator<Item = Cells>) -> Result<String, String> {
    csv::written(|table| {
        table.write_record(header)?;
        rows.into_iter().try_for_each(|row| table.serialize(row))
    })
}

/// The largest number of bytes of both tables.
pub(super) fn most_bytes(plan: &Plan) -> u64 {
    let observables = plan.observables().into_iter().filter(|observable| !observable.is_density());
    let channels: usize = observables.map(|observable| observable.width()).sum();
    let rows = plan.outputs().min(MOST) * channels;
    ((rows + 1) * (6 * channels + 10 * tables::NUMBER) + (14 * channels + 12) * tables::NUMBER) as u64
}

/// The unit of a rate of decay in a column of times.
pub(super) fn per(time_name: &str) -> &'static str {
    match time_name {
        "t_over_T" => "per T",
        "time_s" => "per s",
        _ => "per unit of strain",
    }
}

/// A line for the terminal on each channel whose oscillation decays or that is steady, on each reason why others have
/// no rate, and on C_I where it is known.
pub(super) fn summary(plan: &Plan, results: &Results, all: &All) -> String {
    let replicas = plan.scene().ensemble.replicas;
    let number =
        |estimate: Estimate, decimals: usize| tables::with_error(estimate.value, estimate.se.unwrap_or(0.0), decimals);
    // Free rods of one size do not damp: what outputs between extremes miss would look like a rate.
    let least = if plan.runs(Stage::Contacts) { 1e-3 } else { 1e-2 };
    let mut text = String::new();
    let mut without: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for (column, derived) in all.channels.iter().filter(|(column, _)| tables::is_bounded(&column.name)) {
        let varies = column.se.iter().any(|se| *se > 0.0);
        if let Some(why) = derived.no_rate(replicas).filter(|_| varies && all.sparse.is_none()) {
            without.entry(why).or_default().push(&column.name);
        }
        let decays = |rate: &Estimate| rate.value.abs() > (3.0 * rate.se.unwrap_or(0.0)).max(least);
        let rate = derived.damping.filter(|damping| decays(&damping.rate)).map(|damping| {
            let law = if damping.is_exponential {
                "amplitude ∝ exp(−λt)"
            } else {
                "amplitude does not fall exponentially; on average exp(−λt)"
            };
            let [from, to] = damping.between.map(|time| (time * 1e2).round() / 1e2);
            format!("{law}, λ = {} {} from {from} to {to}", number(damping.rate, 3), per(results.time_name))
        });
        let steady = derived.steady.filter(|_| varies).map(|steady| {
            let from = (steady.from * 1e3).round() / 1e3;
            format!("steady from {from} on at {}", number(steady.value, 4))
        });
        let said: Vec<_> = [rate, steady].into_iter().flatten().collect();
        if !said.is_empty() {
            text += &format!("{}: {}\n", column.name, said.join("; "));
        }
    }
    if let Some(strain) = all.sparse {
        text += &format!(
            "no extremes, amplitudes and damping rates: outputs are up to {strain:.1} of strain apart, and a rod flips \
             within {FLIP}\n"
        );
    }
    text = without.into_iter().fold(text, |text, (why, names)| text + &format!("{}: {why}\n", names.join(", ")));
    // Without a word, blank errors would look like those of a single replica.
    if replicas > 1 && all.channels.iter().any(|(column, _)| column.without.is_empty()) {
        text += &format!(
            "what is derived has no standard errors: outputs times columns exceed {MOST_GROUPED}; fewer are needed\n"
        );
    }
    if plan.runs(Stage::Contacts) && results.collisions[0] == 0.0 {
        text += "no rods collided\n";
    }
    let Some((_, c_i)) = all.whole.iter().find(|(name, _)| *name == C_I) else { return text };
    if c_i.is_none() {
        return text + &format!("c_i is unknown: {}\n", lacks(C_I));
    }
    let known = |(name, value): &(&str, Option<Estimate>)| {
        let Estimate { value, se } = (*value)?;
        let small = || format!("{value:.2e}{}", se.map_or(String::new(), |se| format!(" ± {se:.1e}")));
        Some(format!("{name} = {}", if value.abs() < 0.01 { small() } else { number(Estimate { value, se }, 2) }))
    };
    let known: Vec<_> = all.whole.iter().filter_map(known).collect();
    let collides =
        if plan.runs(Stage::Contacts) { "; rods collide again in each step: more steps, more collisions" } else { "" };
    text + &format!("{} (c_i is of the second half, steady or not{collides})\n", known.join(", "))
}
