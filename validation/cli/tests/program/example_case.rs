use shearbed_validation::judge::case::{Case, Effort, Evidence, Judges};
use shearbed_validation::oracle::closed_form;
use shearbed_validation::judge::statistics::worst;

type Period = fn(f64, f64) -> f64;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "period-formula")
            .claim("The core's period is T = 2π(r_e + 1/r_e)/G.")
            .source("eq. 15")
            .under_test(shearbed::model::jeffery::period_s as Period)
            .mistake("r_e − 1/r_e", |g, r| std::f64::consts::TAU * (r - 1.0 / r) / g)
            .check(period),
    ]
}

fn period(period_s: &Period, _: &Effort) -> Vec<Evidence> {
    let error = |r| (period_s(0.5, r) / closed_form::period_s(0.5, r) - 1.0).abs();
    let because = "four roundings in each of the two formulas";
    let worst = worst([1.01, 11.6, 1e6].map(error));
    vec![Evidence::on("relative error", "–").within(worst, 8.0 * f64::EPSILON).because(because)]
}
