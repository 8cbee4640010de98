//! The longest steps beside their theory, as tables.

use super::limits::{Ladder, Limit, Property, bisect, holds};
use super::maps::ratio;
use super::theory::THEORIES;
use crate::present::table::{ReportTable, of_words};
use crate::studies::integrators::{Integrator, Theory};

/// The aspect ratios at which limits are sought.
pub const LIMIT_RATIOS: [f64; 9] = [1.01, 1.5, 2.0, 2.5, 3.0, 11.6, 100.0, 1e4, 1e5];

/// The steps GΔt tried for what one step decides.
pub const ONE_STEP: Ladder = Ladder { least: 0.1, most: 1e3, factor: 1.1 };

/// The steps GΔt tried for what ten periods decide.
pub const TEN_PERIODS: Ladder = Ladder { least: 0.02, most: 20.0, factor: 1.25 };

/// A table for each property.
pub fn limits(subjects: &[Box<dyn Integrator>]) -> Vec<ReportTable> {
    let one = |name, title, caption: &str, property| {
        limit_table(name, title, caption, property, &LIMIT_RATIOS, ONE_STEP, subjects)
    };
    let ten = |name, title, caption: &str, property| {
        limit_table(name, title, caption, property, &LIMIT_RATIOS[..7], TEN_PERIODS, subjects)
    };
    vec![
        one(
            "step-limit-order",
            "The longest step GΔt without overtaking",
            "Of 512 rods in the plane of shear none overtakes the next in a step.",
            Property::Order,
        ),
        one(
            "step-limit-turning",
            "The longest step GΔt with which every rod turns",
            "Of 512 rods in the plane of shear each turns forward in a step, by less than half a turn; half a turn is rest. \
             Exact motion has half a period.",
            Property::Turning,
        ),
        one(
            "step-limit-side",
            "The longest step GΔt with which every rod stays on its side of the plane of shear",
            "p_3 = 10⁻⁹ keeps its sign in a step.",
            Property::Side,
        ),
        one(
            "step-limit-solvable",
            "The longest step GΔt that can be taken",
            "From directions over the whole sphere the result is finite.",
            Property::Solvable,
        ),
        ten(
            "step-limit-length",
            "The longest step GΔt with a bounded length",
            "|p| < 1.5 after ten periods in the plane of shear. The ladder's factor is 1.25: narrower gaps are not seen.",
            Property::Length,
        ),
        ten(
            "step-limit-orbit",
            "The longest step GΔt that keeps the orbit",
            "C_b within 0.1 of its start after ten periods. The ladder's factor is 1.25: narrower gaps are not seen. There is \
             no closed form.",
            Property::Orbit,
        ),
    ]
}

fn limit_table(
    name: &str,
    title: &str,
    caption: &str,
    property: Property,
    ratios: &[f64],
    ladder: Ladder,
    subjects: &[Box<dyn Integrator>],
) -> ReportTable {
    let stepped = (subjects.iter()).filter(|subject| matches!(subject.theory(), Theory::Order(_)));
    let mut rows = Vec::new();
    for subject in stepped {
        let search = |r: &f64| bisect(ladder, |h| holds(subject.as_ref(), property, *r, h));
        let found: Vec<_> = ratios.iter().map(search).collect();
        if found.iter().all(|limit| matches!(limit, Limit::Beyond(_))) {
            continue;
        }
        rows.push([vec![subject.name().into()], found.into_iter().map(text).collect()].concat());
        let theory = THEORIES.iter().find(|theory| theory.0 == subject.name() && theory.1 == property);
        if let Some((_, _, theory)) = theory {
            let expected = |r: &f64| match theory(*r) {
                limit if limit.is_finite() => format!("{limit:.4}"),
                _ => "none".into(),
            };
            rows.push([vec!["– by theory".into()], ratios.iter().map(expected).collect()].concat());
        }
    }
    let columns = ratios.iter().map(|r| format!("r_e = {}", ratio(*r)));
    let columns: Vec<_> = std::iter::once("subject".to_owned()).chain(columns).collect();
    of_words(
        name,
        title,
        &format!("{caption} Fixed-step subjects that are not listed have no limit up to {:.0}.", ladder.most),
        &columns,
        rows,
    )
}

fn text(limit: Limit) -> String {
    match limit {
        Limit::At(strain) => format!("{strain:.4}"),
        Limit::Beyond(strain) => format!("> {strain:.0}"),
        Limit::Below(strain) => format!("< {strain}"),
    }
}
