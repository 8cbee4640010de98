//! Jeffery's motion in any velocity gradient to hundreds of bits: exp(Aτ) p by Taylor's series and squaring.
//!
//! L, r_e and p are taken as exact, A = (r_e² L − Lᵀ)/(r_e² + 1) less a third of its trace. The answer is computed
//! twice, the second time with 128 bits more; the bits are doubled until both agree to 90 bits, so that digits lost to
//! cancellation are replaced. The first computation has enough bits to hold A and A² together with their smallest
//! parts, so that two answers cannot agree because both lose the same part.

#[cfg(test)]
mod tests;

use crate::reference::big::{Big, Bits};
use crate::reference::motion::{Matrix as Square, Motion, image, matrix, product};
use std::array::from_fn;

/// The length of a rod's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// Units of strain: (2 D:D)^½ t.
    Strain(f64),
    /// Seconds.
    Seconds(f64),
    /// A number of periods 2π(r_e + 1/r_e)/G, as a quotient of whole numbers; the third is the shear rate G of Couette
    /// flow in 1/s.
    CouettePeriods(f64, f64, f64),
}

/// A rod in a liquid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// ∂u_i/∂x_j in 1/s, row i and column j.
    pub gradient_per_s: [[f64; 3]; 3],
    /// The aspect ratio r_e.
    pub aspect_ratio: f64,
    /// The initial direction; its length does not matter.
    pub p: [f64; 3],
}

/// Two answers whose directions differ by less than this are accepted: 2⁻⁹⁰.
const AGREED: f64 = 1.0 / (1u128 << 90) as f64;
const MOST_BITS: usize = 20_000;

impl Rod {
    /// The direction after `span`, with length 1 to double precision.
    ///
    /// # Panics
    /// If 20 000 bits do not settle it.
    pub fn after(&self, span: Span) -> [f64; 3] {
        (self.settled(span)).unwrap_or_else(|| panic!("{self:?} after {span:?} is not settled by {MOST_BITS} bits"))
    }

    /// The direction after `span`, or `None` if 20 000 bits do not settle it: the start is so near a dividing plane of
    /// the flow that more bits would be needed to see that it leaves.
    pub fn settled(&self, span: Span) -> Option<[f64; 3]> {
        let mut bits = self.bits_of_the_input();
        while bits < MOST_BITS {
            let (first, second) = (self.end(span, bits), self.end(span, bits + 128));
            if apart(&first, &second) <= AGREED {
                return Some(unit(&second));
            }
            bits *= 2;
        }
        None
    }

    /// 320 bits, and those that span the sizes of r_e⁴, 1 and the components.
    fn bits_of_the_input(&self) -> usize {
        let sizes = self.gradient_per_s.iter().flatten().filter(|x| **x != 0.0);
        let (least, most) =
            sizes.fold((f64::INFINITY, 0.0f64), |(least, most), x| (least.min(x.abs()), most.max(x.abs())));
        let spread = if most > 0.0 { 2.0 * (most.log2() - least.log2()) } else { 0.0 };
        320 + (4.0 * self.aspect_ratio.log2().abs() + spread).ceil() as usize
    }

    /// exp(Aτ)p, scaled such that the size of its largest component is between 1 and 2.
    fn end(&self, span: Span, bits: usize) -> [Big; 3] {
        let big = |x| Bits(bits).of(x);
        let l = self.gradient_per_s.map(|row| row.map(big));
        let square = big(self.aspect_ratio) * big(self.aspect_ratio);
        let below = &square + big(1.0);
        let third = (&l[0][0] + &l[1][1] + &l[2][2]) * (&square - big(1.0)) / big(3.0);
        let motion = Motion { gradient_per_s: self.gradient_per_s, aspect_ratio: self.aspect_ratio };
        let time = match span {
            Span::Seconds(time_s) => big(time_s),
            Span::Strain(strain) => big(strain) / motion.strain_rate_per_s(Bits(bits)),
            Span::CouettePeriods(periods, each, shear_rate_per_s) => {
                motion.strain_per_period(Bits(bits)) / big(shear_rate_per_s) * big(periods) / big(each)
            }
        };
        let exponent = matrix(|i, j| {
            let trace = if i == j { third.clone() } else { big(0.0) };
            (&square * &l[i][j] - &l[j][i] - trace) * &time / &below
        });
        scaled(image(&exponential(exponent, bits), &self.p.map(big)))
    }
}

/// exp(X) up to a factor: the series of X/2ˢ, squared s times.
fn exponential(mut x: Square, bits: usize) -> Square {
    // Down to 2⁻²⁴ a halving saves more terms of the series than its squaring costs.
    let halvings = (exponent(&x) + 2 + 24).max(0);
    for component in x.iter_mut().flatten() {
        *component = component.clone() >> halvings;
    }
    let size = exponent(&x) + 2;
    let mut map = matrix(|i, j| Bits(bits).of(f64::from(u8::from(i == j))));
    if size == isize::MIN + 2 {
        return map;
    }
    let mut term = map.clone();
    let mut left_bits = bits as isize;
    let mut n = 1.0;
    while left_bits > 0 {
        term = product(&term, &x);
        for component in term.iter_mut().flatten() {
            *component = component.clone() / Bits(bits).of(n);
        }
        for (sum, term) in map.iter_mut().flatten().zip(term.iter().flatten()) {
            *sum = sum.clone() + term;
        }
        n += 1.0;
        left_bits += size.min(-1);
    }
    for _ in 0..halvings {
        map = product(&map, &map);
        let size = exponent(&map);
        for component in map.iter_mut().flatten() {
            *component = component.clone() >> size;
        }
    }
    map
}

/// The exponent of the largest power of two ≤ |x|; the smallest integer for 0.
fn exponent_of(x: &Big) -> isize {
    if x.repr().significand().is_zero() { isize::MIN } else { x.repr().exponent() + x.digits() as isize - 1 }
}

/// The exponent of the largest power of two in the largest component.
fn exponent(x: &Square) -> isize {
    x.iter().flatten().map(exponent_of).max().unwrap_or(isize::MIN)
}

fn scaled(q: [Big; 3]) -> [Big; 3] {
    let largest = q.iter().map(exponent_of).max().unwrap_or(0);
    q.map(|component| component >> largest)
}

/// The sine of the angle between two vectors of about length 1.
fn apart(a: &[Big; 3], b: &[Big; 3]) -> f64 {
    let cross: [f64; 3] = from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        (&a[j] * &b[k] - &a[k] * &b[j]).to_f64().value()
    });
    cross.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn unit(q: &[Big; 3]) -> [f64; 3] {
    let q: [f64; 3] = from_fn(|i| q[i].to_f64().value());
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}
