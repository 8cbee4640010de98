//! The digits of numbers in sentences about a fit.

/// The probability as text: three decimals below 0.1, so that 0.046 does not become 0.05, and two digits below 0.01.
pub fn probability(p: f64) -> String {
    match p {
        0.0 => "0".to_owned(),
        p if p < 0.01 => format!("{p:.1e}"),
        p if p < 0.1 => format!("{p:.3}"),
        p => format!("{p:.2}"),
    }
}

/// The number of decimals that show two digits of `number`, at most 12.
pub fn decimals(number: f64) -> usize {
    match number.log10().floor() {
        log if log.is_finite() => (1.0 - log).clamp(0.0, 12.0) as usize,
        _ => 4,
    }
}
