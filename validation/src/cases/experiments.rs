//! Experiments (Figs 4 and 5): judged if the measured points are supplied, `NoData` otherwise.

use super::fit_covers::set;
use super::*;
use crate::files::FileError;
use crate::input::experiment::{self, ANCZUROWSKI, Comparison, MeasuredCurve, OKAGAWA_MASON, Runs, Source};
use crate::judge::accept::MEASURED_LEVEL;
use crate::serve::fit::Range;
use crate::serve::fit::data::TimeColumn;
use crate::serve::fit::scenes::Scenes;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Measurement, "okagawa-mason-1973")
            .claim(
                "With α = 0.5 the mean projections are those of the points given in the place of Okagawa & Mason's \
                 (1973), at each of n = 20, 50 and 100 per cm³ that has points.",
            )
            .source("eq. 4; Fig. 4")
            .under_test((|_| {}) as Change)
            .mistakes(controls())
            .check(|change, effort| agreement(&OKAGAWA_MASON, *change, effort)),
        Case::of(Judges::Measurement, "anczurowski-1967")
            .claim(
                "With α = 0.5 the mean projections up to t/T = 3 are those of the points given in the place of \
                 Anczurowski, Cox & Mason's (1967).",
            )
            .source("eq. 4; Fig. 5")
            .under_test((|_| {}) as Change)
            .mistakes(controls())
            .check(|change, effort| agreement(&ANCZUROWSKI, *change, effort)),
        Case::of(Judges::Measurement, "alpha-same-for-both")
            .claim("The α that fits the given points best is the same at r_e = 11.6 and at 14.2.")
            .source("eq. 7; Figs 4, 5")
            .under_test((|_| {}) as Change)
            .mistake("α doubled unseen, at r_e = 14.2 only", double_alpha as Change)
            .check(same_alpha),
        Case::of(Judges::Statement, "in-plane-not-fitted")
            .claim(
                "Curves of equal rods that start parallel in the shear plane, as the experiment at r_e = 3.96 had \
                 them, do not depend on α, and a fit of α to points of them is refused: \"not suitable for comparison \
                 with the model\".",
            )
            .source("eqs 4, 7; Results, the r_e = 3.96 experiment")
            .under_test(90.0)
            .mistake("10° out of the plane, of unequal r_e", 80.0)
            .check(not_fitted),
    ]
}

/// The distance of the curves for α = 0.05 and 5, and the refusal of a fit, for rods that start at this θ.
fn not_fitted(theta_deg: &f64, effort: &Effort) -> Result<Vec<Evidence>, String> {
    let mut scene = lab::interacting_scene(effort);
    scene.particles.orientation = Orientation::Given { phi_deg: 0.0, theta_deg: *theta_deg };
    scene.particles.aspect_ratio = 3.96;
    scene.particles.aspect_ratio_sd_percent = 3.0;
    let fitted = scene.clone();
    if *theta_deg == 90.0 {
        // Unequal rods do not stay parallel, and kick each other in the plane by the error of a time step.
        scene.particles.aspect_ratio_sd_percent = 0.0;
    }
    let curve = |alpha: f64| {
        let scene = lab::changed(scene.clone(), |scene| lab::interaction(scene).alpha = alpha);
        lab::per_replica(&scene, 1, |mean| {
            Channel::X.map(|channel| (0..=50).map(|k| mean(channel, k)).collect::<Vec<_>>())
        })
    };
    let (weak, strong) = (curve(0.05).concat().concat(), curve(5.0).concat().concat());
    let apart = worst(weak.iter().zip(&strong).map(|(a, b)| (a - b).abs()));
    let range = Range::parse("interaction.alpha=0.05:5")?;
    let fit = Scenes::new(vec![set(&fitted, effort.seed(0), TimeColumn::Periods)?], vec![range]);
    let refused = fit.is_err_and(|error| {
        error.to_string().contains("disturb each other in this model only by the error of a time step")
    });
    Ok(vec![
        Evidence::on("the largest difference of X̄_i between α = 0.05 and 5", "rod lengths").exact(apart),
        Evidence::on("fits of α to it that are not refused", "fits").exact(f64::from(u8::from(!refused))),
    ])
}

fn controls() -> Vec<(&'static str, Change)> {
    vec![("α = 1", double_alpha), ("rods that do not interact", |scene| scene.interaction = None)]
}

fn double_alpha(scene: &mut Scene) {
    lab::interaction(scene).alpha *= 2.0;
}

const SUPPLY: &str = "put the digitised points (CSV) and their provenance (TOML) into the source's folder under DIR \
                      and run `shearbed validate --data DIR`; docs/src/validation/points.md has the format";

fn no_data(what: impl Into<String>) -> Evidence {
    Evidence::new(what, "–", Rule::NoData { supply: SUPPLY.into() })
}

/// The points of a source that are judged, and the number of those that are not.
fn judged(source: &Source, effort: &Effort) -> Result<(Vec<MeasuredCurve>, usize), FileError> {
    let Some(data) = &effort.data else {
        return Ok((Vec::new(), 0));
    };
    let mut curves = experiment::read(data, source)?;
    let mut late = 0;
    for curve in &mut curves {
        let all = curve.points.len();
        curve.points.retain(|point| point.x <= source.judged_up_to);
        late += all - curve.points.len();
    }
    curves.retain(|curve| !curve.points.is_empty());
    Ok((curves, late))
}

/// The model runs for the points of one curve; each curve has its own `stream`.
fn runs(effort: &Effort, stream: u64) -> Runs {
    Runs { replicas: effort.pick(100, 2000), seed: effort.seed(stream) }
}

fn agreement(source: &Source, change: Change, effort: &Effort) -> Result<Vec<Evidence>, FileError> {
    let (curves, late) = judged(source, effort)?;
    if curves.is_empty() {
        return Ok(vec![no_data(format!("points of {}", source.label))]);
    }
    let of_scene = |(scene, stream): (&&str, u64)| {
        let here: Vec<_> = curves.iter().filter(|curve| curve.scene == *scene).cloned().collect();
        if here.is_empty() {
            return no_data(format!("{scene}: no points"));
        }
        match experiment::compare(scene, &here, change, runs(effort, stream)) {
            Ok(comparison) => fit(&comparison, &here, late, source),
            Err(error) => Evidence::on(format!("{scene}: {error}"), "–").exact(f64::NAN),
        }
    };
    Ok(source.scenes.iter().zip(0..).map(of_scene).collect())
}

fn fit(comparison: &Comparison, curves: &[MeasuredCurve], late: usize, source: &Source) -> Evidence {
    let n = comparison.points.len();
    let mut given: Vec<_> = curves.iter().map(|curve| curve.provenance.stated.short(80)).collect();
    given.dedup();
    let mut what = format!(
        "{}, points of {}: χ² = {:.1} of {n} points; E = S − D: mean {:.4}, RMS {:.4}, |E| ≤ 2 u_val for {:.0} %",
        comparison.scene,
        given.join("; "),
        comparison.chi_square,
        comparison.mean_error,
        comparison.rms_error,
        100.0 * comparison.within_two_u_val,
    );
    if let Some(bias) = comparison.bias {
        what += &format!("; bias δ = {:.3}, σ_M = {:.3}", bias.delta, bias.sigma_m);
    }
    if !comparison.inputs_stated {
        what += "; u_input = 0: none stated";
    }
    if late > 0 {
        what += &format!("; {late} points of the source after t/T = {} not judged", source.judged_up_to);
    }
    let because = "χ² over all points with their full covariance; three points can tell a shape from a shift, and the \
                   controls show the power";
    Evidence::on(what, "–").p_value(comparison.p, n as u64, 3, MEASURED_LEVEL).because(because)
}

/// The difference of the two best α. The control doubles α in the model at r_e = 14.2, which the estimate does not
/// know.
fn same_alpha(change: &Change, effort: &Effort) -> Result<Evidence, String> {
    let points = |source| judged(source, effort).map_err(|error| error.to_string());
    let ((short, _), (long, _)) = (points(&OKAGAWA_MASON)?, points(&ANCZUROWSKI)?);
    if short.is_empty() || long.is_empty() {
        return Ok(no_data("points at both aspect ratios"));
    }
    let short = experiment::alpha(&short, |_| {}, runs(effort, 0))?;
    let long = experiment::alpha(&long, *change, runs(effort, 1))?;
    let what = format!(
        "best α: {:.3} ± {:.3} at r_e = 11.6, {:.3} ± {:.3} at 14.2; their difference",
        short.alpha, short.se, long.alpha, long.se
    );
    let difference = Sample {
        mean: long.alpha - short.alpha,
        se: short.se.hypot(long.se),
        samples: (short.points + long.points) as u64,
    };
    Ok(Evidence::on(what, "–")
        .is(difference, 0.0, 0.0, 1.0)
        .because("points that would show α = 1.5 beside 0.5, a standard error of about 0.1; blunter ones say nothing"))
}
