//! Numbers with an error bound: the sum of two doubles (106 bits) and a bound on its distance from the true value.
//!
//! Sums and products of double-doubles: Joldes, Muller & Popescu 2017, algorithms 6 (relative error 3 u²) and 11 (5
//! u²), u = 2⁻⁵³; errors propagate as in interval arithmetic. Results that a double-double holds exactly have no error,
//! so that 0 stays 0.

use std::ops::{Add, Mul, Neg, Sub};

/// Exceeds every relative rounding error in this file, with a margin for the rounding of the bound itself.
const ROUNDING: f64 = 1.0 / (1u128 << 102) as f64;
/// A bound on the error of a product that underflows.
const UNDERFLOW: f64 = 1e-320;
const IN_DANGER: f64 = 1e-280;

/// The number hi + lo with an absolute error of at most `error`. An unknown value has an infinite or NaN error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The value, rounded to double.
    pub hi: f64,
    /// The value less `hi`.
    pub lo: f64,
    /// The bound on the absolute error.
    pub error: f64,
}

impl Ball {
    pub const ZERO: Self = Self::exact(0.0);
    pub const ONE: Self = Self::exact(1.0);
    /// 2π.
    pub const TAU: Self = Self { hi: std::f64::consts::TAU, lo: 2.449_293_598_294_706_4e-16, error: 8.0 * ROUNDING };
    /// ln 2.
    pub const LN_2: Self = Self { hi: std::f64::consts::LN_2, lo: 2.319_046_813_846_299_6e-17, error: ROUNDING };

    /// The double `x`, without error.
    pub const fn exact(x: f64) -> Self {
        Self { hi: x, lo: 0.0, error: 0.0 }
    }

    /// The same number with `error` added to its bound.
    pub fn widened(self, error: f64) -> Self {
        Self { error: self.error + error, ..self }
    }

    /// True if the number is exactly 0.
    pub fn is_zero(self) -> bool {
        self.hi == 0.0 && self.error == 0.0
    }

    fn is_double(self) -> bool {
        self.lo == 0.0 && self.error == 0.0
    }

    /// An upper bound of |x|.
    pub fn most(self) -> f64 {
        (self.hi.abs() + self.error) * (1.0 + 2.0 * f64::EPSILON)
    }

    /// A lower bound of |x|; 0 if the number may be 0.
    pub fn least(self) -> f64 {
        let least = (self.hi.abs() - self.error) * (1.0 - 2.0 * f64::EPSILON);
        if least > 0.0 { least } else { 0.0 }
    }

    /// The same number with error 0.
    pub fn middle(self) -> Self {
        Self { error: 0.0, ..self }
    }

    /// The number times `power`, a power of two.
    pub fn scaled(self, power: f64) -> Self {
        let scaled = Self { hi: self.hi * power, lo: self.lo * power, error: self.error * power };
        if self.hi != 0.0 && scaled.hi.abs() < IN_DANGER { scaled.widened(UNDERFLOW) } else { scaled }
    }

    /// The number times 2^`power`, also where 2^`power` is not a double.
    pub fn shifted(self, power: i32) -> Self {
        let [hi, lo, error] = [self.hi, self.lo, self.error].map(|x| libm::scalbn(x, power));
        let shifted = Self { hi, lo, error };
        if !self.is_zero() && hi.abs() < IN_DANGER { shifted.widened(UNDERFLOW) } else { shifted }
    }

    /// The quotient; its error is infinite or NaN if the divisor may be 0.
    pub fn over(self, other: Self) -> Self {
        if self.is_zero() && other.least() > 0.0 {
            return Self::ZERO;
        }
        let first = self.hi / other.hi;
        let rest = self.middle() - Self::exact(first) * other.middle();
        if self.is_double() && other.is_double() && rest.is_zero() {
            return Self::exact(first);
        }
        let second = rest.hi / other.hi;
        let third = (rest - Self::exact(second) * other.middle()).hi / other.hi;
        let (hi, lo) = quick_two_sum(first, second);
        let (hi, lo) = quick_two_sum(hi, lo + third);
        let carried = (self.error + hi.abs() * other.error) / other.least();
        let danger = if hi.abs() < IN_DANGER { UNDERFLOW } else { 0.0 };
        // The rest is known to a few u² of |self|, and the quotient to as much relative to itself.
        Self { hi, lo, error: carried * (1.0 + 8.0 * f64::EPSILON) + 4.0 * ROUNDING * hi.abs() + danger }
    }

    /// The square root; the part of the ball below 0 is ignored.
    pub fn sqrt(self) -> Self {
        if self.hi <= self.error {
            return Self::ZERO.widened((2.0 * self.most()).sqrt());
        }
        let first = self.hi.sqrt();
        let rest = self.middle() - Self::exact(first) * Self::exact(first);
        let (hi, lo) = quick_two_sum(first, 0.5 * rest.hi / first);
        let root = Self { hi, lo, error: 0.0 };
        root.widened(self.error / hi * (1.0 + 8.0 * f64::EPSILON) + 4.0 * ROUNDING * hi)
    }
}

fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// The sum of `a` and `b` and its rounding error, for |a| ≥ |b|.
fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// Dekker's product: avoids a fused multiply-add, which is a function call if the machine may lack the instruction.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let (a_high, a_low) = halves(a);
    let (b_high, b_low) = halves(b);
    let product = a * b;
    let rest = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
    (product, rest)
}

fn halves(a: f64) -> (f64, f64) {
    const SPLIT: f64 = (1u64 << 27) as f64 + 1.0;
    let shifted = SPLIT * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

impl Add for Ball {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        let (sum, rest) = two_sum(self.hi, other.hi);
        let carried = self.error + other.error;
        if self.is_double() && other.is_double() {
            return Self { hi: sum, lo: rest, error: 0.0 };
        }
        let (low, low_rest) = two_sum(self.lo, other.lo);
        let (hi, lo) = quick_two_sum(sum, rest + low);
        let (hi, lo) = quick_two_sum(hi, low_rest + lo);
        Self { hi, lo, error: carried * (1.0 + 4.0 * f64::EPSILON) + ROUNDING * hi.abs() }
    }
}

impl Sub for Ball {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Ball {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::ZERO;
        }
        let (product, rest) = two_product(self.hi, other.hi);
        let danger = if product.abs() < IN_DANGER { UNDERFLOW } else { 0.0 };
        if self.is_double() && other.is_double() {
            return Self { hi: product, lo: rest, error: danger };
        }
        let (hi, lo) = quick_two_sum(product, rest + (self.hi * other.lo + self.lo * other.hi));
        // |lo| ≤ ε|hi|: this bound is a little larger than the product's own terms.
        let carried = self.hi.abs() * other.error + other.hi.abs() * self.error + self.error * other.error;
        Self { hi, lo, error: carried * (1.0 + 8.0 * f64::EPSILON) + ROUNDING * hi.abs() + danger }
    }
}

impl Neg for Ball {
    type Output = Self;
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo, error: self.error }
    }
}

#[cfg(test)]
mod tests;
