//! The first screen of the report: the verdict in parts, three pictures, and the cases to look at first.

use super::formats::{number, share};
use super::{CaseRow, Part, Report};
use crate::judge::accept::Verdict;
use crate::judge::case::Judges;
use crate::present::plot::{self, Figure};
use serde_json::{Value as Json, json};

/// What it means that the cases of a kind pass.
pub(super) fn means(judges: Judges) -> &'static str {
    match judges {
        Judges::Core => "The equations are solved right: closed forms, orders, invariants.",
        Judges::Program => "Whole runs are right: files, errors, statistics, refusals.",
        Judges::Integrator => "Integrators of one rod behave as theory says.",
        Judges::Oracle => "The oracles and statistics are right, and formulas that are wrong in the text at hand fail.",
        Judges::Interpretation => "Where the paper is open: what the alternatives change.",
        Judges::Statement => "What the paper says in words of its model’s results.",
        Judges::Measurement => "Validation: the model against experiments.",
    }
}

/// The verdict, then the sizes of the errors with their scope, and what is not known, a line each; of the cases that
/// this report has.
pub(super) fn sizes(report: &Report) -> Vec<String> {
    let error = |name: &str| {
        let row = report.cases.iter().find(|row| row.name == name && row.verdict == Verdict::Pass)?;
        row.worst().map(|line| number(line.error))
    };
    let summary = &report.summary;
    let red = summary.fail + summary.underpowered;
    let verdict = match red {
        0 => {
            let none = match summary.nodata {
                0 => String::new(),
                1 => "; 1 needs measured points".into(),
                nodata => format!("; {nodata} need measured points"),
            };
            format!("Verdict: {} of {} cases pass, none fails{none}.", summary.pass, report.cases.len())
        }
        _ => format!(
            "Verdict: {red} of {} cases are red: {} fail, {} under-powered.",
            report.cases.len(),
            summary.fail,
            summary.underpowered
        ),
    };
    let free = error("propagator-closed-form").map(|error| {
        format!(
            "Free rods: exact to {error} rad times max(r_e, 1/r_e)·(1 + t/T), against Jeffery's closed form in plane \
             shear."
        )
    });
    let colliding = error("naive-reference").map(|error| {
        format!(
            "Collisions: agree with an independent code of the same interpretation of the paper to {error} rod \
             lengths, over up to one period and with the same random numbers."
        )
    });
    let measured = report.summary.parts.iter().find(|part| part.judges == Judges::Measurement).map(|part| {
        let judged = part.cases - part.nodata;
        let mut of: Vec<_> = report.origin.points.iter().map(|stated| stated.short(80)).collect();
        of.dedup();
        let of = if of.is_empty() { String::new() } else { format!(": {}", of.join("; ")) };
        match judged {
            0 => "Experiments: none at hand; whether the model describes real suspensions is not shown.".into(),
            _ => format!("Experiments: {judged} of {} comparisons have points{of}.", part.cases),
        }
    });
    [Some(verdict), free, colliding, measured].into_iter().flatten().collect()
}

/// The cards, one for each part of the verdict.
pub(super) fn cards(report: &Report) -> Vec<Json> {
    let card = |part: &Part| {
        let has = |verdict| {
            let mut rows = report.cases.iter().filter(|row| row.judges == part.judges);
            rows.any(|row| row.verdict == verdict)
        };
        let worst = [Verdict::Fail, Verdict::Underpowered, Verdict::NoData].into_iter().find(|v| has(*v));
        json!({
            "tag": part.judges.tag(),
            "name": part.judges.title(),
            "count": count(part),
            "class": worst.unwrap_or(Verdict::Pass),
        })
    };
    report.summary.parts.iter().map(card).collect()
}

fn count(part: &Part) -> String {
    let passed = format!("{} of {}", part.pass, part.cases);
    match part.nodata {
        0 => passed,
        none if none == part.cases => format!("{passed}, no data"),
        none => format!("{passed}, no data for {none}"),
    }
}

/// The pictures of the first screen, if they exist: what a larger concentration changes in the paper's Fig. 4,
/// error against run time, and one map of stability.
pub(super) fn thumbnails(report: &Report) -> Result<Vec<Json>, String> {
    // Three pictures are side by side and must be legible: they are drawn narrow, with large letters, and the one of
    // most methods wider.
    let wanted = [
        ("fig4-differences", Some((270, 400))),
        ("work-precision-re11.6", Some((430, 440))),
        ("stability-steps", Some((270, 0))),
    ];
    let found = |(name, size)| {
        let figure = report.sections.figures().find(|figure| figure.name == name)?;
        Some((figure, Figure { size, ..figure.figure.clone() }))
    };
    (wanted.into_iter().filter_map(found))
        .map(|(figure, mut small)| {
            if let Some(grid) = &mut small.grid {
                // The map with a line of theory, and with more than one kind of error.
                let shown = grid.maps.iter().position(|map| map.title == "implicit midpoint in p");
                grid.maps = grid.maps.drain(..).skip(shown.unwrap_or(0)).take(1).collect();
            }
            Ok(json!({
                "name": figure.name,
                "svg": plot::svg(&small)?,
                "narrow": plot::narrow(&small)?,
                "map": small.grid.is_some(),
            }))
        })
        .collect()
}

/// The passing cases that use the largest shares of their tolerance, with these shares.
pub(super) fn closest(report: &Report) -> Vec<Json> {
    const SHOWN: usize = 6;
    let passing = report.cases.iter().filter(|row| row.verdict == Verdict::Pass);
    let mut used: Vec<_> = passing.filter_map(|row| Some((row.worst()?.used, row))).collect();
    used.sort_by(|a, b| b.0.total_cmp(&a.0));
    let closest = |(used, row): (f64, &CaseRow)| json!({ "name": row.name, "used": share(used) });
    used.into_iter().take(SHOWN).map(closest).collect()
}
