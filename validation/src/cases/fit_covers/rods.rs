//! Points that are means over the same rods, and so move together (`--rods`).
//!
//! The rods of a repeat are those of twelve replicas at the middle node, drawn from the pool as those of the model are.
//! So the pool is all there is: its covariance is the right one. The example `fit_experiments` takes the rods of
//! another simulator.

use super::*;
use nalgebra::{DMatrix, DVector};

/// The index of the middle node among the inner ones.
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
}

/// The model's curve at the middle node less the mean of its replicas.
fn offset(pool: &Pool) -> DVector<f64> {
    let values =
        DMatrix::from_rows(&pool.replicas.iter().map(|one| one[3].row(MIDDLE).into_owned()).collect::<Vec<_>>());
    Emulator::new(&pool.basis, &pool.replicas).at(&[0.0]) - values.row_mean().transpose()
}

/// χ² per degree of freedom of a fit to new rods.
fn repeat((pool, offset): (&Pool, &DVector<f64>), treatment: Treatment, seed: u64) -> Result<f64, String> {
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
        offset[point] + rods
    });
    for point in &mut data {
        point.value += READING * rng.sample::<f64, _>(StandardNormal);
        point.u = READING;
    }
    let rods = Rods { over_measured: vec![1.0 / MEASURED as f64], ..Rods::none(0) };
    let fit = fit(&data, &pool.range, &rods, &pool.basis, &drawn)?;
    let goodness = &fit.best.goodness;
    Ok(goodness.chi_square_of_points() / goodness.freedom as f64)
}

static OFFSETS: Shared<(), DVector<f64>> = Shared::new();

/// The excess of χ² per degree of freedom to detect, and a bound of its deviation, (2/19)^½ = 0.32 in theory.
const EXCESS: f64 = 0.2;
const DEVIATION: f64 = 0.6;

pub(super) fn hold(treatment: &Treatment, effort: &Effort) -> Result<Evidence, String> {
    let pool = Result::clone(&SIMULATED.get(effort, (), || pool(effort)))?;
    let offset = OFFSETS.get(effort, (), || offset(&pool));
    let count = effort.samples(Design::new(EXCESS, DEVIATION));
    let seed = |k: u64| effort.seed(73).wrapping_add(k.wrapping_mul(0x9E37_79B9_7F4A_7C15));
    let below = |k: u64| Ok(1.0 - repeat((&pool, &offset), *treatment, seed(k))?);
    let below: Vec<f64> = lab::replicas::<_, Result<_, String>>(count, below)?;
    Ok(Evidence::on("1 − χ² per degree of freedom", "–")
        .exceeds(Sample::of(&below), -0.1, EXCESS)
        .because("with a tenth more a right model would be rejected twice as often as due"))
}
