//! The catalogue of cases and equations, made from the registry: for the report and for `docs/catalogue.md`.

use crate::cases;
use crate::cases::equations;
use crate::judge::case::About;
use crate::present::markup::cites_figure;
use crate::present::report::{ReportEquation, Sections, equation_table};
use crate::present::table::{ReportTable, words};
use std::ops::RangeInclusive;

/// The catalogue as Markdown.
pub fn markdown() -> String {
    let about: Vec<_> = cases::all().into_iter().map(|case| case.about).collect();
    let table = ReportTable::new(
        ["cases", "Cases"],
        "",
        &about,
        vec![
            words("case", |about: &&About| format!("`{}`", about.name)),
            words("judges", |about: &&About| about.judges.name()),
            words("claim", |about: &&About| about.claim),
            words("source", |about: &&About| about.source),
        ],
    );
    format!(
        "# The catalogue\n\nMade from the registry; `UPDATE_DOCS=1 cargo test -p shearbed-suite --test docs` makes \
         it anew.\n\n## Cases\n\n{}\n{} cases; `docs/strength.md` has their probabilities of a false alarm and of a miss.\n\n\
         ## Equations\n\nCode: a file of `src/`, or the folder of that name, and the item in it.\n\n{}",
        table.cells_as_markdown(),
        about.len(),
        equation_table(&equations()).cells_as_markdown(),
    )
}

/// Names beside each figure of the paper the cases that cite it. Other figures name theirs themselves.
pub fn name_judges(sections: &mut Sections) {
    let about: Vec<_> = cases::all().into_iter().map(|case| case.about).collect();
    for figure in sections.figures_mut().filter(|figure| figure.cases.is_empty()) {
        let shown: Vec<_> = FIGURES.filter(|number| cites_figure(&figure.source, *number)).collect();
        let judges =
            about.iter().filter(|about| shown.iter().any(|number| cites_figure(about.source, *number)));
        figure.cases = judges.map(|about| about.name.into()).collect();
    }
}

/// Those of the paper.
const FIGURES: RangeInclusive<u32> = 1..=12;

/// Every equation with the cases of the registry that test it.
pub fn equations() -> Vec<ReportEquation> {
    let about: Vec<_> = cases::all().into_iter().map(|case| case.about).collect();
    let equation = |equation: &equations::Equation| ReportEquation {
        number: equation.number.into(),
        says: equation.says.into(),
        code: equation.code.iter().map(|item| (*item).into()).collect(),
        cases: (about.iter())
            .filter(|about| about.equations.contains(&equation.number))
            .map(|about| about.name.into())
            .collect(),
    };
    equations::ALL.iter().map(equation).collect()
}
