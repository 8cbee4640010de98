//! What was measured, beside the targets.

use super::{Check, Speed, Target};
use crate::present::table::{ReportTable, number, words};

/// The targets.
pub fn table(speed: &Speed) -> ReportTable {
    let target = |check: &&Check| match check.target {
        Target::AtMost(most) => format!("≤ {most} {}", check.unit),
        Target::AtLeast(least) => format!("≥ {least} {}", check.unit),
        Target::None => "–".into(),
    };
    let met = |check: &&Check| match (check.target, check.met()) {
        (Target::None, _) => "–",
        (_, true) => "yes",
        (_, false) => "no",
    };
    ReportTable::new(
        ["speed", "Speed: targets and what was measured"],
        format!(
            "The least of repeated measurements, side by side in one run on a machine with {} cores, which others may \
             have used too. No case of the gate is timed: its counters of work are. `shearbed bench --case speed` measures longer.",
            speed.threads
        ),
        &speed.checks,
        vec![
            words("what", |check: &&Check| check.what),
            words("target", target),
            words("measured", |check: &&Check| format!("{:.3} {}", check.measured, check.unit)),
            number("measured / target", |ratio| format!("{ratio:.2}"), |check: &&Check| check.over_target()),
            words("met", met),
            words("behind it", |check: &&Check| check.behind.as_str()),
        ],
    )
}
