//! Sums over rods, and the spread of the rods' values.

use super::{BLOCK, LANES, lane_sum, whole_or};
use fearless_simd::{Level, Simd, dispatch, f64x8, prelude::*};
use serde::{Deserialize, Serialize};

/// The sum of a value over rods, and the spread of the rods' values if standard errors over rods are wanted.
///
/// ```
/// use shearbed::observable::{Block, Observable, Observe, Sum};
/// let mut block = Block { len: 1, ..Block::default() };
/// block.p.iter_mut().zip([0.6, -0.8, 0.0]).for_each(|(axis, p)| axis[0] = p);
/// let mut sums = [Sum::default(); 3];
/// Observable::Projections.add(&block, &mut sums);
/// assert_eq!(sums.map(|sum| sum.value), [0.6, 0.8, 0.0]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sum {
    /// Σ f.
    pub value: f64,
    /// The spread of f over rods; `None` if the standard errors come from replicas.
    pub spread: Option<Spread>,
}

/// Sums of differences from the value of the first rod. If rods are nearly alike, differences keep the digits that Σf²
/// − (Σf)²/n loses: however far the first rod is from the mean, the squared error has a relative rounding of at most
/// about n ε, for (f₁ − ⟨f⟩)² is one of the squares in it.
///
/// ```
/// use shearbed::observable::Spread;
/// let mut spread = Spread::default();
/// [1.0, 1.0, 1.0, 5.0].into_iter().for_each(|value| spread.add(&[value]));
/// // Mean 2, squared deviations 1 + 1 + 1 + 9, over 4 − 1 and over 4.
/// assert_eq!(spread.standard_error(), 1.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    rods: u64,
    /// f₁, the value of the first rod.
    first: f64,
    /// Σ (f − f₁).
    differences: f64,
    /// Σ (f − f₁)².
    squares: f64,
}

impl Sum {
    /// The sum over no rods; `spread` says whether standard errors over rods are wanted.
    pub(crate) fn none(spread: bool) -> Self {
        Self { value: 0.0, spread: spread.then(Spread::default) }
    }

    /// True if the sum, and the sum of squares where kept, is finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.value.is_finite() && self.spread.is_none_or(|spread| spread.is_finite())
    }

    /// True if this can be a sum over `rods` rods; `spread` says whether standard errors over rods are wanted.
    pub(crate) fn is_over(&self, rods: usize, spread: bool) -> bool {
        let own = match self.spread {
            Some(found) => spread && found.rods == rods as u64,
            None => !spread,
        };
        own && self.is_finite()
    }

    /// Adds a sum over other rods.
    pub(crate) fn merge(&mut self, other: &Self) {
        self.value += other.value;
        if let (Some(spread), Some(other)) = (&mut self.spread, &other.spread) {
            spread.merge(other);
        }
    }

    /// Adds the values f(0), …, f(len − 1) of a block's rods.
    #[inline]
    pub fn add_each(&mut self, len: usize, f: impl Fn(usize) -> f64) {
        match &mut self.spread {
            None => self.value += lane_sum(len, f),
            Some(spread) => self.value += spread.add_each(len, f),
        }
    }
}

/// Σ (f − first), Σ (f − first)² and Σ f, in the lanes of [`lane_sum`]; side by side, so that no sum waits for its own
/// last add.
#[inline(always)]
fn moments<S: Simd>(simd: S, values: &[f64], first: f64) -> [f64; 3] {
    let mut sums = [f64x8::splat(simd, 0.0); 3];
    let mut eights = values.chunks_exact(LANES);
    for eight in &mut eights {
        let value = f64x8::from_slice(simd, eight);
        let difference = value - first;
        sums = [sums[0] + value, sums[1] + difference, sums[2] + difference * difference];
    }
    let [mut sum, mut differences, mut squares] = [[0.0; LANES]; 3];
    sums[0].store_slice(&mut sum);
    sums[1].store_slice(&mut differences);
    sums[2].store_slice(&mut squares);
    for (lane, value) in eights.remainder().iter().enumerate() {
        let difference = value - first;
        sum[lane] += value;
        differences[lane] += difference;
        squares[lane] += difference * difference;
    }
    [differences.iter().sum(), squares.iter().sum(), sum.iter().sum()]
}

impl Spread {
    /// Adds the values of up to [`BLOCK`] rods.
    #[inline]
    pub fn add(&mut self, values: &[f64]) {
        self.add_each(values.len(), |i| values[i]);
    }

    /// Adds the values f(0), …, f(len − 1) and returns their sum.
    #[inline]
    fn add_each(&mut self, len: usize, f: impl Fn(usize) -> f64) -> f64 {
        if self.rods == 0 && len > 0 {
            self.first = f(0);
        }
        let first = self.first;
        let [differences, squares, sum] = dispatch!(Level::new(), simd => whole_or(
            len,
            #[inline(always)]
            |len| {
                let mut values = [0.0; BLOCK];
                values[..len].iter_mut().enumerate().for_each(|(i, value)| *value = f(i));
                moments(simd, &values[..len], first)
            },
        ));
        self.differences += differences;
        self.squares += squares;
        self.rods += len as u64;
        sum
    }

    /// Adds the sums over other rods.
    pub fn merge(&mut self, other: &Self) {
        if self.rods == 0 {
            *self = *other;
            return;
        }
        // The differences of `other`, taken from this first rod.
        let (n, apart) = (other.rods as f64, other.first - self.first);
        self.differences += other.differences + n * apart;
        self.squares += other.squares + apart * (2.0 * other.differences + n * apart);
        self.rods += other.rods;
    }

    /// The standard error of the mean over the rods; NaN for one rod.
    pub fn standard_error(&self) -> f64 {
        let n = self.rods as f64;
        let squared_deviations = self.squares - self.differences * self.differences / n;
        (squared_deviations.max(0.0) / n / (n - 1.0)).sqrt()
    }

    fn is_finite(&self) -> bool {
        [self.first, self.differences, self.squares].iter().all(|x| x.is_finite())
    }
}
