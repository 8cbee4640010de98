//! Kicks compared with diffusion, as tables and pictures.

use super::jumps::{Compared, STREAM};
use super::*;
use crate::methods::coefficients::jumps::{Apart, Quantity, Shares, above, apart};
use crate::oracle::closed_form::orbit_constant_cdf;
use crate::oracle::diffusion::orbits::cdf;

/// One of the two samples of a comparison, and what turned its rods.
type Side<'a> = (&'a Compared, &'static str, &'a [Shares]);

/// A column of the share above an edge in per cent of the rods, with two digits of the standard error.
fn per_cent<'a>(name: impl Into<String>, quantity: Quantity, edge: f64) -> Column<'a, Side<'a>> {
    estimate(name, move |side: &Side| {
        let Sample { mean, se, .. } = Sample::of(above(side.2, quantity, edge));
        (100.0 * mean, 100.0 * se)
    })
}

/// The shares of rods above each edge, and the distances of the two samples.
pub(super) fn tables(all: &[Compared], effort: &Effort) -> [ReportTable; 2] {
    let replicas = all.first().map_or(0, |one| one.kicks.len());
    let mut columns = vec![
        field("steps ×", |side: &Side| side.0.setting.finer),
        number("strain", decimals(2), |side: &Side| side.0.strain),
        words("turned by", |side: &Side| side.1),
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
             motion by more than an angle, or in another orbit by more than |ΔC_b|; last, those with C_b > ½. n a³ = \
             0.2, r_e = 11.6, α = 0.5, steady; diffusion of the C_I that was measured at the same time step."
        ),
        all.iter().flat_map(|one| [(one, "kicks", &one.kicks[..]), (one, "diffusion", &one.diffusion[..])]),
        columns,
    );
    let quantities = [
        (Quantity::Angle, "the angle of the jump"),
        (Quantity::Change, "|ΔC_b|"),
        (Quantity::Orbit, "C_b"),
        (Quantity::Phase, "the phase of φ"),
    ];
    let seed = effort.seed(STREAM - 1);
    let rows = all.iter().flat_map(|one| {
        quantities.map(|(quantity, name)| (one, name, apart(&one.kicks, &one.diffusion, quantity, seed)))
    });
    let distances = ReportTable::new(
        ["steady-orbits", "How far kicks and diffusion are apart"],
        "The largest difference between the two distribution functions, and the probability that the replicas dealt \
         out at random are as far apart (999 deals, so 0.001 at least). The phase is atan(tan φ/r_e), through which \
         free rods pass evenly.",
        rows,
        vec![
            field("steps ×", |(one, ..): &(&Compared, _, _)| one.setting.finer),
            words("distribution of", |(_, name, _): &(_, &'static str, _)| *name),
            number("distance", decimals(3), |(_, _, apart): &(_, _, Apart)| apart.distance),
            number("p", decimals(3), |(_, _, apart): &(_, _, Apart)| apart.p),
        ],
    );
    [jumps, distances]
}

/// The mean share above each edge; NaN for a share of 0, which a logarithmic axis cannot show.
fn curve(label: &str, all: &[Shares], quantity: Quantity) -> Curve {
    let mean = |edge: f64| Sample::of(above(all, quantity, edge)).mean;
    Curve::of(label, quantity.edges(), |edge| (edge, Some(mean(edge)).filter(|s| *s > 0.0).unwrap_or(f64::NAN)))
}

pub(super) fn figures(one: &Compared) -> [ReportFigure; 2] {
    let diffusion = format!("diffusion of C_I = {:.1e}", one.c_i.value);
    let curves = |quantity| [curve("kicks", &one.kicks, quantity), curve(&diffusion, &one.diffusion, quantity)];
    let at = Sample::of(above(&one.kicks, Quantity::Angle, 0.2)).mean * 0.2_f64.tan();
    let angles = (0..=60).map(|k| 10f64.powf(0.05 * f64::from(k) - 2.85));
    let theory = Curve::of("jumps κ with a tail 1/κ, theory", angles, |x| (x, at / x.tan()));
    let closed = |label, cdf: fn(f64, f64) -> f64| {
        Curve::of(label, Quantity::Orbit.edges(), |c_b| (c_b, 1.0 - cdf(c_b, one.setting.aspect_ratio)))
    };
    let jumps = ReportFigure::new(
        ["kicks-and-diffusion", "Rods off Jeffery's motion after a strain of 1"],
        "Kicks leave most rods alone and turn few far, diffusion of the same C_I turns all a little. Jumps κ with a \
         tail ∝ 1/κ make cot x of the angles x between lines; its height is taken from the kicks at 0.2 rad.",
        ["log angle in rad", "log share of rods beyond it"],
    )
    .curves(curves(Quantity::Angle))
    .curves([theory])
    .spans(None, Some((1e-4, 1.0)));
    let orbits = ReportFigure::new(
        ["steady-orbits", "Steady orbits"],
        "C_b = C/(1 + C) is 0 along the vorticity axis and 1 in the shear plane. Collisions leave more rods in high \
         orbits than isotropic directions have, diffusion fewer: its rods follow the closed form of weak diffusion \
         (Leal & Hinch 1971).",
        ["C_b", "share of rods above it"],
    )
    .curves(curves(Quantity::Orbit))
    .curves([
        closed("weak diffusion, closed form", cdf),
        closed("isotropic directions, closed form", orbit_constant_cdf),
    ]);
    [jumps, orbits].map(|figure| {
        figure.judged("Folgar & Tucker 1984; eqs 5 to 10", &["kicks-are-no-diffusion", "orbits-of-collisions"])
    })
}
