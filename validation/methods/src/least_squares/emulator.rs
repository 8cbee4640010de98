//! The model between the nodes: one polynomial for each measured point, and how far it may be off.

use super::basis::Basis;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use std::collections::HashMap;

/// What the model says of one measured point: at its time, and at √3 standard deviations of that time before and after.
pub type Prediction = [f64; 3];

/// Predictions of some points, each with the point's place among all.
pub type Predictions = Vec<(usize, Prediction)>;

/// Parts that have run in a replica, by what they depend on.
pub type Known = HashMap<Vec<u64>, Predictions>;

/// A part of the model with given parameters, as one of several suspensions.
pub struct Part {
    /// The values that its predictions depend on: of parts with the same values one runs. `None`: it always runs.
    pub depends_on: Option<Vec<u64>>,
    /// The predictions of a replica.
    pub run: Box<dyn Fn(u64) -> Result<Predictions, String> + Send + Sync>,
}

/// The model with given parameters, whose parts predict each point once.
pub struct Replica(pub Vec<Part>);

impl Replica {
    /// A model of one part, which predicts all points in their order.
    pub fn whole(run: impl Fn(u64) -> Result<Vec<Prediction>, String> + Send + Sync + 'static) -> Self {
        let run = move |replica| Ok(run(replica)?.into_iter().enumerate().collect());
        Self(vec![Part { depends_on: None, run: Box::new(run) }])
    }

    /// Every prediction of a replica, in the order of the points.
    ///
    /// # Errors
    ///
    /// Why a run was not finished.
    pub fn run(&self, replica: u64) -> Result<Vec<Prediction>, String> {
        self.run_beside(replica, &mut Known::new())
    }

    /// The same, without the parts that have run in this replica already: `known` gets those that run now.
    ///
    /// # Errors
    ///
    /// Why a run was not finished.
    pub fn run_beside(&self, replica: u64, known: &mut Known) -> Result<Vec<Prediction>, String> {
        let mut all = Vec::new();
        for part in &self.0 {
            if let Some(found) = part.depends_on.as_ref().and_then(|depends_on| known.get(depends_on)) {
                all.extend_from_slice(found);
                continue;
            }
            let found = (part.run)(replica)?;
            all.extend_from_slice(&found);
            known.extend(part.depends_on.clone().map(|depends_on| (depends_on, found)));
        }
        all.sort_unstable_by_key(|(point, _)| *point);
        Ok(all.into_iter().map(|(_, prediction)| prediction).collect())
    }
}

/// The model with parameters of these values. The same replica has the same random numbers whatever the values.
pub type Model<'a> = dyn Fn(&[f64]) -> Result<Replica, String> + Sync + 'a;

/// A place of the box on the scale of the ranges: both ends of each side.
pub type Sides = Vec<(f64, f64)>;

/// Standard errors beyond which a polynomial is off by more than the noise of the replicas.
const CERTAIN: f64 = 2.0;

/// The runs of a model at every node of a box. Polynomials are linear in what they run through, so that each replica has
/// polynomials of its own: their mean is the model, their scatter its error, and what replicas share between parameter
/// values cancels as it should.
#[derive(Clone, Debug)]
pub struct Emulator {
    /// The polynomials, and the nodes that they run through.
    pub basis: Basis,
    /// A row for each coefficient, a column for each point: of the mean over replicas, at, before and after.
    mean: [DMatrix<f64>; 3],
    /// Each replica's coefficients less the mean's, at.
    deviations: Vec<DMatrix<f64>>,
}

/// The coefficients of one replica: at, before and after.
pub type Coefficients = [DMatrix<f64>; 3];

/// Runs some replicas at every node of a box; `value` turns a node's coordinates into parameters. The order of the result
/// is that of the replicas, on any number of threads. A part that depends on the same at several nodes runs once in each replica.
pub fn coefficients(
    basis: &Basis,
    model: &Model<'_>,
    value: impl Fn(&[f64]) -> Vec<f64>,
    replicas: std::ops::Range<u64>,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Coefficients>, String> {
    let nodes = basis.nodes.iter().map(|node| model(&value(node)));
    let nodes = nodes.collect::<Result<Vec<_>, String>>()?;
    let one = |replica: u64| {
        let (mut rows, mut known) = (Vec::with_capacity(nodes.len()), Known::new());
        for node in &nodes {
            rows.push(node.run_beside(replica, &mut known)?);
            done();
        }
        let of = |which: usize| {
            DMatrix::from_fn(rows.len(), rows[0].len(), |node, point| rows[node][point][which])
        };
        Ok([0, 1, 2].map(|which| &basis.project * of(which)))
    };
    replicas.into_par_iter().map(one).collect()
}

impl Emulator {
    /// The emulator of these replicas, two at least.
    pub fn new(basis: &Basis, replicas: &[Coefficients]) -> Self {
        let share = 1.0 / replicas.len() as f64;
        let mean = |which: usize| {
            let first = &replicas[0][which];
            let zero = DMatrix::zeros(first.nrows(), first.ncols());
            replicas.iter().fold(zero, |sum, one| sum + &one[which]) * share
        };
        let at = mean(0);
        Self {
            basis: basis.clone(),
            deviations: replicas.iter().map(|one| &one[0] - &at).collect(),
            mean: [at, mean(1), mean(2)],
        }
    }

    /// Replicas behind it.
    pub fn replicas(&self) -> usize {
        self.deviations.len()
    }

    /// Measured points.
    pub fn points(&self) -> usize {
        self.mean().ncols()
    }

    /// Coefficients of the mean, a row for each term and a column for each point.
    pub fn mean(&self) -> &DMatrix<f64> {
        &self.mean[0]
    }

    /// Every prediction at a place of the box.
    pub fn at(&self, place: &[f64]) -> DVector<f64> {
        self.mean[0].tr_mul(&self.basis.terms(place))
    }

    /// The variance that an uncertain time gives each point: the mean of (S(t + ε) − S(t))² over a Gaussian ε by
    /// Gauss–Hermite's rule of three nodes, which is right on a peak too, where the slope alone would be 0.
    pub fn time_variance(&self, place: &[f64]) -> DVector<f64> {
        let terms = self.basis.terms(place);
        let [at, before, after] = [0, 1, 2].map(|which| self.mean[which].tr_mul(&terms));
        ((before - &at).map(|d| d * d) + (after - &at).map(|d| d * d)) / 6.0
    }

    /// How far polynomials of a degree less are from these, without what the replicas' noise adds to its square: that has its
    /// place in [`Emulator::covariance`].
    pub fn lack_of_fit(&self, place: &[f64]) -> DVector<f64> {
        let terms = self.basis.missed.tr_mul(&self.basis.terms(place));
        let n = self.replicas() as f64;
        let zero = DVector::zeros(self.points());
        let squares = (self.deviations.iter())
            .fold(zero, |sum, one| sum + one.tr_mul(&terms).map(|deviation| deviation * deviation));
        let own = |lack: f64, squares: f64| {
            lack.signum() * (lack * lack - CERTAIN.powi(2) * squares / (n * (n - 1.0))).max(0.0).sqrt()
        };
        self.mean().tr_mul(&terms).zip_map(&squares, own)
    }

    /// What the noise of the replicas adds on average to C V⁻¹ Cᵀ, where C are the mean's coefficients (a row for each term) and
    /// `inverse` is V⁻¹: terms × terms.
    pub fn noise(&self, inverse: &DMatrix<f64>) -> DMatrix<f64> {
        let n = self.replicas() as f64;
        let terms = self.mean().nrows();
        let one = |deviation: &DMatrix<f64>| deviation * inverse * deviation.transpose();
        let all: Vec<DMatrix<f64>> = self.deviations.par_iter().map(one).collect();
        let sum = all.iter().fold(DMatrix::zeros(terms, terms), |sum, one| sum + one);
        sum / (n * (n - 1.0))
    }

    /// The covariance of one replica's predictions, points × points.
    pub fn covariance(&self, place: &[f64]) -> DMatrix<f64> {
        let terms = self.basis.terms(place);
        let rows: Vec<_> = (self.deviations.iter()).map(|one| one.tr_mul(&terms).transpose()).collect();
        let spread = DMatrix::from_rows(&rows);
        spread.tr_mul(&spread) / (self.deviations.len() as f64 - 1.0)
    }

    /// The derivative of every prediction by every parameter, on the box's scale: points × parameters.
    pub fn slopes(&self, place: &[f64]) -> DMatrix<f64> {
        self.mean[0].tr_mul(&self.basis.slopes(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Two suspensions with a parameter each: the runs of either are those of its own values, and the answer is as if all had run.
    #[test]
    fn a_part_runs_once_for_each_of_its_own_values() {
        static RUNS: AtomicUsize = AtomicUsize::new(0);
        let model = |shared: bool| {
            move |values: &[f64]| -> Result<Replica, String> {
                let part = |set: usize| {
                    let value = values[set];
                    let run = move |replica: u64| {
                        RUNS.fetch_add(1, Ordering::Relaxed);
                        // Points of the two by turns.
                        Ok(vec![(set, [value + replica as f64; 3]), (2 + set, [value * value; 3])])
                    };
                    Part { depends_on: shared.then(|| vec![set as u64, value.to_bits()]), run: Box::new(run) }
                };
                Ok(Replica(vec![part(1), part(0)]))
            }
        };
        let basis = Basis::new(2);
        let found = |shared| {
            RUNS.store(0, Ordering::Relaxed);
            let found = coefficients(&basis, &model(shared), |node| node.to_vec(), 0..3, &|| ()).unwrap();
            (found, RUNS.load(Ordering::Relaxed))
        };
        let ((shared, fewer), (alone, all)) = (found(true), found(false));
        assert_eq!(shared, alone);
        let own = (basis.nodes.len() as f64).sqrt() as usize;
        assert_eq!((fewer, all), (3 * 2 * own, 3 * 2 * own * own));
    }
}
