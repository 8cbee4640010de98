//! The table of equations and the cases that test them, made from the registry: for the report and for the book.

use crate::cases;
use crate::cases::equations;
use crate::present::markup::{self, cites_figure};
use crate::present::report::{ReportEquation, Sections};
use std::ops::RangeInclusive;

/// The equations and the cases that test them, as a page of the book.
pub fn markdown() -> String {
    let equation = |equation: ReportEquation| {
        let cases = equation.cases.join("`, `");
        format!("- **{}**, {}: `{cases}`\n", equation.number, markup::markdown(&equation.says))
    };
    format!(
        "# Equations and their cases\n\nMade from the registry of {} cases. `shearbed validate --list` prints what \
         each case claims; the report shows its evidence and the code of each equation.\n\n{}",
        cases::all().len(),
        equations().into_iter().map(equation).collect::<String>(),
    )
}

/// Adds to each figure of the paper the names of the cases that cite it. Other figures have names already.
pub fn name_judges(sections: &mut Sections) {
    let about: Vec<_> = cases::all().into_iter().map(|case| case.about).collect();
    for figure in sections.figures_mut().filter(|figure| figure.cases.is_empty()) {
        let shown: Vec<_> = FIGURES.filter(|number| cites_figure(&figure.source, *number)).collect();
        let judges = about.iter().filter(|about| shown.iter().any(|number| cites_figure(about.source, *number)));
        figure.cases = judges.map(|about| about.name.into()).collect();
    }
}

const FIGURES: RangeInclusive<u32> = 1..=12;

/// Every equation with the cases of the registry that test it.
pub fn equations() -> Vec<ReportEquation> {
    let about: Vec<_> = cases::all().into_iter().map(|case| case.about).collect();
    let equation = |equation: &equations::Equation| ReportEquation {
        number: equation.number.into(),
        says: equation.says.into(),
        code: equation.code.iter().map(|item| (*item).into()).collect(),
        cases: (about.iter())
            .filter(|about| about.equations.iter().any(|number| number == equation.number))
            .map(|about| about.name.into())
            .collect(),
    };
    equations::ALL.iter().map(equation).collect()
}
