//! A fit as text for the terminal: one line with the answer, and the budget.

use shearbed_validation::serve::fit::design::{Added, Step};
use shearbed_validation::serve::fit::digits::{decimals, probability};
use shearbed_validation::serve::fit::report::Report;
use shearbed_validation::serve::fit::search::Fit;
use shearbed_validation::serve::fit::{LEAST_P, Range, Tested};

/// One line with the estimate of each parameter and the goodness of fit.
pub(super) fn sentence(fit: Option<&Fit>, report: &Report) -> String {
    let parameter = |range: &Range| {
        let found = &report.parameters[&range.label()];
        // Two digits of the uncertainty, which counts as at most the range if the points determine little.
        let digits = decimals(found.standard_uncertainty.min(range.to - range.from));
        format!(
            "{} = {:.digits$}, 95 % from {:.digits$} to {:.digits$}",
            range.name(),
            found.estimate,
            found.low_95,
            found.high_95
        )
    };
    let all: Vec<_> = fit.map_or(vec!["the scene as it is".into()], |fit| fit.ranges.iter().map(parameter).collect());
    format!(
        "{}; χ² = {:.1} for {} degrees of freedom, p = {}",
        all.join("; "),
        report.chi2,
        report.degrees_of_freedom,
        probability(report.p_value)
    )
}

/// A share of the standard uncertainty that seeds may move an estimate by without a word.
const LITTLE: f64 = 0.2;

/// The uncertainty budget and the shifts, as text for the terminal; `runs` is the number of all runs.
pub(super) fn table(fit: &Fit, report: &Report, runs: u64) -> String {
    let names: String = fit.ranges.iter().map(|range| format!("  {:>18}", range.name())).collect();
    let numbers = |all: &[f64]| all.iter().map(|u| format!("  {u:>18.2e}")).collect::<String>();
    let mut text = format!("{:<34}{names}\n", "standard uncertainty by");
    for part in &report.budget {
        text += &format!("{:<34}{}\n", part.source, numbers(&part.u));
    }
    text += &format!("{:<34}{}\n", "of that, another seed moves it by", numbers(&report.another_seed));
    for shift in &report.shifts {
        let both = shift.shift.iter().zip(&shift.se).map(|(shift, se)| format!("{shift:.1e} ± {se:.0e}"));
        let both: String = both.map(|text| format!("  {text:>18}")).collect();
        text += &format!("{:<34}{both}\n", format!("shift by {}", shift.change));
    }
    text += &format!("runs: {runs}, of the search: {}, replicas at each value: {}\n", report.runs, report.replicas);
    let of_uncertainty = |(range, seed): (&Range, &f64)| seed / report.parameters[&range.label()].standard_uncertainty;
    let most = shearbed_validation::oracle::worst(fit.ranges.iter().zip(&report.another_seed).map(of_uncertainty));
    if most > LITTLE {
        let seeds = (most / LITTLE).powi(2).ceil();
        let runs = seeds * runs as f64;
        text += &format!(
            "the seed matters: the mean of {seeds} fits with other seeds, {runs} runs, moves by a fifth of the \
             uncertainty\n"
        );
    }
    text
}

/// One line for each tested hypothesis, as text for the terminal.
pub(super) fn tests(report: &Report) -> String {
    let line = |tested: &Tested| {
        let (beyond, p) = (tested.beyond_the_box, tested.p_value);
        let more = if beyond { " or more" } else { "" };
        let p = if beyond || p <= LEAST_P {
            format!("p below {}", rounded_up(p))
        } else {
            format!("p = {}", probability(p))
        };
        let found = format!("χ² rises by {:.1}{more}, {p}", tested.rise_of_chi2);
        let difference = tested.difference.map_or(String::new(), |found| {
            let digits = decimals(0.25 * (found.high_95 - found.low_95));
            let cut = match found.ends_at_edge {
                [false, false] => "",
                _ => ", or more: a range cuts it",
            };
            format!(
                "    difference {:.digits$}, 95 % from {:.digits$} to {:.digits$}{cut}\n",
                found.estimate, found.low_95, found.high_95
            )
        });
        format!("{}: {found}\n{difference}", tested.hypothesis)
    };
    report.tests.iter().map(line).collect()
}

/// The number rounded up to one digit, for an upper bound.
fn rounded_up(p: f64) -> String {
    let unit = 10f64.powf(p.log10().floor());
    format!("{:.0e}", (p / unit - 1e-9).ceil() * unit)
}

/// The table of uncertainties that further points would leave, for the terminal. `times` are the units of the sets'
/// times.
pub(super) fn design(fit: &Fit, steps: &[Step], times: &[&str]) -> String {
    let head = "what further points would leave".to_owned();
    let mut points = 0;
    let what = |step: &Step| {
        points += usize::from(matches!(step.added, Added::Point { .. }));
        added(&step.added, points, times)
    };
    let all: Vec<String> = steps.iter().map(what).collect();
    let wide = all.iter().map(|text| text.chars().count()).fold(head.len(), usize::max);
    let names = fit.ranges.iter().map(|range| format!("  {:>12}", format!("u({})", range.name())));
    let mut text = format!("{head:<wide$}{}", names.collect::<String>());
    if fit.ranges.len() > 1 {
        text += "  correlation";
    }
    for (step, what) in steps.iter().zip(all) {
        let numbers: String = step.u.iter().map(|u| format!("  {u:>12.3}")).collect();
        let last = step.correlation.map_or(String::new(), |r| format!("  {r:>11.3}"));
        text += &format!("\n{what:<wide$}{numbers}{last}");
    }
    text + "\n"
}

/// The row of the points `added`; of best points this is number `count`, and the row keeps those above it.
fn added(added: &Added, count: usize, times: &[&str]) -> String {
    let of_set = |set: &usize| match times.len() {
        1 => String::new(),
        _ => format!(" of set {}", set + 1),
    };
    let at = |n: &Option<f64>| n.map_or(String::new(), |n| format!(", {n} per cm³"));
    match added {
        Added::Nothing => "the measured points".into(),
        Added::AsMany { set, points, concentration_per_cm3: n } => {
            format!("{points} more{}, evenly over the scene{}", of_set(set), at(n))
        }
        Added::Point { set, concentration_per_cm3: n, column, time } => {
            let before = match count {
                1 => "best next point: ".to_owned(),
                _ => format!("and point {count}: "),
            };
            format!("{before}{column}{} at {} = {time:.2}{}", of_set(set), times[*set], at(n))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_are_on_the_right_side_of_a_limit() {
        assert_eq!([0.0458, 0.5, 0.003].map(probability), ["0.046", "0.50", "3.0e-3"]);
        // A rounded bound is never below the bound itself.
        assert_eq!([0.0646, 3.28e-6, 1e-6, 0.86, 1.0].map(rounded_up), ["7e-2", "4e-6", "1e-6", "9e-1", "1e0"]);
    }
}
