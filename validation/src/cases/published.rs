//! The model against numbers that others published on related suspensions.

use super::*;
use crate::input::published::{SPH_ASPECT_RATIO, first_half_turn, sph_fibres};
use shearbed::model::shape::spread;

/// A function that returns the least and the greatest strain of half a turn of a cylinder of this physical aspect
/// ratio.
type HalfTurn = fn(f64) -> (f64, f64);

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "sph-half-turn")
            .claim(
                "Fibres that others simulated by smoothed particle hydrodynamics (not measured) make their first half \
                 turn in T/2 of an r_e that published formulas give for their shape; their later damping is outside \
                 the model.",
            )
            .source("eq. 15; Meyer et al. 2020; docs/src/validation/published.md")
            .under_test(of_formulas as HalfTurn)
            .mistake("a whole period for half a turn", |r| {
                let (least, most) = of_formulas(r);
                (2.0 * least, 2.0 * most)
            })
            .mistake("r_e is the cylinder's own length over diameter", |r| {
                (0.5 * strain_per_period(r), 0.5 * strain_per_period(r))
            })
            .check(|half_turn, _| {
                let turns: Vec<f64> = sph_fibres().iter().filter_map(first_half_turn).collect();
                let mean = turns.iter().sum::<f64>() / turns.len() as f64;
                let (least, most) = half_turn(SPH_ASPECT_RATIO);
                // Without a mean, `outside` is NaN, which fails.
                let outside = if (least..=most).contains(&mean) { 0.0 } else { (least - mean).max(mean - most) };
                vec![
                    Evidence::on("runs that turn", "runs").exact(turns.len() as f64 - 5.0),
                    Evidence::on(
                        format!("strain {mean:.2} of the first half turn; T/2 is {least:.2} to {most:.2}"),
                        "–",
                    )
                    .exact(outside),
                ]
            }),
    ]
}

/// T/2 for the least and the greatest r_e of published formulas, as strains.
fn of_formulas(r: f64) -> (f64, f64) {
    let (least, most) = spread(r).unwrap_or((f64::NAN, f64::NAN));
    (0.5 * strain_per_period(least), 0.5 * strain_per_period(most))
}
