//! The model between the nodes: a polynomial for each measured point, and an estimate of its error.

use super::basis::Basis;
use nalgebra::{DMatrix, DVector, RowDVector};
use rayon::prelude::*;
use std::collections::HashMap;

/// The model's prediction of a measured point: at its time, and at √3 standard deviations of that time before and
/// after.
pub type Prediction = [f64; 3];

/// Predictions of some points, each with the point's index among all points.
pub type Predictions = Vec<(usize, Prediction)>;

/// Results of the parts that have run in a replica, by the values that they depend on.
pub type Known = HashMap<Vec<u64>, Predictions>;

/// A part of the model with given parameters, such as one of several suspensions.
pub struct Part {
    /// The values that the predictions depend on: parts with equal values run once. `None`: the part always runs.
    pub depends_on: Option<Vec<u64>>,
    /// Returns the predictions of a replica.
    pub run: Box<dyn Fn(u64) -> Result<Predictions, String> + Send + Sync>,
}

/// The model with given parameters, as parts that predict each point once.
pub struct Replica(pub Vec<Part>);

impl Replica {
    /// A model of one part that predicts all points in order.
    pub fn whole(run: impl Fn(u64) -> Result<Vec<Prediction>, String> + Send + Sync + 'static) -> Self {
        let run = move |replica| Ok(run(replica)?.into_iter().enumerate().collect());
        Self(vec![Part { depends_on: None, run: Box::new(run) }])
    }

    /// All predictions of a replica, in the order of the points.
    ///
    /// # Errors
    ///
    /// The reason why a run failed.
    pub fn run(&self, replica: u64) -> Result<Vec<Prediction>, String> {
        self.run_beside(replica, &mut Known::new())
    }

    /// Like `run`, but takes results of parts from `known`, and adds those of parts that run now.
    ///
    /// # Errors
    ///
    /// The reason why a run failed.
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

/// The model as a function of its parameters. A replica has the same random numbers for all values.
pub type Model<'a> = dyn Fn(&[f64]) -> Result<Replica, String> + Sync + 'a;

/// A box on the scale of the parameters' ranges: both ends of each side.
pub type Sides = Vec<(f64, f64)>;

/// Standard errors of the replicas' noise; a residual of a polynomial beyond them counts as its error.
const CERTAIN: f64 = 2.0;

/// Number of replicas in one product of matrices.
const TOGETHER: usize = 32;

/// The runs of a model at every node of a box. Polynomials are linear in the values at the nodes, so each replica has
/// its own polynomials: their mean is the model, their scatter its error, and noise that replicas share between
/// parameter values cancels as it should.
#[derive(Clone, Debug)]
pub struct Emulator {
    /// The polynomials and their nodes.
    pub basis: Basis,
    /// Means over replicas of the coefficients, at a point's time, before and after: a row for each coefficient, a
    /// column for each point.
    mean: [DMatrix<f64>; 3],
    /// Deviations of each replica's coefficients from the mean, at a point's time; of polynomials through a place, the
    /// part of those replicas of the mean there too.
    deviations: Vec<DMatrix<f64>>,
    /// What further replicas add to a mean through a place: their deviations there over their number.
    further: DMatrix<f64>,
    /// Deviations of each replica itself at the inner nodes.
    inner: Vec<DMatrix<f64>>,
    /// Deviations of replicas at one place alone, a row for each; empty if none ran.
    alone: Vec<RowDVector<f64>>,
}

/// The coefficients of one replica: at a point's time, before and after; then its values at the inner nodes.
pub type Coefficients = [DMatrix<f64>; 4];

/// Runs `replicas` at every node of a box, in parallel, and returns their coefficients in order; `value` converts a
/// node's coordinates to parameters. Parts with the same dependencies at several nodes run once per replica.
// Not generic, so that it is compiled in this crate, which is optimised, and not in the suite, which is not.
pub fn coefficients(
    basis: &Basis,
    model: &Model<'_>,
    value: &dyn Fn(&[f64]) -> Vec<f64>,
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
        let of = |which: usize| DMatrix::from_fn(rows.len(), rows[0].len(), |node, point| rows[node][point][which]);
        let [at, before, after] = [0, 1, 2].map(of);
        let inner = at.select_rows(&basis.inner);
        Ok([&basis.project * at, &basis.project * before, &basis.project * after, inner])
    };
    replicas.into_par_iter().map(one).collect()
}

impl Emulator {
    /// The emulator of these replicas. One alone has no noise: enough for a model that draws nothing.
    pub fn new(basis: &Basis, replicas: &[Coefficients]) -> Self {
        let share = 1.0 / replicas.len() as f64;
        let mean = |which: usize| replicas.iter().map(|one| &one[which]).sum::<DMatrix<f64>>() * share;
        let away = |which: usize| {
            let mean = mean(which);
            replicas.iter().map(|one| &one[which] - &mean).collect()
        };
        let mean = [mean(0), mean(1), mean(2)];
        let further = DMatrix::zeros(0, mean[0].ncols());
        Self { basis: basis.clone(), deviations: away(0), further, inner: away(3), mean, alone: Vec::new() }
    }

    /// The same polynomials moved to the mean of these replicas at `place`, of which there are more than at every node:
    /// at the nodes they need to give no more than how the model changes.
    #[must_use]
    pub fn through(self, place: &[f64], replicas: &[Vec<Prediction>]) -> Self {
        let (n, m) = (self.replicas(), replicas.len());
        if m <= n {
            return self;
        }
        let Self { basis, mut mean, mut deviations, inner, alone, .. } = self;
        let points = mean[0].ncols();
        let table = |which: usize| DMatrix::from_fn(m, points, |replica, point| replicas[replica][point][which]);
        // The first term is 1 everywhere, the others add this at the place.
        let mut others = basis.terms(place);
        others[0] = 0.0;
        let others_of = |coefficients: &DMatrix<f64>| coefficients.tr_mul(&others).transpose();
        for (which, mean) in mean.iter_mut().enumerate() {
            let first = table(which).row_mean() - others_of(mean);
            mean.set_row(0, &first);
        }
        let mut away = table(0);
        let centre = away.row_mean();
        away.row_iter_mut().for_each(|mut row| row -= &centre);
        away /= m as f64;
        for (replica, deviation) in deviations.iter_mut().enumerate() {
            let first = away.row(replica) * n as f64 - others_of(deviation);
            deviation.set_row(0, &first);
        }
        let further = away.rows(n, m - n).into_owned();
        Self { basis, mean, deviations, further, inner, alone }
    }

    /// The same with the covariance of a replica from these, which ran at one place alone: one run gives as much of it
    /// as a run at every node.
    #[must_use]
    pub fn with_alone(self, replicas: &[Vec<Prediction>]) -> Self {
        let row = |one: &Vec<Prediction>| RowDVector::from_iterator(one.len(), one.iter().map(|point| point[0]));
        let rows: Vec<_> = replicas.iter().map(row).collect();
        let zero = RowDVector::zeros(self.mean().ncols());
        let mean = rows.iter().fold(zero, |sum, row| sum + row) / rows.len().max(1) as f64;
        Self { alone: rows.into_iter().map(|row| row - &mean).collect(), ..self }
    }

    /// Number of replicas.
    pub fn replicas(&self) -> usize {
        self.deviations.len()
    }

    /// Number of replicas behind the covariance of a replica.
    pub fn behind_covariance(&self) -> usize {
        if self.alone.is_empty() { self.replicas() } else { self.alone.len() }
    }

    /// Coefficients of the mean: a row for each term, a column for each point.
    pub fn mean(&self) -> &DMatrix<f64> {
        &self.mean[0]
    }

    /// All predictions at a place of the box.
    pub fn at(&self, place: &[f64]) -> DVector<f64> {
        self.mean[0].tr_mul(&self.basis.terms(place))
    }

    /// The variance of each point due to its uncertain time: the mean of (S(t + ε) − S(t))² over a Gaussian ε by
    /// Gauss–Hermite's rule of three nodes. It is right at a peak too, where the slope alone would give 0.
    pub fn time_variance(&self, place: &[f64]) -> DVector<f64> {
        let terms = self.basis.terms(place);
        let [at, before, after] = [0, 1, 2].map(|which| self.mean[which].tr_mul(&terms));
        of_time(&at, before, after)
    }

    /// The difference between these polynomials and those of one degree less, without the contribution of the replicas'
    /// noise to its square, which is part of [`Emulator::covariance_of_mean`].
    pub fn lack_of_fit(&self, place: &[f64]) -> DVector<f64> {
        let terms = self.basis.missed.tr_mul(&self.basis.terms(place));
        let n = self.replicas() as f64;
        let squares: DVector<f64> = self.deviations.iter().map(|one| one.tr_mul(&terms).map(|d| d * d)).sum();
        let own = |lack: f64, squares: f64| {
            lack.signum() * (lack * lack - CERTAIN.powi(2) * squares / (n * (n - 1.0).max(1.0))).max(0.0).sqrt()
        };
        self.mean().tr_mul(&terms).zip_map(&squares, own)
    }

    /// The average contribution of the replicas' noise to C V⁻¹ Cᵀ, terms × terms, where C are the mean's coefficients
    /// (a row for each term) and `inverse` is V⁻¹.
    pub fn noise(&self, inverse: &DMatrix<f64>) -> DMatrix<f64> {
        let n = self.replicas() as f64;
        let (terms, points) = self.mean().shape();
        // Two products for many replicas: a replica alone has too few rows for the fast kernels.
        let some = |deviations: &[DMatrix<f64>]| {
            let count = deviations.len();
            let stacked = DMatrix::from_fn(points, terms * count, |point, column| {
                deviations[column / terms][(column % terms, point)]
            });
            let weighted = inverse * stacked;
            let all = deviations.iter().flat_map(|one| one.iter().copied());
            let beside = DMatrix::from_iterator(terms, points * count, all);
            let below = |row: usize, term: usize| weighted[(row % points, row / points * terms + term)];
            beside * DMatrix::from_fn(points * count, terms, below)
        };
        let all: Vec<DMatrix<f64>> = self.deviations.par_chunks(TOGETHER).map(some).collect();
        let mut noise = all.iter().sum::<DMatrix<f64>>() / (n * (n - 1.0).max(1.0));
        noise[(0, 0)] += (&self.further * inverse).component_mul(&self.further).sum();
        noise
    }

    /// The covariance of the mean curve, points × points.
    pub fn covariance_of_mean(&self, place: &[f64]) -> DMatrix<f64> {
        let terms = self.basis.terms(place);
        let rows = self.deviations.iter().map(|one| one.tr_mul(&terms).transpose());
        covariance(&rows.collect::<Vec<_>>()) / self.replicas() as f64 + self.further.tr_mul(&self.further)
    }

    /// The covariance of one replica's predictions, points × points: of those that ran alone, else at the inner node
    /// nearest to `place`. A replica's polynomial scatters less: it averages over nodes, between which collisions
    /// differ.
    pub fn covariance_of_replica(&self, place: &[f64]) -> DMatrix<f64> {
        if !self.alone.is_empty() {
            return covariance(&self.alone);
        }
        let far = |node: usize| -> f64 { self.basis.nodes[node].iter().zip(place).map(|(a, b)| (a - b).powi(2)).sum() };
        let inner = &self.basis.inner;
        let nearest = (0..inner.len()).min_by(|a, b| far(inner[*a]).total_cmp(&far(inner[*b]))).unwrap_or(0);
        let rows = self.inner.iter().map(|one| one.row(nearest).into_owned());
        covariance(&rows.collect::<Vec<_>>())
    }

    /// The derivative of every prediction by every parameter, on the box's scale: points × parameters.
    pub fn slopes(&self, place: &[f64]) -> DMatrix<f64> {
        self.mean[0].tr_mul(&self.basis.slopes_of_all(place))
    }
}

/// The variance of each prediction due to its time, from those at its time, before and after.
pub(super) fn of_time(at: &DVector<f64>, before: DVector<f64>, after: DVector<f64>) -> DVector<f64> {
    ((before - at).map(|d| d * d) + (after - at).map(|d| d * d)) / 6.0
}

/// The covariance of deviations from the mean, a row for each replica.
fn covariance(rows: &[RowDVector<f64>]) -> DMatrix<f64> {
    let spread = DMatrix::from_rows(rows);
    spread.tr_mul(&spread) / (rows.len() as f64 - 1.0).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64Dxsm;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Two suspensions with one parameter each: each runs once per value of its own, and the result is as if all had
    /// run.
    #[test]
    fn a_part_runs_once_for_each_of_its_own_values() {
        static RUNS: AtomicUsize = AtomicUsize::new(0);
        let model = |shared: bool| {
            move |values: &[f64]| -> Result<Replica, String> {
                let part = |set: usize| {
                    let value = values[set];
                    let run = move |replica: u64| {
                        RUNS.fetch_add(1, Ordering::Relaxed);
                        // The points of the two suspensions alternate.
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
            let found = coefficients(&basis, &model(shared), &|node| node.to_vec(), 0..3, &|| ()).unwrap();
            (found, RUNS.load(Ordering::Relaxed))
        };
        let ((shared, fewer), (alone, all)) = (found(true), found(false));
        assert_eq!(shared, alone);
        let own = (basis.nodes.len() as f64).sqrt() as usize;
        assert_eq!((fewer, all), (3 * 2 * own, 3 * 2 * own * own));
    }

    /// Two points around 0: what a replica has everywhere, and what it has at one place alone.
    fn scattered(seed: u64, values: &[f64]) -> Replica {
        let place = values.iter().fold(seed, |all, value| all.wrapping_mul(31).wrapping_add(value.to_bits()));
        Replica::whole(move |replica| {
            let [mut everywhere, mut here] =
                [seed, place].map(|seed| Pcg64Dxsm::seed_from_u64(seed.wrapping_mul(1009).wrapping_add(replica)));
            let mut normal = || -> f64 {
                let [a, b]: [f64; 2] = [StandardNormal.sample(&mut everywhere), StandardNormal.sample(&mut here)];
                a + 0.5 * b
            };
            Ok(vec![[normal(); 3], [normal(); 3]])
        })
    }

    /// Polynomials through the mean of many replicas scatter as they say: their value at a place, and every
    /// coefficient, over many sets of replicas.
    #[test]
    fn polynomials_through_a_place_scatter_as_they_say() {
        const SETS: u64 = 400;
        const AT_NODES: u64 = 10;
        const AT_PLACE: u64 = 40;
        let (basis, place, other) = (Basis::new(2), [0.3, -0.2], [0.5, 0.1]);
        let one = DMatrix::identity(2, 2);
        let sums = |move_it: bool| {
            let mut sums = [[0.0; 2]; 4];
            for seed in 0..SETS {
                let model = |values: &[f64]| Ok(scattered(seed, values));
                let at_nodes = coefficients(&basis, &model, &|node| node.to_vec(), 0..AT_NODES, &|| ()).unwrap();
                let at_place = scattered(seed, &place);
                let at_place: Vec<_> = (0..AT_PLACE).map(|replica| at_place.run(replica).unwrap()).collect();
                let mut emulator = Emulator::new(&basis, &at_nodes);
                if move_it {
                    emulator = emulator.through(&place, &at_place);
                    let mean = at_place.iter().map(|two| two[1][0]).sum::<f64>() / AT_PLACE as f64;
                    assert!((emulator.at(&place)[1] - mean).abs() < 1e-12);
                }
                let noise = emulator.noise(&one);
                let term = |k: usize| [emulator.mean().row(k).norm_squared(), noise[(k, k)]];
                let value = |place| [emulator.at(place).norm_squared(), emulator.covariance_of_mean(place).trace()];
                for (sum, [found, said]) in sums.iter_mut().zip([value(&place), value(&other), term(0), term(4)]) {
                    *sum = [sum[0] + found, sum[1] + said];
                }
            }
            sums
        };
        // A sum of 800 squares of normal numbers has a relative deviation of 5 %; what is said has a smaller one.
        let ratios = |sums: [[f64; 2]; 4]| sums.map(|[found, said]| found / said);
        let (moved, not) = (sums(true), sums(false));
        assert!(ratios(moved).iter().chain(&ratios(not)).all(|ratio| (ratio - 1.0).abs() < 0.2), "{moved:?} {not:?}");
        // Of four times as many replicas at the place, to what those at the nodes differ there.
        assert!(moved[0][1] < 0.35 * not[0][1] && moved[1][1] < 0.6 * not[1][1], "{moved:?} {not:?}");
        assert!((moved[3][1] / not[3][1] - 1.0).abs() < 1e-12, "{moved:?} {not:?}");
    }
}
