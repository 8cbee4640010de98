//! Straight lines through means that share random numbers, and the observed order.

use super::*;
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// The fewest replicas of a level from which a line is read: fewer do not tell the errors of their means.
pub const FEWEST: usize = 8;

#[derive(Clone, Debug, PartialEq)]
pub struct Means {
    pub values: Vec<f64>,
    pub covariance: DMatrix<f64>,
    /// The smallest number of replicas of a mean.
    fewest: usize,
}

/// y = intercept + slope·x.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Line {
    pub intercept: f64,
    pub intercept_se: f64,
    pub slope: f64,
    pub slope_se: f64,
    /// The residual sum of squares, weighted by the inverse covariances.
    pub chi_square: f64,
    /// The probability of a larger χ² if the line is right, by the F distribution, as replicas are few. None if it has
    /// only two points.
    pub p: Option<f64>,
}

/// An order w of y = a + b hʷ.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Order {
    pub order: f64,
    /// Half the width of the interval in which χ² is within 1 of its minimum.
    pub se: f64,
}

impl Means {
    /// The means over replicas of samples whose members with the same index share their random numbers. The correlation
    /// is taken as the same for every two samples, and estimated from the replicas that they share.
    pub fn of(samples: &[Vec<f64>]) -> Self {
        let variances: Vec<_> = (samples.iter()).map(|sample| super::covariance(sample, sample)).collect();
        let scale = |i: usize, j: usize| (variances[i] * variances[j]).sqrt();
        let (mut shared, mut pairs) = (0.0, 0.0);
        for i in 0..samples.len() {
            for j in (0..i).filter(|j| scale(i, *j) > 0.0) {
                let (a, b) = (&samples[i], &samples[j]);
                let count = a.len().min(b.len());
                shared += count as f64 * super::correlation(&a[..count], &b[..count]);
                pairs += count as f64;
            }
        }
        let correlation = if pairs > 0.0 { shared / pairs } else { 0.0 };
        let of_means = |i: usize, j: usize| {
            // Replicas that only the longer sample has are independent of the shorter.
            let most = samples[i].len().max(samples[j].len()) as f64;
            let correlation = if i == j { 1.0 } else { correlation };
            correlation * scale(i, j) / most
        };
        Self {
            values: (samples.iter()).map(|sample| sample.iter().sum::<f64>() / sample.len() as f64).collect(),
            covariance: DMatrix::from_fn(samples.len(), samples.len(), of_means),
            fewest: samples.iter().map(Vec::len).min().unwrap_or(0),
        }
    }

    /// The line through the means at `x`: least squares weighted by the inverse of the covariances, equivalent to a fit
    /// of the differences of neighbours. `None` for fewer than two levels, fewer than [`FEWEST`] replicas of a level,
    /// or samples without scatter.
    pub fn line(&self, x: &[f64]) -> Option<Line> {
        let count = self.values.len();
        if self.fewest < FEWEST {
            return None;
        }
        let cholesky = self.covariance.clone().cholesky()?;
        let design = DMatrix::from_fn(count, 2, |row, column| if column == 0 { 1.0 } else { x[row] });
        let y = DVector::from_column_slice(&self.values);
        let inverse = (design.transpose() * cholesky.solve(&design)).try_inverse()?;
        let solution = &inverse * design.transpose() * cholesky.solve(&y);
        let rest = y - design * &solution;
        let chi_square = rest.dot(&cholesky.solve(&rest));
        let levels = count as f64 - 2.0;
        let law = FisherSnedecor::new(levels, self.fewest as f64 - 1.0).ok();
        Some(Line {
            intercept: solution[0],
            intercept_se: inverse[(0, 0)].sqrt(),
            slope: solution[1],
            slope_se: inverse[(1, 1)].sqrt(),
            chi_square,
            p: law.map(|law| law.sf(chi_square / levels)),
        })
    }

    /// The w of a + b hʷ with the least χ², for h of at least three levels. `None` if noise hides it: an end of its
    /// interval outside ¼ to 4, or a slope within two standard errors of 0.
    pub fn order(&self, h: &[f64]) -> Option<Order> {
        if h.len() < 3 {
            return None;
        }
        let line = |order: f64| {
            let x: Vec<_> = h.iter().map(|h| h.powf(order)).collect();
            self.line(&x)
        };
        let chi_square = |order: f64| line(order).map_or(f64::INFINITY, |line| line.chi_square);
        let (low, high) = (0.25, 4.0);
        // On a coarse grid, then on a fine one around its best value.
        let best_of = |tried: Vec<f64>| tried.into_iter().min_by(|a, b| chi_square(*a).total_cmp(&chi_square(*b)));
        let near = best_of((0..=375).map(|k| low + 0.01 * f64::from(k)).collect())?;
        let best = best_of((-100..=100).map(|k| near + 1e-4 * f64::from(k)).collect())?;
        let limit = chi_square(best) + 1.0;
        let flat = line(best).is_none_or(|line| line.slope.abs() < 2.0 * line.slope_se);
        if flat || chi_square(low) < limit || chi_square(high) < limit {
            return None;
        }
        let end = |outer: f64| bisect(best, outer, 50, |order| chi_square(order) < limit)[0];
        Some(Order { order: best, se: 0.5 * (end(high) - end(low)) })
    }

    pub fn from(&self, first: usize) -> Self {
        let count = self.values.len() - first;
        Self {
            values: self.values[first..].to_vec(),
            covariance: self.covariance.view((first, first), (count, count)).into_owned(),
            fewest: self.fewest,
        }
    }

    /// The mean of level `one` less the best mean of the levels from `first` on, as if they were one; `None` if there
    /// are none, or samples without scatter.
    pub fn less_finer(&self, one: usize, first: usize) -> Option<Estimate> {
        if first >= self.values.len() {
            return None;
        }
        let finer = self.from(first);
        let inverse = finer.covariance.clone().cholesky()?.inverse();
        let weights = inverse.column_sum() / inverse.sum();
        let mean = weights.iter().zip(&finer.values).map(|(weight, value)| weight * value).sum::<f64>();
        let shared = self.covariance.row(one).columns(first, weights.len()).transpose().dot(&weights);
        let variance = self.covariance[(one, one)] + 1.0 / inverse.sum() - 2.0 * shared;
        Some(Estimate { value: self.values[one] - mean, se: variance.max(0.0).sqrt() })
    }

    /// The mean of level `one` less that of level `other`.
    pub fn difference(&self, one: usize, other: usize) -> Estimate {
        let c = &self.covariance;
        let variance = c[(one, one)] + c[(other, other)] - 2.0 * c[(one, other)];
        Estimate { value: self.values[one] - self.values[other], se: variance.max(0.0).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Estimate;
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64Dxsm;
    use statrs::distribution::ChiSquared;

    const H: [f64; 4] = [0.08, 0.04, 0.02, 0.01];

    /// 1 + hʷ with noise, partly shared between levels.
    fn samples(order: f64, noise: f64, seed: u64) -> Vec<Vec<f64>> {
        let mut rng = Pcg64Dxsm::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let shared: Vec<_> = (0..400).map(|_| normal()).collect();
        (H.iter().zip([400, 400, 200, 100]))
            .map(|(h, count)| {
                let value = |shared: &f64| 1.0 + h.powf(order) + noise * (shared + normal());
                shared[..count].iter().map(value).collect()
            })
            .collect()
    }

    #[test]
    fn a_clear_order_is_found_and_a_hidden_one_is_not() {
        for order in [1.0, 2.0] {
            let fitted = Means::of(&samples(order, 1e-4 * H[1].powf(order) / H[1], 1)).order(&H).unwrap();
            assert!((fitted.order - order).abs() < 4.0 * fitted.se && fitted.se < 0.1, "{fitted:?}");
        }
        assert_eq!(Means::of(&samples(1.0, 0.3, 1)).order(&H), None);
    }

    #[test]
    fn a_level_less_the_finer_ones_has_the_errors_of_repeats() {
        // h to this power is no bias.
        let of = |seed: u64| Means::of(&samples(12.0, 0.05, seed)).less_finer(0, 2).unwrap();
        let all: Vec<_> = (0..300).map(of).collect();
        let Estimate { value: mean, se } = Estimate::mean_of(&all.iter().map(|one| one.value).collect::<Vec<_>>());
        assert!(mean.abs() < 4.0 * se, "{mean} {se}");
        let (spread, said) = (se * 300f64.sqrt(), all[0].se);
        assert!((spread / said - 1.0).abs() < 0.25, "{spread} {said}");
        // A bias is seen.
        let biased = Means::of(&samples(1.0, 1e-3, 1)).less_finer(0, 2).unwrap();
        assert!((biased.value - H[0] + 0.5 * (H[2] + H[3])).abs() < 0.01, "{biased:?}");
        assert_eq!(Means::of(&samples(1.0, 1e-3, 1)).less_finer(0, 4), None);
    }

    #[test]
    fn the_line_s_errors_are_those_of_repeats() {
        let lines: Vec<_> = (0..300).map(|seed| Means::of(&samples(1.0, 0.05, seed)).line(&H).unwrap()).collect();
        let slopes: Vec<_> = lines.iter().map(|line| line.slope).collect();
        let Estimate { value: mean, se } = Estimate::mean_of(&slopes);
        assert!((mean - 1.0).abs() < 4.0 * se, "{mean} {se}");
        let (spread, said) = (se * 300f64.sqrt(), lines[0].slope_se);
        // 300 repeats determine their spread to 4 %, and a single run its own error to some 5 %.
        assert!((spread / said - 1.0).abs() < 0.25, "{spread} {said}");
        let p: f64 = lines.iter().map(|line| line.p.unwrap()).sum::<f64>() / 300.0;
        assert!((p - 0.5).abs() < 0.07, "{p}");
    }

    /// Of so few replicas p < 0.001, which refutes a line, is as rare as it says: 3 in 3000 are due, and more than
    /// 9 come once in a thousand times. By χ², without their number, it is not.
    #[test]
    fn few_replicas_refute_no_right_line() {
        let few = |seed: u64, count: usize| samples(1.0, 0.05, seed).into_iter().map(move |all| all[..count].to_vec());
        let line = |seed: u64| Means::of(&few(seed, FEWEST).collect::<Vec<_>>()).line(&H).unwrap();
        let lines: Vec<_> = (0..3000).map(line).collect();
        let refuted = |p: &dyn Fn(&Line) -> f64| lines.iter().filter(|line| p(line) < 1e-3).count();
        let by_chi_square = |line: &Line| ChiSquared::new(2.0).unwrap().sf(line.chi_square);
        let (found, control) = (refuted(&|line| line.p.unwrap()), refuted(&by_chi_square));
        assert!(found <= 9 && control > 9, "{found} {control}");
        assert_eq!(Means::of(&few(1, FEWEST - 1).collect::<Vec<_>>()).line(&H), None);
    }

    #[test]
    fn a_difference_knows_what_is_shared() {
        let samples = vec![vec![1.0, 2.0, 3.0, 4.0], vec![1.5, 2.5, 3.5, 4.5]];
        let Estimate { value: difference, se } = Means::of(&samples).difference(1, 0);
        assert!((difference - 0.5).abs() < 1e-15 && se < 1e-8);
    }
}
