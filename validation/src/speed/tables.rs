//! What was measured, beside the targets.

use super::{Speed, Target};
use crate::report::ReportTable;

/// The targets.
pub fn table(speed: &Speed) -> ReportTable {
    let row = |check: &super::Check| {
        let (target, verdict) = match check.target {
            Target::AtMost(most) => (format!("≤ {most} {}", check.unit), check.met()),
            Target::AtLeast(least) => (format!("≥ {least} {}", check.unit), check.met()),
            Target::None => ("–".into(), true),
        };
        let verdict = match (check.target, verdict) {
            (Target::None, _) => "–",
            (_, true) => "yes",
            (_, false) => "no",
        };
        vec![
            check.what.into(),
            target,
            format!("{:.3} {}", check.measured, check.unit),
            check
                .over_target()
                .map_or("–".into(), |ratio| format!("{ratio:.2}")),
            verdict.into(),
            check.behind.clone(),
        ]
    };
    ReportTable {
        name: "speed".into(),
        title: "Speed: targets and what was measured".into(),
        caption: format!(
            "The least of repeated measurements, side by side in one run on a machine with {} cores, which others may \
             have used too. No case of the gate is timed: its counters of work are. `shearbed bench --case speed` measures longer.",
            speed.threads
        ),
        columns: [
            "what",
            "target",
            "measured",
            "measured / target",
            "met",
            "behind it",
        ]
        .map(String::from)
        .into(),
        rows: speed.checks.iter().map(row).collect(),
    }
}
