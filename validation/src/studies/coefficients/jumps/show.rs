//! Kicks beside diffusion as tables and pictures.

use super::{Apart, Compared, Quantity, Shares, above, apart};
use crate::judge::case::Effort;
use crate::judge::statistics::Sample;
use crate::present::plot::{Curve, Figure};
use crate::present::study::ReportFigure;
use crate::present::table::{Column, ReportTable, estimate, field, number, words};

/// One of the two samples of a comparison.
struct Sided<'a> {
    of: &'a Compared,
    turned_by: &'static str,
    shares: &'a [Shares],
}

fn sides(all: &[Compared]) -> Vec<Sided<'_>> {
    let both = |of| {
        [
            Sided { of, turned_by: "kicks", shares: &of.kicks },
            Sided { of, turned_by: "diffusion", shares: &of.diffusion },
        ]
    };
    all.iter().flat_map(both).collect()
}

/// In per cent of the rods, with two digits of the standard error.
fn per_cent<'a>(name: impl Into<String>, quantity: Quantity, edge: f64) -> Column<'a, Sided<'a>> {
    let digits = |x: f64, se: f64| {
        let places = if se > 0.0 { (1.0 - se.log10().floor()).clamp(0.0, 4.0) as usize } else { 0 };
        format!("{x:.places$} ± {se:.places$}")
    };
    estimate(name, digits, move |side: &Sided<'_>| {
        let Sample { mean, se, .. } = Sample::of(&above(side.shares, quantity, edge));
        (100.0 * mean, 100.0 * se)
    })
}

/// How many rods jumped how far, and how far apart the two samples are.
pub(in crate::studies::coefficients) fn tables(all: &[Compared], effort: &Effort) -> [ReportTable; 2] {
    let replicas = all.first().map_or(0, |one| one.kicks.len());
    let mut columns = vec![
        field("steps ×", |side: &Sided<'_>| side.of.setting.finer),
        number("strain", |x| format!("{x:.2}"), |side: &Sided<'_>| side.of.strain),
        words("turned by", |side: &Sided<'_>| side.turned_by),
    ];
    for edge in [0.01, 0.1, 0.2, 0.5, 1.0] {
        columns.push(per_cent(format!("> {edge} rad"), Quantity::Angle, edge));
    }
    for edge in [0.01, 0.1, 0.5] {
        columns.push(per_cent(format!("|ΔC_b| > {edge}"), Quantity::Change, edge));
    }
    columns.push(per_cent("C_b > 0.5", Quantity::Orbit, 0.5));
    let jumps = ReportTable::new(
        ["kicks-and-diffusion", "Kicks and diffusion of the same C_I"],
        format!(
            "Per cent of the rods (± a standard error over {replicas} replicas) that a strain leaves off Jeffery's \
             motion by more than an angle, or in another orbit by more than |ΔC_b|; last, those whose orbit is nearer to the \
             shear plane. n a³ = 0.2, r_e = 11.6, α = 0.5, steady; diffusion of the C_I that was measured at the same time step."
        ),
        sides(all),
        columns,
    );
    let quantities = [
        (Quantity::Angle, "the angle of the jump"),
        (Quantity::Change, "|ΔC_b|"),
        (Quantity::Orbit, "C_b"),
        (Quantity::Phase, "the phase of φ"),
    ];
    let rows = all.iter().flat_map(|one| quantities.map(|(quantity, name)| (one, quantity, name)));
    let rows: Vec<_> = rows
        .map(|(one, quantity, name)| {
            let seed = effort.seed(super::STREAM - 1);
            (one, name, apart(&one.kicks, &one.diffusion, quantity, seed))
        })
        .collect();
    let distances = ReportTable::new(
        ["steady-orbits", "How far kicks and diffusion are apart"],
        "The largest difference between the two distribution functions, and the probability that the replicas dealt out at random \
         are as far apart (999 deals, so 0.001 at least). The phase is atan(tan φ/r_e), through which free rods pass evenly.",
        rows,
        vec![
            field("steps ×", |(one, ..): &(&Compared, _, _)| one.setting.finer),
            words("distribution of", |(_, name, _): &(_, &'static str, _)| *name),
            number("distance", |x| format!("{x:.3}"), |(_, _, apart): &(_, _, Apart)| apart.distance),
            number("p", |p| format!("{p:.3}"), |(_, _, apart): &(_, _, Apart)| apart.p),
        ],
    );
    [jumps, distances]
}

/// The mean share above each edge; NaN where there is none, for which logarithms have no place.
fn curve(label: impl Into<String>, all: &[Shares], quantity: Quantity) -> Curve {
    let edges = quantity.edges();
    let mean = |edge: &f64| Sample::of(&above(all, quantity, *edge)).mean;
    let shown = |share: f64| if share > 0.0 { share } else { f64::NAN };
    Curve {
        label: label.into(),
        y: edges.iter().map(|edge| shown(mean(edge))).collect(),
        x: edges,
        half_band: None,
    }
}

/// The tail of the jumps, and the steady orbits.
pub(in crate::studies::coefficients) fn figures(one: &Compared) -> [ReportFigure; 2] {
    let labels = ["kicks".to_owned(), format!("diffusion of C_I = {:.1e}", one.c_i.value)];
    let curves = |quantity| {
        let [kicks, diffusion] = &labels;
        vec![curve(kicks, &one.kicks, quantity), curve(diffusion, &one.diffusion, quantity)]
    };
    let mut jumps = curves(Quantity::Angle);
    let x: Vec<f64> = (0..=60).map(|k| 10f64.powf(0.05 * f64::from(k) - 2.85)).collect();
    let at = Sample::of(&above(&one.kicks, Quantity::Angle, 0.2)).mean * 0.2_f64.tan();
    jumps.push(Curve {
        label: "jumps κ with a tail 1/κ, theory".into(),
        y: x.iter().map(|x| at / x.tan()).collect(),
        x,
        half_band: None,
    });
    let source = "Folgar & Tucker 1984; eqs 5 to 10".to_owned();
    let cases = vec!["kicks-are-no-diffusion".to_owned()];
    [
        ReportFigure {
            name: "kicks-and-diffusion".into(),
            figure: Figure {
                title: "Rods off Jeffery's motion after a strain of 1".into(),
                x_name: "angle in rad".into(),
                y_name: "share of rods beyond it".into(),
                curves: jumps,
                x_log: true,
                y_log: true,
                y_span: Some((1e-4, 1.0)),
                ..Default::default()
            },
            caption: "Kicks leave most rods alone and turn few far, diffusion of the same C_I turns all a little. Jumps κ with a tail ∝ 1/κ \
                      make cot x of the angles x between lines; its height is taken from the kicks at 0.2 rad."
                .into(),
            source: source.clone(),
            cases: cases.clone(),
        },
        ReportFigure {
            name: "steady-orbits".into(),
            figure: Figure {
                title: "Steady orbits".into(),
                x_name: "C_b".into(),
                y_name: "share of rods above it".into(),
                curves: curves(Quantity::Orbit),
                ..Default::default()
            },
            caption: "C_b = C/(1 + C) is 0 along the vorticity axis and 1 in the shear plane. Diffusion brings rods nearer to the vorticity \
                      axis than kicks do."
                .into(),
            source,
            cases,
        },
    ]
}
