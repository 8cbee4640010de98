//! Results as tables: CSV for files, a short one for the terminal.

use shearbed::ensemble::{Column, Series};
use shearbed::{Observable, Plan, Results};

/// An observable's file: the time, also in s and as strain, then each channel with its standard error. Every number is
/// the shortest text that reads back as the same bits.
pub(super) fn csv(results: &Results, series: &Series) -> Result<String, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let times = times(results);
    let mut header: Vec<_> = times.iter().map(|(name, _)| (*name).to_owned()).collect();
    for channel in &series.columns {
        header.extend([channel.name.clone(), format!("{}_se", channel.name)]);
    }
    writer.write_record(header).map_err(|error| error.to_string())?;
    for (k, time) in results.times.iter().enumerate() {
        let times = times.iter().map(|(_, unit)| time * unit);
        let values = series
            .columns
            .iter()
            .flat_map(|channel| [channel.mean[k], channel.se[k]]);
        let row: Vec<f64> = times.chain(values).collect();
        writer.serialize(row).map_err(|error| error.to_string())?;
    }
    let bytes = writer.into_inner().map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

/// The columns of the time, the scene's own first, and what a unit of that is in each.
pub(super) fn times(results: &Results) -> Vec<(&'static str, f64)> {
    let all = [
        (results.time_name, 1.0),
        ("time_s", results.unit.seconds),
        ("strain", results.unit.strain),
    ];
    let columns = if results.time_name == "strain" { 2 } else { 3 };
    all[..columns].to_vec()
}

/// The most bytes of the tables and of the pictures of a plan's results, each observable's.
fn most_of_each(plan: &Plan) -> impl Iterator<Item = (u64, u64)> {
    // A number is at most 24 letters long with its comma, as -2.2250738585072014e-308; a picture has a curve and the two
    // sides of its band, each point of two numbers of seven digits.
    const NUMBER: u64 = 24;
    const POINT: u64 = 3 * 16;
    let rows = plan.outputs() as u64 + 1;
    plan.observables().into_iter().map(move |observable| {
        // Of a density only the ends are drawn.
        let drawn = if observable == Observable::OrbitConstant {
            1
        } else {
            observable.width()
        };
        let table = rows * NUMBER * (3 + 2 * observable.width() as u64);
        (table, rows * POINT * drawn as u64)
    })
}

/// The most bytes that the tables and pictures of a plan's results take.
pub(super) fn most_bytes(plan: &Plan) -> u64 {
    most_of_each(plan).map(|(table, picture)| table + picture).sum()
}

/// The most memory that the results of a plan, their tables and their pictures take.
pub(super) fn most_memory(plan: &Plan) -> u64 {
    // Means and standard errors.
    let channels: usize = plan.observables().iter().map(|o| o.width()).sum();
    let results = plan.outputs() as u64 * 16 * channels as u64;
    // A text that grows has twice its room; a point that is drawn is held as numbers, placed and in a path, about eight
    // times the length of its text.
    let (table, picture) = most_of_each(plan).fold((0, 0), |(a, b), (c, d)| (a.max(c), b.max(d)));
    results + most_bytes(plan) + table.max(8 * picture)
}

/// The most lines of a table for the terminal.
const MOST_LINES: f64 = 24.0;

/// Each observable's means at whole and half periods, or at whole strains; at fewer where they are many.
pub(super) fn summary(results: &Results) -> String {
    let last = results.times.last().copied().unwrap_or(0.0);
    let (name, mut every) = match results.time_name {
        "strain" => ("strain", 1.0),
        _ => ("t/T", 0.5),
    };
    while last / every > MOST_LINES {
        every *= 2.0;
    }
    let mut text = String::new();
    for series in &results.series {
        let channels = shown(series);
        let names = channels
            .iter()
            .map(|channel| format!("  {:>7}{:9}", channel.name, ""));
        text.push_str(format!("{name:>8}{}", names.collect::<String>()).trim_end());
        for (k, time) in results
            .times
            .iter()
            .enumerate()
            .filter(|(_, time)| *time % every == 0.0)
        {
            text.push_str(&format!("\n{time:>8.1}"));
            for channel in channels {
                text.push_str(&format!("  {:>7.4} ± {:.4}", channel.mean[k], channel.se[k]));
            }
        }
        text.push_str("\n\n");
    }
    text
}

/// Every channel but the many of a density.
fn shown(series: &Series) -> &[Column] {
    match (series.observable, series.columns.as_slice()) {
        (Observable::OrbitConstant, [mean, ..]) => std::slice::from_ref(mean),
        (_, all) => all,
    }
}
