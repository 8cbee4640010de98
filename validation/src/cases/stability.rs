//! Limits of stability of integrators of a free rod, as stated in `docs/src/verification/integrators.md`.

use super::integrators::Integrators;
use super::integrators::{in_angles, in_p, refuses, whole_turns};
use super::*;
use crate::methods::integrators::*;
use crate::studies::stability::map::{self, ASPECT_RATIOS, Cell, Fate, STEPS, TOLERANCES};
use crate::studies::stability::orbit::Place;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Integrator, "stability-map")
            .claim(
                "Over the whole map every integrator ends, with a direction or with an error: the exact \
                 propagator at round-off, A.4 and A.5 in angles within 4·10⁻⁵ rad, who keeps |p| with |p| = 1, and \
                 orders 2 and 4 within 4 (GΔt)² rad over one period where GΔt ≤ ½.",
            )
            .source("eqs 13, A.2–A.5")
            .under_test(crate::methods::integrators::own as Integrators)
            .mistake("whole turns are left in the phase", || vec![whole_turns()])
            .mistake("RK4 in p said to keep |p|", || in_p(4, true, |problem, p, h| rk4(|y| problem.rate(&y), p, h)))
            .mistake("RK4 in angles with an order 4 that is 1", || {
                in_angles(4, |problem, y, h| explicit_euler(|y| problem.angle_rates(&y), y, h))
            })
            .mistake("an error in place of every direction", || vec![refuses()])
            .check(whole_map),
    ]
}

fn whole_map(integrators: &Integrators, effort: &Effort) -> Vec<Evidence> {
    let most_steps = effort.pick(2_000, 20_000);
    let [mut exact, mut angles, mut length, mut accurate, mut silent] = [0.0f64; 5];
    for integrator in integrators() {
        for (cell, strain_per_step) in tried(&integrator, most_steps) {
            let error = cell.error_rad.unwrap_or(f64::NAN);
            match integrator.theory {
                Theory::Exact if integrator.name == closed_form().name => angles = larger(angles, error),
                Theory::Exact => exact += f64::from(cell.found != Fate::RoundOff),
                Theory::Order(order) if order > 1 && (1e-3..=0.5).contains(&strain_per_step) => {
                    accurate = larger(accurate, error / strain_per_step.powi(2));
                }
                _ => {}
            }
            if let (true, Some(off)) = (integrator.keeps_length, cell.length) {
                length = larger(length, off);
            }
            // An integrator without a direction gives a reason, or its result is not finite.
            let explained = cell.error_rad.is_some() || cell.found == Fate::NotFinite || cell.reason.is_some();
            silent += f64::from(!explained);
        }
    }
    vec![
        Evidence::on("cells in which an integrator without steps, other than in angles, is not at round-off", "cells")
            .exact(exact),
        Evidence::on("largest angle to the closed form, A.4 and A.5 in angles", "rad").within(angles, 4e-5).because(
            "the starting phase is added to t/T before whole turns are taken out: rounded to half an ulp of 10³, \
             6·10⁻¹⁴, times 2π r_e = 6·10⁸",
        ),
        Evidence::on("largest ||p| − 1| of who keeps it", "–")
            .within(length, 4.0 * most_steps as f64 * f64::EPSILON)
            .because("each step rounds |p| by four roundings at most"),
        Evidence::on("largest angle over (GΔt)² where 10⁻³ ≤ GΔt ≤ ½ and the order is 2 or 4, over one period", "rad")
            .within(accurate, 4.0)
            .because(
                "a step of order 2 is off by (GΔt)³/6 times a third derivative, 3 at most by A.2, and a flip lasts \
                 some 8/G: 4 (GΔt)²; order 4 is nearer; below 10⁻³ round-off is more",
            ),
        Evidence::on("cells without a direction and without an error", "cells").exact(silent),
    ]
}

/// The cells of all maps that an integrator can fill with at most `most_steps` steps, and the strain of a step.
fn tried(integrator: &Integrator, most_steps: u64) -> Vec<(Cell, f64)> {
    let theory = integrator.theory;
    let by_duration = |r: f64, periods, end| map::by_duration(theory, r, periods, end, most_steps).ok();
    let mut runs: Vec<map::Run> = Vec::new();
    for r in ASPECT_RATIOS {
        if theory == Theory::Adaptive {
            let run = by_duration(r, 1.0, Place::mid_flip(r));
            let settings = TOLERANCES.map(Setting::Tolerance).into_iter();
            runs.extend(settings.filter_map(|setting| Some(map::Run { setting, ..run? })));
        } else {
            runs.extend(STEPS.map(|step| map::by_step(theory, r, step, most_steps)));
        }
        runs.extend(map::places(r).into_iter().filter_map(|(_, place)| by_duration(r, 1.0, place)));
    }
    runs.extend(map::PERIODS.into_iter().filter_map(|periods| by_duration(11.6, periods, Place::mid_flip(11.6))));
    let strain_per_step = |run: &map::Run| match run.setting {
        // Long runs do not count here: their phase error grows with the time.
        Setting::Steps(steps) if run.turns < 2.0 => {
            RodProblem::new(run.aspect_ratio, run.turns).strain() / steps as f64
        }
        _ => f64::INFINITY,
    };
    runs.iter().map(|run| (run.of(integrator), strain_per_step(run))).collect()
}
