//! Binary numbers of any precision, their input and output.
//!
//! Arithmetic and elementary functions of the crate `dashu-float` are correctly rounded; the result of an operation has
//! the larger of its operands' precisions.

use dashu_float::{DBig, FBig, ops::EstimatedLog2, round::mode::HalfEven};
use std::cmp::Ordering;
use std::str::FromStr;
use std::sync::LazyLock;

/// A binary number of any precision and size.
pub type Big = FBig<HalfEven, 2>;

/// The precision of a calculation in bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bits(pub usize);

impl Bits {
    /// The double `x`, exactly, for a calculation of this precision.
    ///
    /// # Panics
    /// If `x` is not finite.
    pub fn of(self, x: f64) -> Big {
        let exact = Big::try_from(x).expect("a finite number");
        self.round(exact)
    }

    /// π to this precision.
    pub fn pi(self) -> Big {
        static PI: LazyLock<Big> = LazyLock::new(|| Big::pi(1024));
        if self.0 < 1000 { self.round(PI.clone()) } else { Big::pi(self.0) }
    }

    /// `x` rounded to this precision.
    pub fn round(self, x: Big) -> Big {
        x.with_precision(self.0).value()
    }
}

/// |log₂|x|| rounded up, the distance of |x| from 1 in powers of two; 0 for 0.
pub fn magnitude(x: f64) -> usize {
    if x == 0.0 { 0 } else { x.abs().log2().abs().ceil() as usize }
}

/// The nearest double.
pub fn double(x: &Big) -> f64 {
    x.to_f64().value()
}

/// The nearest double; never a negative zero.
pub fn number(x: &Big) -> f64 {
    double(x) + 0.0
}

/// The double nearest to a decimal number; `None` if there is none: if a number other than 0 would become 0 or
/// infinite.
pub fn finite(text: &str) -> Option<f64> {
    let text = text.trim();
    let x = text.parse::<f64>().ok().filter(|x| x.is_finite())?;
    let digits = text.split(['e', 'E']).next().unwrap_or(text);
    (x != 0.0 || !digits.contains(|c: char| ('1'..='9').contains(&c))).then_some(x)
}

/// A decimal number as written, exact to 400 bits; `None` where [`finite`] has none: the time and memory of a power of
/// ten grow with its exponent.
pub fn decimal(text: &str) -> Option<Big> {
    if finite(text)? == 0.0 {
        return Some(Bits(400).of(0.0));
    }
    let exact = DBig::from_str(text.trim().trim_start_matches('+')).ok()?;
    Some(exact.with_rounding::<HalfEven>().with_base_and_precision::<2>(400).value())
}

/// `x` with `digits` significant decimal digits, as `1.2345e-6`, without trailing zeros; 0 as `0`.
pub fn digits(x: &Big, digits: usize) -> String {
    if *x == Big::ZERO {
        return "0".into();
    }
    // Powers of ten are rounded, so it takes more bits than the digits hold. (The crate's change of base takes half a
    // millisecond.)
    let bits = Bits(4 * digits + 80);
    let size = bits.round(x.sqr().sqrt());
    let mut exponent = (f64::from(size.log2_est()) * std::f64::consts::LOG10_2).floor() as i64;
    let whole = loop {
        let scale = bits.of(10.0).powi((digits as i64 - 1 - exponent).into());
        let whole = (&size * scale).to_int().value().to_string();
        // The estimate may be off by one, and rounding may carry into one more digit.
        match whole.len().cmp(&digits) {
            Ordering::Less => exponent -= 1,
            Ordering::Greater => exponent += 1,
            Ordering::Equal => break whole,
        }
    };
    let (first, rest) = whole.split_at(1);
    let rest = rest.trim_end_matches('0');
    let sign = if *x < Big::ZERO { "-" } else { "" };
    let point = if rest.is_empty() { "" } else { "." };
    format!("{sign}{first}{point}{rest}e{exponent}")
}

/// The angle in rad from the first axis to (x, y), from −π to π.
pub fn angle(y: &Big, x: &Big) -> Big {
    y.atan2(x)
}

/// √(x² + y² + z²).
pub fn length([x, y, z]: &[Big; 3]) -> Big {
    (x.sqr() + y.sqr() + z.sqr()).sqrt()
}

/// Calls `each` with the powers of `base` from 0 to `right`, then from −1 to −`left`: the nodes of the trapezoid rule
/// in ln x.
pub(super) fn each_power(one: &Big, base: &Big, left: usize, right: usize, mut each: impl FnMut(&Big)) {
    let inverse = one / base;
    let mut x = one.clone();
    for _ in 0..=right {
        each(&x);
        x *= base;
    }
    x = one.clone();
    for _ in 0..left {
        x *= &inverse;
        each(&x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_and_written_exactly() {
        for (text, expected) in [
            ("0.1", 0.1),
            ("-1e-300", -1e-300),
            ("+2.5", 2.5),
            ("1e3", 1000.0),
            ("0", 0.0),
            (" 7 ", 7.0),
            ("-0.00e-999999999", 0.0),
        ] {
            assert_eq!(double(&decimal(text).unwrap()), expected, "{text}");
        }
        for text in ["", "nan", "inf", "1e400", "1e-400", "1e-1000000", "0x10", "1,5", "1_0", "--1"] {
            assert!(decimal(text).is_none(), "{text}");
        }
        // 0.1 is not the double 0.1.
        assert!(decimal("0.1").unwrap() != Bits(400).of(0.1));
        let third = Bits(200).of(1.0) / Bits(200).of(3.0);
        assert_eq!(digits(&third, 22), "3.333333333333333333333e-1");
        assert_eq!(digits(&-(&third * Bits(200).of(1e-30)), 5), "-3.3333e-31");
        assert_eq!(digits(&Bits(200).of(0.0), 22), "0");
        assert_eq!(digits(&Bits(200).of(1e22), 22), "1e22");
        assert_eq!(digits(&(Bits(200).of(1.0) - Bits(200).of(1e-30)), 22), "1e0");
        // Numbers of all sizes, compared with the crate's own change of base.
        for k in -320..=300 {
            let x = &third * Bits(200).of(10.0).powi(k.into()) * Bits(200).of(1.0 + 0.001 * f64::from(k));
            let decimal = x.clone().with_base_and_precision::<10>(22).value();
            assert_eq!(digits(&x, 22), format!("{decimal:e}"), "{k}");
        }
        assert_eq!((magnitude(1.0), magnitude(0.3), magnitude(-1000.0), magnitude(0.0)), (0, 2, 10, 0));
    }
}
