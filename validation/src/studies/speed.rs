//! The speed of the core against the naive reference and against the limits of the machine, all measured in one run.

mod measure;

use super::*;
use measure::{Amount, Check, Speed, Step, Target, measure};

/// Seconds of one core for a step of a rod: 26 to 58 ns, for 10² to 10⁶ rods (docs/src/developer/performance.md).
pub const SECONDS_PER_ROD_AND_STEP: f64 = 40e-9;

/// Seconds for an output of a free rod: 2 to 5 ns.
pub const SECONDS_PER_OUTPUT: f64 = 4e-9;

/// Seconds to draw a rod.
pub const SECONDS_PER_DRAW: f64 = 40e-9;

/// The time of a step of one rod by an integrator, in s, on average over those of the tables.
pub const SECONDS_PER_INTEGRATOR_STEP: f64 = 80e-9;

/// The study of the core's speed, with targets.
pub const STUDY: Study = Study {
    name: "speed",
    title: "Speed of the core",
    question: "How fast is the core against the naive reference and against what the machine can do?",
    cases: &["naive-reference"],
    command: "cargo run --release -- bench --case speed",
    parts: &["speed"],
    shared: false,
    run,
};

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let speed = measure(request.effort.pick(Amount::QUICK, Amount::FULL))?;
    let [rods, concentration] = figures(&speed);
    let exhibits = vec![Exhibit::both(rods, table(&speed)), concentration.into()];
    Ok(Some(Findings::new(answer(&speed.checks), exhibits, [("speed.json", build::json(&speed)?)])))
}

fn table(speed: &Speed) -> ReportTable {
    let target = |check: &Check| match check.target {
        Target::AtMost(most) => format!("≤ {most} {}", check.unit),
        Target::AtLeast(least) => format!("≥ {least} {}", check.unit),
    };
    ReportTable::new(
        ["speed", "Speed: targets and what was measured"],
        format!(
            "The least of repeated measurements, side by side in one run on a machine with {} cores, which others may \
             have used too. No case of the gate is timed: its counters of work are. `shearbed bench --case speed` \
             measures longer.",
            speed.threads
        ),
        &speed.checks,
        vec![
            words("what", |check: &Check| check.what),
            words("target", target),
            words("measured", |check: &Check| format!("{:.3} {}", check.measured, check.unit)),
            number("measured / target", decimals(2), |check: &Check| check.over_target()),
            words("met", |check: &Check| if check.met() { "yes" } else { "no" }),
            words("behind it", |check: &Check| check.behind.clone()),
        ],
    )
}

/// The time of a step against the number of rods and against their concentration.
fn figures(speed: &Speed) -> [ReportFigure; 2] {
    let rods = |time: fn(&Step) -> Option<f64>| move |step: &Step| (step.rods as f64, time(step).unwrap_or(f64::NAN));
    let axes = |x| [x, "log time per rod and step (ns)"];
    let by_rods = ReportFigure::new(
        ["speed-rods", "Time of a step against the number of rods, 50 per cm³"],
        "One core. Up to 256 rods the core looks at all pairs; beyond, it sorts the rods into cells.",
        axes("log rods"),
    )
    .curves([
        Curve::of("core", &speed.by_rods, rods(|step| Some(step.core_ns))),
        Curve::of("naive reference", &speed.by_rods, rods(|step| step.naive_ns)),
    ]);
    let by_concentration = ReportFigure::new(
        ["speed-concentration", "Time of a step against the concentration, 1000 rods"],
        "One core. In dilute suspensions few rods are near each other; in dense ones most rods have a candidate, and \
         contacts take the time.",
        axes("log n (per cm³)"),
    )
    .curves([Curve::of("core", &speed.by_concentration, |step| (step.concentration_per_cm3, step.core_ns))]);
    [by_rods, by_concentration].map(|figure| figure.judged("eqs 5–14", &["naive-reference"]))
}

/// The study's answer: how many of the checks meet their target.
fn answer(checks: &[Check]) -> String {
    let (met, all) = (checks.iter().filter(|check| check.met()).count(), checks.len());
    format!("{met} of {all} targets are met on this machine; times depend on what else runs on it.")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(measured: f64, target: Target) -> Check {
        Check { what: "", measured, target, unit: "", behind: String::new() }
    }

    #[test]
    fn the_answer_counts_the_checks_each_by_a_bound_from_its_own_side() {
        let checks = [
            check(3.0, Target::AtMost(3.0)),
            check(3.1, Target::AtMost(3.0)),
            check(f64::NAN, Target::AtMost(3.0)),
            check(8.0, Target::AtLeast(8.0)),
            check(7.9, Target::AtLeast(8.0)),
        ];
        assert_eq!(checks.each_ref().map(Check::met), [true, false, false, true, false]);
        assert!(answer(&checks).starts_with("2 of 5 targets are met "));
    }
}
