//! Points that are means over the same rods, and so move together: the scatter of these rods beside their uncertainties (`--rods`), or
//! within them.
//!
//! The rods of a repeat are those of twelve replicas at the middle node, drawn from the pool as those of the model are. So the pool is all
//! there is: its covariance is the right one. The example `fit_experiments` takes the rods of another simulator.

use super::{CONFIDENCES, DRAWN, Pool, SIMULATED, data, pool};
use crate::judge::accept::Design;
use crate::judge::case::{Effort, Evidence};
use crate::judge::lab::Shared;
use crate::judge::statistics::Sample;
use crate::methods::least_squares::emulator::{Coefficients, Emulator};
use crate::methods::least_squares::likelihood::Rods;
use crate::serve::fit::search::{Measured, fitted};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;

/// The α of the middle node.
const PLANTED: f64 = 1.0;
/// Its index among the inner nodes.
const MIDDLE: usize = 1;
/// Replicas whose rods are measured: 300 rods. With fewer, V varies with α over its uncertainty, which raises χ².
const MEASURED: usize = 12;
/// One standard deviation of reading a point, less than the scatter of these rods.
const READING: f64 = 0.002;

/// The treatment of the scatter of rods; all but the first are mistakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Treatment {
    AsItIs,
    /// Rods scatter as the polynomials of replicas do.
    OfPolynomials,
    /// The points count as independent.
    Independent,
}

/// Where the scatter of rods is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scatter {
    BesideU,
    InU,
}

impl Scatter {
    fn name(self) -> &'static str {
        match self {
            Self::BesideU => "scatter beside u",
            Self::InU => "scatter in u",
        }
    }
}

/// Whether the intervals hold the planted α, and χ² per degree of freedom.
type Repeat = ([bool; 2], f64);

/// What the repeats share.
struct Middle {
    /// The variance of a mean over the measured rods.
    variance: Vec<f64>,
    /// The model's curve less the mean of its replicas.
    offset: DVector<f64>,
}

fn middle(pool: &Pool) -> Middle {
    let values = DMatrix::from_rows(
        &pool.replicas.iter().map(|one| one[3].row(MIDDLE).into_owned()).collect::<Vec<_>>(),
    );
    Middle {
        variance: values.column_iter().map(|of| of.variance() / MEASURED as f64).collect(),
        offset: Emulator::new(&pool.basis, &pool.replicas).at(&[0.0]) - values.row_mean().transpose(),
    }
}

fn repeat(
    (pool, middle): (&Pool, &Middle),
    treatment: Treatment,
    scatter: Scatter,
    seed: u64,
) -> Result<Repeat, String> {
    let mut rng = Pcg64Dxsm::seed_from_u64(seed);
    let mut draw = |count: usize| -> Vec<&Coefficients> {
        (0..count).map(|_| &pool.replicas[rng.random_range(0..pool.replicas.len())]).collect()
    };
    let own = draw(MEASURED);
    let mut drawn: Vec<Coefficients> = draw(DRAWN).into_iter().cloned().collect();
    if treatment == Treatment::OfPolynomials {
        for one in &mut drawn {
            let at = |node: &usize| one[0].tr_mul(&pool.basis.terms(&pool.basis.nodes[*node])).transpose();
            one[3] = DMatrix::from_rows(&pool.basis.inner.iter().map(at).collect::<Vec<_>>());
        }
    }
    let mut data = data(|point| {
        let rods = own.iter().map(|one| one[3][(MIDDLE, point)]).sum::<f64>() / MEASURED as f64;
        middle.offset[point] + rods
    });
    for (point, variance) in data.iter_mut().zip(&middle.variance) {
        point.value += READING * rng.sample::<f64, _>(StandardNormal);
        point.u = match scatter {
            Scatter::BesideU => READING,
            _ => READING.hypot(variance.sqrt()),
        };
    }
    let rods = match treatment {
        Treatment::Independent => Rods::none(1),
        _ => Rods { over_measured: vec![1.0 / MEASURED as f64], in_u: scatter == Scatter::InU },
    };
    let range = pool.range.clone();
    let sides = vec![(range.from, range.to)];
    let fit = fitted(&Measured { data: &data, ranges: &[range], rods: &rods }, &pool.basis, &sides, &drawn)?;
    let inside = CONFIDENCES.map(|confidence| {
        let found = fit.interval(0, confidence);
        (found.low..=found.high).contains(&PLANTED)
    });
    let goodness = &fit.best.goodness;
    Ok((inside, goodness.chi_square_of_points() / goodness.freedom as f64))
}

static MIDDLES: Shared<(), Middle> = Shared::new();

/// Allowed difference from the stated shares: u of a pool of few replicas, and a model that is curved over the interval.
const ALLOWANCE: [f64; 2] = [0.04, 0.02];
/// The effect to detect beyond that: points taken for independent miss 0.3.
const EFFECT: f64 = 0.2;
/// The excess of χ² per degree of freedom to detect, and a bound of its deviation, (2/19)^½ = 0.32 in theory.
const EXCESS: f64 = 0.2;
const DEVIATION: f64 = 0.6;

pub(super) fn hold(treatment: &Treatment, effort: &Effort) -> Result<Vec<Evidence>, String> {
    let pool = SIMULATED.get(effort, (), || pool(effort));
    let pool = pool.as_ref().as_ref().map_err(Clone::clone)?;
    let middle = MIDDLES.get(effort, (), || middle(pool));
    let count = effort.samples(Design::new(EFFECT, 0.5)).max(effort.samples(Design::new(EXCESS, DEVIATION)));
    // A mistake shows in one of them.
    let scatters: &[Scatter] = match treatment {
        Treatment::AsItIs => &[Scatter::BesideU, Scatter::InU],
        Treatment::OfPolynomials => &[Scatter::BesideU],
        Treatment::Independent => &[Scatter::InU],
    };
    let mut all = Vec::new();
    for scatter in scatters {
        let seed = |k: u64| effort.seed(73).wrapping_add(k.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let repeats: Vec<Repeat> = (0..count)
            .into_par_iter()
            .map(|k| repeat((pool, &middle), *treatment, *scatter, seed(k)))
            .collect::<Result<_, _>>()?;
        if *scatter == Scatter::BesideU {
            let below: Vec<f64> = repeats.iter().map(|(_, ratio)| 1.0 - ratio).collect();
            let because = "with a tenth more a right model would be rejected twice as often as due";
            all.push(Evidence::new(
                "1 − χ² per degree of freedom",
                Sample::of(&below).exceeds(-0.1, EXCESS, because),
            ));
        }
        for (k, confidence) in CONFIDENCES.into_iter().enumerate() {
            let shares: Vec<f64> = repeats.iter().map(|(inside, _)| f64::from(u8::from(inside[k]))).collect();
            let what =
                format!("share of {:.0} % intervals that hold α, {}", 100.0 * confidence, scatter.name());
            let because = "the level; u is known from a pool of replicas";
            all.push(Evidence::new(what, Sample::of(&shares).is(confidence, ALLOWANCE[k], EFFECT, because)));
        }
    }
    Ok(all)
}
