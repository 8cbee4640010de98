//! The limits of a step against theory, as pictures.

use super::limit_tables::ONE_STEP;
use super::limits::{Limit, Property, bisect, holds};
use super::theory::THEORIES;
use crate::present::plot;
use crate::present::study::ReportFigure;
use crate::studies::integrators::{Integrator, Theory};

/// A picture for each property of which there is a theory.
pub fn figures(subjects: &[Box<dyn Integrator>]) -> Vec<ReportFigure> {
    vec![
        figure(
            "step-limit-order",
            "The longest step without overtaking",
            "euler-step-limit",
            Property::Order,
            subjects,
        ),
        figure(
            "step-limit-turning",
            "The longest step with which every rod turns",
            "step-limit-turning",
            Property::Turning,
            subjects,
        ),
        figure(
            "step-limit-side",
            "The longest step that keeps the side of the plane of shear",
            "step-limit-side",
            Property::Side,
            subjects,
        ),
    ]
}

fn figure(
    name: &str,
    title: &str,
    case: &str,
    property: Property,
    subjects: &[Box<dyn Integrator>],
) -> ReportFigure {
    let theories = THEORIES.iter().filter(|theory| theory.1 == property);
    let stepped = (subjects.iter()).filter(|subject| matches!(subject.theory(), Theory::Order(_)));
    ReportFigure {
        name: name.into(),
        figure: plot::Figure {
            title: format!("{title}: theory and bisection"),
            x_name: "aspect ratio r_e".into(),
            y_name: "longest step GΔt".into(),
            curves: theories
                .map(|(name, _, theory)| {
                    let x: Vec<f64> = (0..=200).map(|k| 1.01 * 1e4f64.powf(f64::from(k) / 200.0)).collect();
                    plot::Curve {
                        label: format!("{name}, theory"),
                        y: x.iter().map(|r| theory(*r)).collect(),
                        x,
                        half_band: None,
                    }
                })
                .collect(),
            points: stepped.map(|subject| measured(subject.as_ref(), property)).collect(),
            x_log: true,
            y_log: true,
            x_span: Some((1.0, 1e4)),
            ..Default::default()
        },
        caption: "Points by bisection between 512 rods; the numbers are in the table of the same name. A point that is \
                  missing has no limit up to GΔt = 941. Projected RK4 lies on RK4 in p, and in the plane of shear RKMK4 on RK4 in \
                  angles."
            .into(),
        source: "A.1 to A.3".into(),
        cases: vec![case.into()],
    }
}

fn measured(subject: &dyn Integrator, property: Property) -> plot::Points {
    let x: Vec<f64> = vec![1.01, 1.05, 1.2, 1.5, 2.0, 2.5, 3.0, 5.0, 11.6, 30.0, 100.0, 1e3, 1e4];
    plot::Points {
        label: subject.name().into(),
        y: (x.iter())
            .map(|r| match bisect(ONE_STEP, |h| holds(subject, property, *r, h)) {
                Limit::At(strain) => strain,
                _ => f64::NAN,
            })
            .collect(),
        x,
        ..Default::default()
    }
}
