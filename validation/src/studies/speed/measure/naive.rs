//! The core against the naive reference.

use super::{Check, Step, Target};

pub fn against_naive(by_rods: &[Step]) -> Vec<Check> {
    let at = |rods: usize| by_rods.iter().find(|step| step.rods == rods);
    let ratio = |what, rods, target| {
        let step = at(rods)?;
        let naive = step.naive_ns?;
        Some(Check {
            what,
            measured: naive / step.core_ns,
            target: Target::AtLeast(target),
            unit: "×",
            behind: format!("{:.1} ns and {naive:.0} ns per rod and step, one core", step.core_ns),
        })
    };
    let growth = at(100).zip(at(1_000_000)).map(|(few, many)| Check {
        what: "the cost per rod and step at 10⁶ rods over that at 10²",
        measured: many.core_ns / few.core_ns,
        target: Target::AtMost(3.0),
        unit: "×",
        behind: format!("{:.1} ns and {:.1} ns, one core", few.core_ns, many.core_ns),
    });
    [
        ratio("a step of 100 rods: the naive reference's time over the core's", 100, 8.0),
        ratio("a step of 10⁴ rods: the naive reference's time over the core's", 10_000, 300.0),
        growth,
    ]
    .into_iter()
    .flatten()
    .collect()
}
