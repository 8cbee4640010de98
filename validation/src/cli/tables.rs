//! Results as tables: CSV for files, a short one for the terminal.

use shearbed::ensemble::{Channel, Series};
use shearbed::{Observable, Results};

/// An observable's file: the time, also in s and as strain, then each channel with its standard error. Every number is
/// the shortest text that reads back as the same bits.
pub(super) fn csv(results: &Results, series: &Series) -> Result<String, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let times = times(results);
    let mut header: Vec<_> = times.iter().map(|(name, _)| (*name).to_owned()).collect();
    for channel in &series.channels {
        header.extend([channel.name.clone(), format!("{}_se", channel.name)]);
    }
    writer.write_record(header).map_err(|error| error.to_string())?;
    for (k, time) in results.times.iter().enumerate() {
        let times = times.iter().map(|(_, unit)| time * unit);
        let values = series
            .channels
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
fn shown(series: &Series) -> &[Channel] {
    match (series.observable, series.channels.as_slice()) {
        (Observable::OrbitConstant, [mean, ..]) => std::slice::from_ref(mean),
        (_, all) => all,
    }
}
