//! The longest steps and their theory, as tables and pictures.

use super::maps::ratio;
use super::theory::THEORIES;
use super::*;
use crate::methods::integrators::limits::{Limit, Property, longest};

/// The aspect ratios at which limits are sought: all of them over one step, the first seven over ten periods.
const LIMIT_RATIOS: [f64; 9] = [1.01, 1.5, 2.0, 2.5, 3.0, 11.6, 100.0, 1e4, 1e5];

struct Shown {
    name: &'static str,
    title: &'static str,
    caption: &'static str,
    property: Property,
    /// The title of the picture and the case that judges it, if there is a theory to draw.
    picture: Option<[&'static str; 2]>,
}

const SHOWN: [Shown; 6] = [
    Shown {
        name: "step-limit-order",
        title: "The longest step GΔt without overtaking",
        caption: "Of 512 rods in the plane of shear none overtakes the next in a step.",
        property: Property::Order,
        picture: Some(["The longest step without overtaking", "euler-step-limit"]),
    },
    Shown {
        name: "step-limit-turning",
        title: "The longest step GΔt with which every rod turns",
        caption: "Of 512 rods in the plane of shear each turns forward in a step, by less than half a turn; half a \
                  turn is rest. Exact motion has half a period.",
        property: Property::Turning,
        picture: Some(["The longest step with which every rod turns", "step-limit-turning"]),
    },
    Shown {
        name: "step-limit-side",
        title: "The longest step GΔt with which every rod stays on its side of the plane of shear",
        caption: "p_3 = 10⁻⁹ keeps its sign in a step.",
        property: Property::Side,
        picture: Some(["The longest step that keeps the side of the plane of shear", "step-limit-side"]),
    },
    Shown {
        name: "step-limit-solvable",
        title: "The longest step GΔt that can be taken",
        caption: "From directions over the whole sphere the result is finite.",
        property: Property::Solvable,
        picture: None,
    },
    Shown {
        name: "step-limit-length",
        title: "The longest step GΔt with a bounded length",
        caption: "|p| < 1.5 after ten periods, from 45 directions in the plane of shear at steps longer by 5 % each; \
            where they lose |p|, from 180 directions and by 0.2 % from half of that step on. Upper bounds: the steps \
            that lose |p| lie in bands, some of them narrower.",
        property: Property::Length,
        picture: None,
    },
    Shown {
        name: "step-limit-orbit",
        title: "The longest step GΔt that keeps the orbit",
        caption: "C_b within 0.1 of its start after ten periods, from eight directions 1 rad off the vorticity axis at \
            steps longer by 25 % each; then from 16 and by 2 %, from half of the step found on. Upper bounds. There \
            is no closed form.",
        property: Property::Orbit,
        picture: None,
    },
];

/// A table for each property, with a picture if there is a theory.
pub fn exhibits(integrators: &[Integrator]) -> impl Iterator<Item = Exhibit> {
    let stepped: Vec<_> =
        integrators.iter().filter(|integrator| matches!(integrator.theory, Theory::Order(_))).collect();
    SHOWN.iter().map(move |shown| Exhibit {
        figure: shown.picture.map(|picture| figure(shown, picture, &stepped)),
        table: Some(table(shown, &stepped)),
    })
}

fn table(shown: &Shown, integrators: &[&Integrator]) -> ReportTable {
    let (ratios, most) = match shown.property {
        Property::Length | Property::Orbit => (&LIMIT_RATIOS[..7], 20),
        _ => (&LIMIT_RATIOS[..], 1000),
    };
    let mut rows = Vec::new();
    let each = ratios.len();
    let search = |k: usize| longest(integrators[k / each], shown.property, ratios[k % each]);
    let all: Vec<_> = (0..integrators.len() * each).into_par_iter().map(search).collect();
    for (integrator, limits) in integrators.iter().zip(all.chunks(each)) {
        if limits.iter().all(|limit| matches!(limit, Limit::Beyond(_))) {
            continue;
        }
        rows.push([vec![integrator.name.clone()], limits.iter().map(text).collect()].concat());
        let theory = THEORIES.iter().find(|theory| theory.0 == integrator.name && theory.1 == shown.property);
        if let Some((_, _, theory)) = theory {
            let expected = |r: &f64| match theory(*r) {
                limit if limit.is_finite() => format!("{limit:.4}"),
                _ => "none".into(),
            };
            rows.push([vec!["– by theory".into()], ratios.iter().map(expected).collect()].concat());
        }
    }
    let columns = ratios.iter().map(|r| format!("r_e = {}", ratio(*r)));
    let columns: Vec<_> = std::iter::once("integrator".to_owned()).chain(columns).collect();
    let rest = format!("Integrators with fixed steps that are not listed have no limit up to {most}.");
    of_words(shown.name, shown.title, &format!("{} {rest}", shown.caption), &columns, rows)
}

fn text(limit: &Limit) -> String {
    match limit {
        Limit::At(strain) => format!("{strain:.4}"),
        Limit::Beyond(strain) => format!("> {strain:.0}"),
        Limit::Below(strain) => format!("< {strain}"),
    }
}

fn figure(shown: &Shown, [title, case]: [&str; 2], integrators: &[&Integrator]) -> ReportFigure {
    let theories = THEORIES.iter().filter(|theory| theory.1 == shown.property);
    let theories = theories.map(|(name, _, theory)| {
        let ratios = (0..=200).map(|k| 1.01 * 1e4f64.powf(f64::from(k) / 200.0));
        Curve::of(format!("{name}, theory"), ratios, |r| (r, theory(r)))
    });
    let measured = integrators.iter().map(|integrator| {
        let ratios = [1.01, 1.05, 1.2, 1.5, 2.0, 2.5, 3.0, 5.0, 11.6, 30.0, 100.0, 1e3, 1e4];
        let limit = |r| match longest(integrator, shown.property, r) {
            Limit::At(strain) => (r, strain),
            _ => (r, f64::NAN),
        };
        Points::of(&integrator.name, ratios, limit)
    });
    ReportFigure::new(
        [shown.name, &format!("{title}: theory and bisection")],
        "Points by bisection between 512 rods; the numbers are in the table of the same name. A point that is missing \
         has no limit up to GΔt = 941. Projected RK4 lies on RK4 in p, and in the plane of shear RKMK4 on RK4 in \
         angles.",
        ["log aspect ratio r_e", "log longest step GΔt"],
    )
    .curves(theories)
    .points(measured)
    .spans(Some((1.0, 1e4)), None)
    .judged("A.1 to A.3", &[case])
}
