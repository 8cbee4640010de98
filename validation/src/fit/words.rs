//! A fit in words: the answer in one line, and its budget, for the terminal.

use super::report::Report;
use super::search::Fit;

/// The answer in one line for each parameter, and the goodness of fit.
pub fn sentence(fit: &Fit, report: &Report) -> String {
    let parameter = |range: &super::Range| {
        let found = &report.parameters[&range.label()];
        // Two digits of the uncertainty.
        let digits = decimals(found.standard_uncertainty);
        format!(
            "{} = {:.digits$}, 95 % from {:.digits$} to {:.digits$}",
            range.name(),
            found.estimate,
            found.low_95,
            found.high_95
        )
    };
    let all: Vec<_> = fit.ranges.iter().map(parameter).collect();
    format!(
        "{}; χ² = {:.1} for {} degrees of freedom, p = {}",
        all.join("; "),
        report.chi2,
        report.degrees_of_freedom,
        match report.p_value {
            p if p < 0.01 => format!("{p:.1e}"),
            p => format!("{p:.2}"),
        }
    )
}

/// The budget and the shifts, for the terminal.
pub fn table(fit: &Fit, report: &Report) -> String {
    let names: String = fit
        .ranges
        .iter()
        .map(|range| format!("  {:>18}", range.name()))
        .collect();
    let numbers = |all: &[f64]| all.iter().map(|u| format!("  {u:>18.2e}")).collect::<String>();
    let mut text = format!("{:<34}{names}\n", "standard uncertainty by");
    for part in &report.budget {
        text += &format!("{:<34}{}\n", part.source, numbers(&part.u));
    }
    for shift in &report.shifts {
        let both = shift
            .shift
            .iter()
            .zip(&shift.se)
            .map(|(shift, se)| format!("{shift:.1e} ± {se:.0e}"));
        let both: String = both.map(|text| format!("  {text:>18}")).collect();
        text += &format!("{:<34}{both}\n", format!("shift by {}", shift.change));
    }
    format!(
        "{text}runs: {}, replicas at each value: {}\n",
        report.runs, report.replicas
    )
}

/// The decimals that show two digits of a number, up to 12.
fn decimals(number: f64) -> usize {
    match number.log10().floor() {
        log if log.is_finite() => (1.0 - log).clamp(0.0, 12.0) as usize,
        _ => 4,
    }
}
