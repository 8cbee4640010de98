//! Numbers that know their error: the sum of two doubles (106 bits), with a bound on how far the true value is from it.
//!
//! Sums and products of double-doubles: Joldes, Muller & Popescu 2017, algorithms 6 (relative error 3 u²) and 11 (5 u²),
//! u = 2⁻⁵³; errors are carried on as in interval arithmetic. What double-double holds exactly stays exact, so that 0 is 0.

use std::ops::{Add, Mul, Neg, Sub};

/// More than every relative rounding error here, with room for the rounding of the bound itself.
const ROUNDING: f64 = 1.0 / (1u128 << 102) as f64;
/// A bound on what a product loses below the smallest normal number.
const UNDERFLOW: f64 = 1e-320;
const IN_DANGER: f64 = 1e-280;

/// hi + lo, off by at most `error`. A value that is not known has an infinite or no error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// The value, rounded to double.
    pub hi: f64,
    /// The rest.
    pub lo: f64,
    /// The bound on the error.
    pub error: f64,
}

impl Ball {
    pub const ZERO: Self = Self::exact(0.0);
    pub const ONE: Self = Self::exact(1.0);
    /// 2π.
    pub const TAU: Self =
        Self { hi: std::f64::consts::TAU, lo: 2.449_293_598_294_706_4e-16, error: 8.0 * ROUNDING };
    /// ln 2.
    pub const LN_2: Self =
        Self { hi: std::f64::consts::LN_2, lo: 2.319_046_813_846_299_6e-17, error: ROUNDING };

    /// A double.
    pub const fn exact(x: f64) -> Self {
        Self { hi: x, lo: 0.0, error: 0.0 }
    }

    /// The same with `error` more of error.
    pub fn widened(self, error: f64) -> Self {
        Self { error: self.error + error, ..self }
    }

    /// True if it is exactly 0.
    pub fn is_zero(self) -> bool {
        self.hi == 0.0 && self.error == 0.0
    }

    fn is_double(self) -> bool {
        self.lo == 0.0 && self.error == 0.0
    }

    /// The most that its size can be.
    pub fn most(self) -> f64 {
        (self.hi.abs() + self.error) * (1.0 + 2.0 * f64::EPSILON)
    }

    /// The least that its size can be, 0 where it may be 0.
    pub fn least(self) -> f64 {
        let least = (self.hi.abs() - self.error) * (1.0 - 2.0 * f64::EPSILON);
        if least > 0.0 { least } else { 0.0 }
    }

    /// Without its error: as if it were exact.
    pub fn middle(self) -> Self {
        Self { error: 0.0, ..self }
    }

    /// Times a power of two.
    pub fn scaled(self, power: f64) -> Self {
        let scaled = Self { hi: self.hi * power, lo: self.lo * power, error: self.error * power };
        if self.hi != 0.0 && scaled.hi.abs() < IN_DANGER { scaled.widened(UNDERFLOW) } else { scaled }
    }

    /// Times 2 to a power that need not be a double.
    pub fn shifted(self, power: i32) -> Self {
        let [hi, lo, error] = [self.hi, self.lo, self.error].map(|x| libm::scalbn(x, power));
        let shifted = Self { hi, lo, error };
        if !self.is_zero() && hi.abs() < IN_DANGER { shifted.widened(UNDERFLOW) } else { shifted }
    }

    pub fn plus(self, other: Self) -> Self {
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

    pub fn times(self, other: Self) -> Self {
        if self.is_zero() || other.is_zero() {
            return Self::ZERO;
        }
        let (product, rest) = two_product(self.hi, other.hi);
        let danger = if product.abs() < IN_DANGER { UNDERFLOW } else { 0.0 };
        if self.is_double() && other.is_double() {
            return Self { hi: product, lo: rest, error: danger };
        }
        let (hi, lo) = quick_two_sum(product, rest + (self.hi * other.lo + self.lo * other.hi));
        // |lo| ≤ ε|hi|: a little more than the product's own terms.
        let carried = self.hi.abs() * other.error + other.hi.abs() * self.error + self.error * other.error;
        Self { hi, lo, error: carried * (1.0 + 8.0 * f64::EPSILON) + ROUNDING * hi.abs() + danger }
    }

    /// The quotient; not known where the divisor may be 0.
    pub fn over(self, other: Self) -> Self {
        if self.is_zero() && other.least() > 0.0 {
            return Self::ZERO;
        }
        let first = self.hi / other.hi;
        let rest = self.middle().plus(Self::exact(-first).times(other.middle()));
        if self.is_double() && other.is_double() && rest.is_zero() {
            return Self::exact(first);
        }
        let second = rest.hi / other.hi;
        let third = rest.plus(Self::exact(-second).times(other.middle())).hi / other.hi;
        let (hi, lo) = quick_two_sum(first, second);
        let (hi, lo) = quick_two_sum(hi, lo + third);
        let carried = (self.error + hi.abs() * other.error) / other.least();
        let danger = if hi.abs() < IN_DANGER { UNDERFLOW } else { 0.0 };
        // The rest is known to some u² of |self|, and the quotient to as much of itself.
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

/// For |a| ≥ |b|.
fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// Dekker's product: no fused multiply-add, which is a call where the machine's is not known to be there.
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
        self.plus(other)
    }
}

impl Sub for Ball {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self.plus(-other)
    }
}

impl Mul for Ball {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        self.times(other)
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
