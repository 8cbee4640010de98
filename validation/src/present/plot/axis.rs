//! An axis: its range, its ticks and their labels.

use super::power_of_ten;
use super::style::{FINE, TEXT};
use super::texts::text_width;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// Larger magnitudes are treated as infinite, because differences of two of them would be.
const LARGEST: f64 = 1e300;

/// Steps between the ticks of a long linear axis.
pub(super) const STEPS: f64 = 6.0;

/// The place of a value on an axis: the value or its logarithm; NaN if it has no place there.
pub(super) fn place(value: f64, log: bool) -> f64 {
    let placed = if log { value.log10() } else { value };
    if placed.abs() <= LARGEST { placed } else { f64::NAN }
}

#[derive(Clone)]
pub(super) struct Axis {
    pub(super) low: f64,
    pub(super) high: f64,
    /// The places of the ticks, and their labels.
    pub(super) ticks: Vec<(f64, String)>,
    /// Small ticks of a logarithmic axis, at 2 to 9 times each power: without them it would look linear.
    pub(super) between: Vec<f64>,
}

impl Axis {
    /// An axis that covers all finite `placed` values, with a margin as a part of their range, in about so many steps
    /// if it is linear.
    pub(super) fn over(placed: impl Iterator<Item = f64>, log: bool, margin: f64, steps: f64) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in placed.filter(|value| value.is_finite()) {
            low = low.min(value);
            high = high.max(value);
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if log { logarithmic(low, high) } else { linear(low, high, margin, steps) }
    }

    /// An axis with exactly these ends, in placed values.
    pub(super) fn exactly((low, high): (f64, f64), log: bool) -> Self {
        let axis = if log { logarithmic(low, high) } else { linear(low, high, 0.0, STEPS) };
        let slack = 1e-9 * (high - low);
        let inside = |place: f64| (low - slack..=high + slack).contains(&place);
        Self {
            low,
            high,
            ticks: axis.ticks.into_iter().filter(|(tick, _)| inside(*tick)).collect(),
            between: axis.between.into_iter().filter(|tick| inside(*tick)).collect(),
        }
    }

    /// The axis without labels, above another one that has them.
    pub(super) fn unlabelled(mut self) -> Self {
        self.ticks.iter_mut().for_each(|(_, label)| label.clear());
        self
    }

    /// Removes labels that would touch their neighbours on an axis of this length.
    pub(super) fn legible(mut self, length: i32) -> Self {
        let widest = self.ticks.iter().map(|(_, label)| text_width(label, TEXT)).max().unwrap_or(0);
        let apart = self.ticks.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(f64::INFINITY, f64::min);
        let room = apart / (self.high - self.low) * f64::from(length);
        let every = (f64::from(widest + 4 * FINE) / room).ceil().max(1.0) as usize;
        let others = self.ticks.iter_mut().enumerate().filter(|(k, _)| !k.is_multiple_of(every));
        others.for_each(|(_, (_, label))| label.clear());
        self
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, placed: &f64, (from, to): (i32, i32)) -> i32 {
        let part = (placed - self.low) / (self.high - self.low);
        from + (part * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        let light = hint.weight().allow_light_points();
        let ticks = self.ticks.iter().filter(|_| !light);
        ticks.map(|(tick, _)| *tick).collect()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, placed: &f64) -> String {
        let tick = self.ticks.iter().find(|(tick, _)| tick == placed);
        tick.map_or_else(String::new, |(_, label)| label.clone())
    }
}

fn linear(low: f64, high: f64, margin: f64, steps: f64) -> Axis {
    let size = low.abs().max(high.abs());
    let span = high - low;
    // Constant but for round-off: the axis then shows the value, not its last bits.
    let pad =
        if span <= 1e-9 * size || span < 1e-290 { if size > 1e-280 { 0.1 * size } else { 1.0 } } else { margin * span };
    let (low, high) = (low - pad, high + pad);
    let step = round_step((high - low) / steps);
    let ticks = ((low / step - 1e-9).ceil() as i64..=(high / step + 1e-9).floor() as i64)
        .map(|k| k as f64 * step)
        .collect::<Vec<_>>();
    let largest = ticks.iter().fold(0.0_f64, |max, tick| max.max(tick.abs()));
    let ticks = ticks.into_iter().map(|tick| (tick, linear_label(tick, step, largest))).collect();
    Axis { low, high, ticks, between: Vec::new() }
}

/// The smallest 1, 2 or 5 times a power of ten that is not below `least`.
fn round_step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    let factors = [1.0, 2.0, 5.0];
    let factor = factors.into_iter().find(|f| f * power >= least * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

fn linear_label(tick: f64, step: f64, largest: f64) -> String {
    let decimals = |step: f64| (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
    if tick == 0.0 {
        "0".into()
    } else if (1e-3..1e5).contains(&largest) {
        minus(format!("{tick:.*}", decimals(step)))
    } else {
        let exponent = (largest.log10() + 1e-9).floor();
        let unit = 10f64.powf(exponent);
        let mantissa = format!("{:.*}", decimals(step / unit), tick / unit);
        format!("{}·{}", minus(mantissa), power_of_ten(exponent as i32))
    }
}

/// A logarithmic axis that ends at 1, 2 or 5 times a power of ten; ticks there, or only at powers if there are many.
fn logarithmic(low: f64, high: f64) -> Axis {
    // Rounding must not leave the outermost values outside.
    let (mut low, mut high) = (one_two_five_below(low).min(low), (-one_two_five_below(-high)).max(high));
    if low == high {
        low = one_two_five_below(low - 0.1);
        high = -one_two_five_below(-(high + 0.1));
    }
    let stride = ((high - low) / 8.0).ceil().max(1.0) as i32;
    let factors: &[f64] = if high - low > 2.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let exponents = || low.floor() as i32..=high.ceil() as i32;
    let inside = |tick: &f64| (low - 1e-9..=high + 1e-9).contains(tick);
    let between = exponents()
        .filter(|_| stride == 1)
        .flat_map(|exponent| (2..10).map(move |factor| f64::from(exponent) + f64::from(factor).log10()))
        .filter(inside)
        .collect();
    // All labels of an axis have the same form.
    let plain = low >= -2.0 - 1e-9 && high <= 4.0 + 1e-9;
    let ticks = exponents()
        .filter(|exponent| exponent % stride == 0)
        .flat_map(|exponent| factors.iter().map(move |f| (*f, exponent)))
        .map(|(factor, exponent)| (f64::from(exponent) + factor.log10(), logarithmic_label(factor, exponent, plain)))
        .filter(|(tick, _)| inside(tick))
        .collect();
    Axis { low, high, ticks, between }
}

/// The largest logarithm of 1, 2 or 5 times a power of ten that is not above `logarithm`.
fn one_two_five_below(logarithm: f64) -> f64 {
    let power = (logarithm + 1e-9).floor();
    let rest = logarithm - power + 1e-9;
    let factors = [5f64.log10(), 2f64.log10(), 0.0];
    power + factors.into_iter().find(|f| *f <= rest).unwrap_or(0.0)
}

fn logarithmic_label(factor: f64, exponent: i32, plain: bool) -> String {
    if plain {
        let decimals = (-exponent).max(0) as usize;
        format!("{:.decimals$}", factor * 10f64.powi(exponent))
    } else if factor == 1.0 {
        match exponent {
            0 => "1".into(),
            exponent => power_of_ten(exponent),
        }
    } else {
        format!("{factor}·{}", power_of_ten(exponent))
    }
}

fn minus(number: String) -> String {
    number.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(values: &[f64], log: bool) -> Vec<String> {
        let placed = values.iter().map(|v| place(*v, log));
        let axis = Axis::over(placed, log, 0.0, STEPS);
        axis.ticks.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn linear_ticks_are_round() {
        assert_eq!(labels(&[0.0, 6.0], false), ["0", "1", "2", "3", "4", "5", "6"]);
        assert_eq!(labels(&[-0.2, 0.2], false), ["−0.2", "−0.1", "0", "0.1", "0.2"]);
        assert_eq!(labels(&[0.0, 3e-6], false)[1], "0.5·10⁻⁶");
        assert_eq!(labels(&[0.0, 1.2e6], false)[6], "1.2·10⁶");
    }

    #[test]
    fn logarithmic_ticks_are_powers() {
        assert_eq!(labels(&[1e-4, 1.0], true), ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "1"]);
        assert_eq!(labels(&[0.02, 1e3], true), ["0.1", "1", "10", "100", "1000"]);
        assert_eq!(labels(&[6.0, 40.0], true), ["5", "10", "20", "50"]);
        assert_eq!(labels(&[1e-30, 1e30], true).len(), 7);
        let axis = Axis::over([1e-4, 1.0].into_iter().map(|v| place(v, true)), true, 0.0, STEPS);
        assert_eq!(axis.between.len(), 4 * 8);
        assert!((axis.between[0] - 2e-4_f64.log10()).abs() < 1e-12);
        for value in (-6..7).flat_map(|k| [1.0, 2.0, 5.0].map(|factor| factor * 10f64.powi(k))) {
            let ends = [value, 30.0 * value].map(|v| place(v, true));
            let axis = Axis::over(ends.into_iter(), true, 0.0, STEPS);
            assert!(axis.low <= ends[0] && ends[1] <= axis.high, "{value}");
        }
    }

    #[test]
    fn ends_that_are_given_have_their_ticks() {
        let axis = Axis::exactly((0.4, 0.6), false);
        let labels: Vec<_> = axis.ticks.iter().map(|(_, label)| label.as_str()).collect();
        assert_eq!((labels.first(), labels.last()), (Some(&"0.40"), Some(&"0.60")), "{labels:?}");
    }

    #[test]
    fn any_values_give_a_few_ticks() {
        let odd = [0.0, -0.0, 1.0, -1.0, 5e-324, 1e-308, f64::MAX, f64::MIN, f64::INFINITY, f64::NAN, 1e300, -1e300];
        for a in odd {
            for b in odd {
                for log in [false, true] {
                    let axis = Axis::over([a, b].into_iter().map(|v| place(v, log)), log, 0.05, STEPS);
                    assert!(axis.low < axis.high, "{a} {b} {log}");
                    assert!((1..20).contains(&axis.ticks.len()), "{a} {b} {log}: {:?}", axis.ticks);
                }
            }
        }
        assert_eq!(labels(&[0.5, 0.5 + 1e-14], false), ["0.46", "0.48", "0.50", "0.52", "0.54"]);
    }

    #[test]
    fn labels_that_would_meet_are_left_out_and_the_first_stays() {
        let shown = |length: i32| -> Vec<bool> {
            let axis = logarithmic(-12.0, -4.0).legible(length * FINE);
            axis.ticks.iter().map(|(_, label)| !label.is_empty()).collect()
        };
        let long = shown(600);
        assert!(long.iter().all(|shown| *shown), "{long:?}");
        let short = shown(150);
        assert!(short[0] && short.iter().filter(|shown| **shown).count() < long.len(), "{short:?}");
    }
}
