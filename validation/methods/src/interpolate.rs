//! Values between the outputs of a run.

/// The value at `at`, counted in outputs, of Lagrange's polynomial through the `order` outputs around it. Before the
/// first output the curve is constant.
// Not generic, so that it is compiled in this crate, which is optimised, and not in the suite, which is not.
pub fn interpolate(outputs: usize, at: f64, order: usize, value: &dyn Fn(usize) -> f64) -> f64 {
    let at = at.clamp(0.0, (outputs - 1) as f64);
    let order = order.min(outputs);
    let first = (at.floor() as usize + 1).saturating_sub(order / 2).min(outputs - order);
    let weight = |k: usize| -> f64 {
        let others = (first..first + order).filter(|other| *other != k);
        others.map(|other| (at - other as f64) / (k as f64 - other as f64)).product()
    };
    (first..first + order).map(|k| weight(k) * value(k)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_and_a_line_are_met_everywhere() {
        let cubic = |t: f64| 1.0 + t - 0.3 * t * t + 0.02 * t.powi(3);
        let line = |t: f64| 2.0 - 0.1 * t;
        for at in [0.0, 0.3, 1.0, 4.5, 9.99, 10.0] {
            let found = interpolate(11, at, 4, &|k| cubic(k as f64));
            assert!((found - cubic(at)).abs() < 1e-12 * found.abs());
            let found = interpolate(11, at, 2, &|k| line(k as f64));
            assert!((found - line(at)).abs() < 1e-12 * found.abs());
        }
        assert_eq!(interpolate(11, -0.2, 4, &|k| k as f64 + 5.0), 5.0);
    }
}
