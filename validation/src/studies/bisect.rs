//! The search for the place where a property ends.

/// Halves the interval from `holds` to `fails` so many times: the last place where the property was seen to hold, and
/// the last where it was not.
pub fn bisect(mut holds: f64, mut fails: f64, halvings: u32, is_true: impl Fn(f64) -> bool) -> [f64; 2] {
    for _ in 0..halvings {
        let middle = 0.5 * (holds + fails);
        if is_true(middle) { holds = middle } else { fails = middle }
    }
    [holds, fails]
}
