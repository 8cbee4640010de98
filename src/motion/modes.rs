//! exp(Nτ) = a₀ + a₁N + a₂N², up to a factor, from the roots of N's characteristic equation.
//!
//! With the real root λ that is farthest from 0 and the pair m ± √Δ of the other roots, χ = (x − λ)((x − m)² − Δ), and
//!
//! exp(xτ) = h(x) + ((x − m)² − Δ)(e^{λτ} − h(λ))/χ′(λ),  h(x) = e^{mτ}(cosh √Δτ + (x − m) sinh √Δτ/√Δ)  modulo χ.
//!
//! h contains no root, and the formula is the same for a real, an equal and a complex pair; λ is well separated: if the
//! roots' sum is 0 and the largest of |c|^½ and |d|^⅓ is 1, χ′(λ) is never small (its minimum is 1.9, at c = −1, where
//! the pair coincides). So the kinds of flow need no distinction, and the only iteration is a Newton method that always
//! ends. For short times, where e^{λτ} − h(λ) would cancel, the series is used instead.

use super::ball::Ball;
use super::functions::{INVERSE_FACTORIALS, cosh_sinh_over, exp, sin_cos};

/// A time in the units of N.
#[derive(Clone, Copy, Debug)]
pub(super) struct Time {
    pub span: Ball,
    /// The time in periods, if it was given in periods: quarter turns are exact.
    pub turns: Option<Ball>,
}

/// The pair of roots m ± √Δ: `middle` is m, `square` is Δ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub middle: Ball,
    pub square: Ball,
}

/// The cubic λ³ − tλ² + cλ − d and its roots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cubic {
    /// A power of two near the larger of |c|^½ and |d|^⅓.
    size: f64,
    /// t, c and d in units of size, size² and size³.
    of_size: [Ball; 3],
    root: Ball,
    pair: Pair,
}

impl Pair {
    /// a₀, a₁ and a₂ of two coordinates without a factor e^{gτ}, and the rate g.
    pub fn coefficients(&self, time: Time) -> ([Ball; 3], Ball) {
        let (rate, cosh, sinh) = self.at(time);
        let coefficients = [cosh - self.middle * sinh, sinh, Ball::ZERO];
        (coefficients, self.middle + rate)
    }

    /// True if the pair is certainly complex.
    fn rotates(&self) -> bool {
        -self.square.hi > 2.0 * self.square.error
    }

    /// √Δ if the pair is real and the time is long, else 0; then cosh √Δτ and sinh √Δτ/√Δ, both divided by e to that
    /// rate times τ.
    fn at(&self, time: Time) -> (Ball, Ball, Ball) {
        let tau = time.span;
        let z = self.square * tau * tau;
        if z.most() <= 1.0 {
            let (cosh, sinh) = cosh_sinh_over(z);
            (Ball::ZERO, cosh, tau * sinh)
        } else if self.rotates() {
            let omega = (-self.square).sqrt();
            let turns = time.turns.unwrap_or_else(|| (omega * tau).over(Ball::TAU));
            let (sin, cos) = sin_cos(turns);
            (Ball::ZERO, cos, sin.over(omega))
        } else {
            // If Δ may be 0, its root and so the result are unknown.
            let root = if self.square.hi > 2.0 * self.square.error {
                self.square.sqrt()
            } else {
                Ball::ONE.widened(f64::INFINITY)
            };
            let other = exp((root * tau).scaled(-2.0));
            let sinh = (Ball::ONE - other).over(root).scaled(0.5);
            (root, (Ball::ONE + other).scaled(0.5), sinh)
        }
    }
}

impl Cubic {
    pub fn new(t: Ball, c: Ball, d: Ball) -> Self {
        let size = c.most().sqrt().max(libm::cbrt(d.most())).max(t.most());
        // The cube of this is still a normal number.
        let size = libm::scalbn(1.0, (libm::log2(size).ceil() as i32).max(-330));
        let inverse = size.recip();
        let of_size =
            [t.scaled(inverse), c.scaled(inverse).scaled(inverse), d.scaled(inverse).scaled(inverse).scaled(inverse)];
        let root = largest_root(of_size).scaled(size);
        let middle = (t - root).scaled(0.5);
        // The product of the pair is c − 2λm.
        let square = middle * middle - (c - (root * middle).scaled(2.0));
        Self { size, of_size, root, pair: Pair { middle, square } }
    }

    /// The period 2π/ω if the pair is certainly complex, and |λ − m|·2π/ω; else `None`.
    pub fn period(&self) -> Option<(Ball, f64)> {
        if !self.pair.rotates() {
            return None;
        }
        let period = Ball::TAU.over((-self.pair.square).sqrt());
        let drift = (self.root - self.pair.middle) * period;
        Some((period, drift.most()))
    }

    /// a₀, a₁ and a₂, all times the same positive factor.
    pub fn coefficients(&self, time: Time) -> [Ball; 3] {
        let tau = time.span;
        if self.size * tau.most() <= SHORT {
            return self.series(tau);
        }
        let Pair { middle, square } = self.pair;
        let (rate, cosh, sinh) = self.pair.at(time);
        // The larger of the two factors is left out.
        let lead = (self.root - middle) * tau - rate * tau;
        let (of_root, of_pair) = if lead.hi > 0.0 { (Ball::ONE, exp(-lead)) } else { (exp(lead), Ball::ONE) };
        let (cosh, sinh) = (of_pair * cosh, of_pair * sinh);
        let apart = self.root - middle;
        let rest = (of_root - (cosh + sinh * apart)).over(apart * apart - square);
        [cosh - middle * sinh + rest * (middle * middle - square), sinh - rest * middle.scaled(2.0), rest]
    }

    /// Σ (yT)ⁿ/n! modulo χ, with y in units of `size` and T = size·τ ≤ ½. |yⁿ| modulo χ grows by less than 2 a power.
    fn series(&self, tau: Ball) -> [Ball; 3] {
        let time = tau.scaled(self.size);
        let [t, c, d] = self.of_size;
        let mut sum = [Ball::ZERO; 3];
        for n in (0..TERMS).rev() {
            // y · (s₀ + s₁y + s₂y²), y³ = ty² − cy + d.
            let [s0, s1, s2] = sum.map(|s| s * time);
            sum = [d * s2 + INVERSE_FACTORIALS[n], s0 - c * s2, s1 + t * s2];
        }
        // Twice the first term that is left out; s₁ and s₂ also contain powers of the time.
        let left_out = 2.0 * INVERSE_FACTORIALS[TERMS].hi * libm::pow(2.0 * time.most(), TERMS as f64 - 2.0);
        let inverse = self.size.recip();
        let [s0, s1, s2] = sum;
        [
            s0.widened(left_out),
            s1.widened(left_out * time.most()).scaled(inverse),
            s2.widened(left_out * time.most().powi(2)).scaled(inverse).scaled(inverse),
        ]
    }
}

/// Times up to this, in units of 1/`size`, use the series.
const SHORT: f64 = 0.5;
/// Number of terms of the series: 2/30! < 10⁻³².
const TERMS: usize = 30;

/// The real root farthest from 0 of x³ − tx² + cx − d, for |c|, |d| ≤ 1 and t close to 0.
fn largest_root([t, c, d]: [Ball; 3]) -> Ball {
    if c.is_zero() && d.is_zero() {
        return Ball::ZERO;
    }
    let sign = if d.hi < 0.0 { -1.0 } else { 1.0 };
    // Starting beyond the root (at 4/3), where the cubic is convex, Newton's method descends to the root and never
    // passes it.
    let (c0, d0) = (c.hi, d.hi.abs());
    let mut x = 4.0 / 3.0;
    for _ in 0..200 {
        let next = x - (x * (x * x + c0) - d0) / (3.0 * x * x + c0);
        if next < x {
            x = next;
        } else {
            break;
        }
    }
    let value = |x: Ball| ((x - t) * x + c) * x - d;
    let slope = |x: Ball| (x.scaled(3.0) - t.scaled(2.0)) * x + c;
    let mut root = Ball::exact(sign * x);
    for _ in 0..2 {
        root = (root - value(root).over(slope(root))).middle();
    }
    // Within this distance the slope changes by less than half of itself; the factor 2 allows for this.
    let (least, off) = (slope(root).least(), value(root).most());
    let error = 2.0 * off / least;
    root.widened(if 16.0 * error <= least { error } else { f64::INFINITY })
}
