//! Exact curves over those of runs.

use crate::derived::FLIP;
use crate::pictures::MANY;
use crate::{Failure, scene};
use shearbed::Plan;
use shearbed::motion::Propagator;
use shearbed_validation::files::bounded;
use shearbed_validation::files::csv::Table;
use shearbed_validation::files::text::Shown;
use shearbed_validation::present::plot::{Curve, REFERENCE, names};
use std::io::BufReader;
use std::path::Path;

use super::folders::Run;
use super::table::MOST_ROWS;

/// The channels in a table of `shearbed reference` that has the column `time`, each against it; warns if the table is
/// of another shear rate or period than the run.
pub(super) fn curves(path: &Path, time: &str, channels: &[String], run: &Run) -> Result<Vec<Curve>, Failure> {
    let at = |what: String| Failure::Input(format!("--reference {}: {what}", path.shown()));
    let file = bounded::open(path).map_err(|error| at(format!("cannot be read: {error}")))?;
    let mut table = Table::new(path, BufReader::new(file))?;
    let known = table.names().join(", ");
    let place = |name: &str| {
        table.place(name).ok_or_else(|| at(format!("has no column {name}, which the picture needs; it has {known}")))
    };
    let x = place(time)?;
    if let Some(u) = channels.iter().map(|channel| format!("{channel}_u")).find(|u| table.place(u).is_some()) {
        return Err(at(format!("has {u}, so that its points are measured: they go to --data")));
    }
    let y = channels.iter().map(|channel| place(channel)).collect::<Result<Vec<_>, _>>()?;
    let mut curves: Vec<Curve> = (channels.iter())
        .map(|channel| Curve { label: names::channel(channel) + REFERENCE, ..Curve::default() })
        .collect();
    let of_time = ["t_over_T", "strain"].map(|name| table.place(name));
    let (mut rows, mut last) = (0, None);
    let (mut before, mut apart) = (f64::NAN, 0f64);
    while let Some(row) = table.next_row()? {
        rows += 1;
        if rows > MOST_ROWS {
            return Err(row.error(format!("more than {MOST_ROWS} rows for one picture; fewer are allowed")).into());
        }
        if let [Some(t_over_t), Some(strain)] = of_time {
            // Not every motion has a period.
            let t_over_t = if row.is_blank(t_over_t) { f64::NAN } else { row.finite(t_over_t)? };
            let strain = row.finite(strain)?;
            // Of the first row there is none: `max` takes the other number.
            (apart, before) = (apart.max((strain - before).abs()), strain);
            last = Some([row.finite(x)?, t_over_t, strain]);
        }
        for (curve, y) in curves.iter_mut().zip(&y) {
            curve.x.push(row.finite(x)?);
            curve.y.push(row.finite(*y)?);
        }
    }
    let mut warnings = last.map(|last| differences(time, last, run)).unwrap_or_default();
    if rows <= MANY && apart > FLIP {
        warnings.push(format!(
            "its rows are up to {apart:.1} of strain apart, and a rod flips within {FLIP}: its lines cut peaks"
        ));
    }
    scene::warn(&format!("--reference {}", path.shown()), &warnings);
    Ok(curves)
}

/// How the flow and the rods of a table differ from those of the run; `time` is the column of times, then come that
/// time, t/T and the strain of the last row.
fn differences(time: &str, [at, t_over_t, strain]: [f64; 3], run: &Run) -> Vec<String> {
    let Ok(plan) = Plan::new(&run.scene) else { return Vec::new() };
    let other = |own: f64, of_run: f64| own.is_finite() && (own / of_run - 1.0).abs() > 1e-9;
    let one = plan.elapsed(1.0);
    let (named, of_run) = (run.dir.shown(), at * one.strain / one.seconds);
    let rate = (time == "time_s" && other(strain, of_run)).then(|| {
        format!("at {at} s its strain is {strain:.3}, in the run {named} it is {of_run:.3}: the shear rate is another")
    });
    let period_s = Propagator::new(plan.flow(), run.scene.particles.aspect_ratio).period_s();
    let period = period_s.map(|period_s| period_s * one.strain / one.seconds);
    let turn = period.filter(|period| other(strain / t_over_t, *period)).map(|period| {
        let own = strain / t_over_t;
        format!("its rods turn once in a strain of {own:.3}, those of the run {named} in {period:.3}: r_e is another")
    });
    rate.into_iter().chain(turn).collect()
}
