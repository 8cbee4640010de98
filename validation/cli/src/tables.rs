//! Results as tables: CSV for files, and a short one for the terminal.

use super::derived;
use shearbed::observable::Channel;
use shearbed::plan::Elapsed;
use shearbed::run::ensemble::{Column, Series};
use shearbed::{Plan, Results};
use shearbed_validation::files::csv::written;

/// The CSV file of an observable: the time, also in s and as strain, then each channel with its standard error. Every
/// number is the shortest text that reads back as the same bits.
pub(super) fn csv(results: &Results, series: &Series) -> Result<String, String> {
    let mut header: Vec<_> = time_names(results).iter().map(|name| (*name).to_owned()).collect();
    for channel in &series.columns {
        header.extend([channel.name.clone(), format!("{}_se", channel.name)]);
    }
    let row = |(k, (time, elapsed)): (usize, (&f64, &Elapsed))| -> Vec<f64> {
        let values = series.columns.iter().flat_map(|channel| [channel.mean[k], channel.se[k]]);
        time_cells(results, *time, *elapsed).into_iter().chain(values).collect()
    };
    written(|table| {
        table.write_record(header)?;
        results.times.iter().zip(&results.elapsed).enumerate().try_for_each(|output| table.serialize(row(output)))
    })
}

/// The names of the time columns, the scene's own time first.
pub(super) fn time_names(results: &Results) -> &'static [&'static str] {
    match results.time_name {
        "strain" => &["strain", "time_s"],
        "time_s" => &["time_s", "strain"],
        _ => &["t_over_T", "time_s", "strain"],
    }
}

pub(super) fn time_cells(results: &Results, time: f64, elapsed: Elapsed) -> Vec<f64> {
    let of_name = |name: &&str| match *name {
        name if name == results.time_name => time,
        "time_s" => elapsed.seconds,
        _ => elapsed.strain,
    };
    time_names(results).iter().map(of_name).collect()
}

/// A number is at most 24 letters long with its comma, as -2.2250738585072014e-308.
pub(super) const NUMBER: usize = 24;

/// The largest number of bytes of the table and of the pictures of each observable.
fn most_of_each(plan: &Plan) -> impl Iterator<Item = (u64, u64)> {
    // A picture has a curve and the two sides of its band, each point of two numbers of seven digits.
    const POINT: u64 = 3 * 16;
    let rows = plan.outputs() as u64 + 1;
    plan.observables().into_iter().map(move |observable| {
        // For a density only the mean is drawn, not its many bins.
        let drawn = if observable.is_density() { 1 } else { observable.width() };
        let table = rows * NUMBER as u64 * (3 + 2 * observable.width() as u64);
        (table, rows * POINT * drawn as u64)
    })
}

/// The largest number of bytes of the tables and pictures of a plan's results.
pub(super) fn most_bytes(plan: &Plan) -> u64 {
    most_of_each(plan).map(|(table, picture)| table + picture).sum::<u64>() + derived::most_bytes(plan)
}

/// The largest memory for the results of a plan, their tables and their pictures, in bytes.
pub(super) fn most_memory(plan: &Plan) -> u64 {
    // Means and standard errors, and the means without each of 16 groups of replicas.
    let channels: usize = plan.observables().iter().map(|o| o.width()).sum();
    let results = plan.outputs() as u64 * 18 * 8 * channels as u64;
    // A growing text may reserve twice its length; a drawn point is stored as numbers, as a place and in a path, about
    // eight times the length of its text.
    let (table, picture) = most_of_each(plan).fold((0, 0), |(a, b), (c, d)| (a.max(c), b.max(d)));
    results + most_bytes(plan) + table.max(8 * picture)
}

/// False for means that may be of any size, such as stresses in Pa, and their standard errors.
pub(super) fn is_bounded(column: &str) -> bool {
    let channel = Channel::named(column.strip_suffix("_se").unwrap_or(column));
    channel.is_none_or(|channel| channel.range().iter().all(|end| end.is_finite()))
}

/// A value of order 1 with its standard error, in so many decimals or as many as show the error; alone where that is
/// rounding or unknown.
pub(super) fn with_error(value: f64, se: f64, decimals: usize) -> String {
    if se < 1e-9 || se.is_nan() {
        return format!("{value:.decimals$}");
    }
    let decimals = (-se.log10().floor()).clamp(decimals as f64, 9.0) as usize;
    format!("{value:.decimals$} ± {se:.decimals$}")
}

/// A mean with its standard error.
fn mean(column: &Column, k: usize) -> String {
    let (mean, se) = (column.mean[k], column.se[k]);
    if is_bounded(&column.name) {
        return with_error(mean, se, 4);
    }
    // Values without bounds have a size of their own.
    if se > 0.0 { format!("{mean:.2e} ± {se:.2e}") } else { format!("{mean:.2e}") }
}

/// For each channel the first and the last mean, the least and the largest with their times, and a sparkline.
pub(super) fn summary(results: &Results) -> String {
    let name = match results.time_name {
        "t_over_T" => "t/T",
        "time_s" => "t in s",
        other => other,
    };
    let last = results.times.len().saturating_sub(1);
    let time = |k: usize| results.times.get(k).copied().unwrap_or(f64::NAN);
    let mut text = String::new();
    for series in &results.series {
        let longest = shown(series).iter().map(|channel| channel.name.len() + 1).max();
        let margin = longest.unwrap_or_default().max(7);
        let values = shown(series).iter().flat_map(|channel| [0, last].map(|k| mean(channel, k)));
        let width = values.map(|value| value.chars().count()).max().unwrap_or_default().max(16) + 2;
        text += &format!(
            "{:<margin$}{:<width$}{:<width$}{:<17}largest\n",
            "",
            format!("at {name} = {}", brief(time(0))),
            format!("at {name} = {}", brief(time(last))),
            "least"
        );
        for channel in shown(series) {
            let number = |x: f64| if is_bounded(&channel.name) { format!("{x:.4}") } else { format!("{x:.2e}") };
            let order = |a: &usize, b: &usize| channel.mean[*a].total_cmp(&channel.mean[*b]);
            let extreme = |k: Option<usize>| {
                k.map_or_else(String::new, |k| format!("{} at {}", number(channel.mean[k]), brief(time(k))))
            };
            let outputs = 0..channel.mean.len();
            text += &format!(
                "{:<margin$}{:<width$}{:<width$}{:<16} {}\n{:<margin$}{}\n",
                channel.name,
                mean(channel, 0),
                mean(channel, last),
                extreme(outputs.clone().min_by(order)),
                extreme(outputs.rev().max_by(order)),
                "",
                sparkline(&channel.mean)
            );
        }
        text.push('\n');
    }
    text
}

/// A time with three decimals at most, or in powers of ten where these would change it by half a per cent.
fn brief(time: f64) -> String {
    let rounded = (time * 1e3).round() / 1e3;
    if (rounded - time).abs() <= 5e-3 * time.abs() { rounded.to_string() } else { format!("{time:.3e}") }
}

/// The largest number of bars in a sparkline.
const WIDEST: usize = 72;

/// Means as bars of eight heights, from the least to the largest. If there are more means than bars, bars show in turn
/// the largest and the least of the means that they represent: a fast oscillation looks like a comb, and never like a
/// slow one or none.
fn sparkline(means: &[f64]) -> String {
    const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let bars = means.len().min(WIDEST);
    let of_bar = |k: usize| {
        let range = k * means.len() / bars..(k + 1) * means.len() / bars;
        let pick = if k.is_multiple_of(2) { f64::max } else { f64::min };
        means[range].iter().copied().reduce(pick).unwrap_or(f64::NAN)
    };
    let least = means.iter().copied().fold(f64::INFINITY, f64::min);
    let span = means.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least;
    let bar = |k: usize| match (of_bar(k) - least) / span {
        part if part.is_finite() => BARS[((8.0 * part) as usize).min(7)],
        _ => BARS[0],
    };
    (0..bars).map(bar).collect()
}

/// The columns for the summary: for a density only the first.
fn shown(series: &Series) -> &[Column] {
    match (series.observable.is_density(), series.columns.as_slice()) {
        (true, [mean, ..]) => std::slice::from_ref(mean),
        (_, all) => all,
    }
}
