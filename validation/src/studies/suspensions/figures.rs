//! Error against run time of suspensions as pictures.

use super::free::Bench;
use super::law::Law;
use super::split::Scope;
use super::study::Interacting;
use crate::present::plot::{Curve, Figure, Points};
use crate::present::study::ReportFigure;

/// A free suspension: a curve for each start.
pub fn free(bench: &Bench) -> ReportFigure {
    let curves = (bench.curves.iter()).map(|curve| Curve {
        label: format!("{}: N^({:+.2} ± {:.2})", curve.start, curve.exponent, curve.exponent_se),
        x: curve.points.iter().map(|point| point.seconds.least).collect(),
        y: curve.points.iter().map(|point| point.error).collect(),
        half_band: None,
    });
    ReportFigure {
        name: format!("suspension-starts-{}", bench.free.scene),
        figure: Figure {
            title: format!(
                "Free rods, r_e = {}, σ = {} %: error against run time",
                bench.free.aspect_ratio, bench.free.sd_percent
            ),
            x_name: "run time (s)".into(),
            y_name: "rms error of X̄₁".into(),
            curves: curves.collect(),
            x_log: true,
            y_log: true,
            ..Default::default()
        },
        caption: format!(
            "Scene {} at t/T = {}, from 100 rods on; laying and moving the rods once, on one core.",
            bench.free.scene, bench.free.turns
        ),
        source: "eqs 4, 11, 12".into(),
        cases: vec!["free-suspension-rates".into(), "free-isotropic".into()],
    }
}

/// An interacting suspension: what the rule says, a fixed step, and what was realised.
pub fn interacting(study: &Interacting) -> ReportFigure {
    let constants = &study.constants;
    let errors = || (0..=40).map(|k| 0.03 * 10f64.powf(-0.05 * f64::from(k)));
    let own = study.answers.first().map(|answer| answer.split.scope);
    let rule = |scope: Scope, label: &str| {
        let splits: Vec<_> = errors().map(|error| constants.cheapest(scope, error)).collect();
        Curve {
            label: label.into(),
            x: splits.iter().map(|s| s.rod_steps() as f64 * study.rod_step_s).collect(),
            y: splits.iter().map(|split| split.error()).collect(),
            half_band: None,
        }
    };
    let mut curves = Vec::new();
    if let Some(Scope::OwnRods(rods)) = own {
        curves.push(rule(Scope::OwnRods(rods), &format!("cheapest, counted from Δt → 0 with {rods} rods")));
        curves.push(rule(Scope::Unbounded, "cheapest, counted from Δt → 0 and N → ∞"));
        let steps = 200.0;
        let replicas: Vec<f64> = (0..=40).map(|k| 10f64.powf(0.1 * f64::from(k))).collect();
        let rods = rods as f64;
        let bias = constants.bias(Scope::Unbounded, steps, rods);
        curves.push(Curve {
            label: "200 steps, the scene's rods, more and more replicas".into(),
            x: replicas.iter().map(|m| m * rods * steps * study.rod_step_s).collect(),
            y: replicas
                .iter()
                .map(|m| bias.hypot((constants.variance_per_rod / (rods * m)).sqrt()))
                .collect(),
            half_band: None,
        });
    }
    let realised: Vec<_> =
        (study.answers.iter()).filter_map(|answer| Some((answer.seconds, answer.realised?.error))).collect();
    ReportFigure {
        name: format!("suspension-splits-{}", study.scene),
        figure: Figure {
            title: "Interacting rods: total error of X̄₁ at t/T = 1 against run time".into(),
            x_name: "run time on one core (s)".into(),
            y_name: "rms error of X̄₁, bias at most".into(),
            curves,
            points: vec![Points {
                label: "realised".into(),
                x: realised.iter().map(|point| point.0).collect(),
                y: realised.iter().map(|point| point.1).collect(),
                ..Default::default()
            }],
            x_log: true,
            y_log: true,
            ..Default::default()
        },
        caption: format!(
            "Scene {}. With a fixed step and fixed rods, more replicas end at the bias, here counted from Δt → 0 and \
             N → ∞; a realised error below its curve is a bias that is smaller than the largest that was allowed for.",
            study.scene
        ),
        source: "eqs 4 to 14".into(),
        cases: vec!["cheapest-split".into()],
    }
}

/// X̄₁ against the step, and the straight line of first order.
pub fn steps(law: &Law) -> ReportFigure {
    let inverse = |steps: u64| 1.0 / steps as f64;
    let line = law.steps_line.as_ref().map(|line| {
        let coarsest = law.steps.get(law.line_from).map_or(0.0, |s| inverse(s.steps_per_period));
        Curve {
            label: "first order".into(),
            x: vec![0.0, coarsest],
            y: vec![line.intercept, line.intercept + line.slope * coarsest],
            half_band: None,
        }
    });
    ReportFigure {
        name: "steps".into(),
        figure: Figure {
            title: "Interacting rods: X̄₁ at t/T = 1 against the step".into(),
            x_name: "step Δt/T".into(),
            y_name: "X̄₁ (rod lengths)".into(),
            curves: line.into_iter().collect(),
            points: vec![Points {
                label: "measured, ± 2 se".into(),
                x: law.steps.iter().map(|s| inverse(s.steps_per_period)).collect(),
                y: law.steps.iter().map(|s| s.x1).collect(),
                y_error: Some(law.steps.iter().map(|s| 2.0 * s.se).collect()),
                ..Default::default()
            }],
            ..Default::default()
        },
        caption: "Convergence in law: the mean tends to a limit as Δt → 0, and the line is the first-order bias, where one \
                  fits."
            .into(),
        source: "eqs 4 to 14".into(),
        cases: vec!["cheapest-split".into(), "paths-do-not-converge".into()],
    }
}
