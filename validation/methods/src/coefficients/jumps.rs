//! How far the rods of one replica deviate from Jeffery's motion after a fixed strain, a jump, and their orbits and
//! phases there.

use super::free;
use nalgebra::Vector3;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64Dxsm;
use shearbed::model::jeffery::{shape_factor, strain_per_period};
use shearbed::model::orientation::bounded_orbit_constant;
use shearbed::scene::Scene;
use std::f64::consts::FRAC_PI_2;

/// A quantity that is evaluated for every rod at the end of each jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The angle in rad between the rod and the direction that Jeffery's motion alone would have given it.
    Angle,
    /// |ΔC_b|, 0 for Jeffery's motion alone.
    Change,
    /// C_b = C/(1 + C).
    Orbit,
    /// The phase atan(tan φ/r_e) over π/2, which free rods pass through at a constant rate.
    Phase,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 4] = [Self::Angle, Self::Change, Self::Orbit, Self::Phase];

    /// The values above which rods are counted.
    pub fn edges(self) -> Vec<f64> {
        match self {
            Self::Angle | Self::Change => {
                vec![1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0]
            }
            Self::Orbit | Self::Phase => (0..100).map(|k| 0.01 * f64::from(k)).collect(),
        }
    }
}

/// For each quantity of one replica, the share of rods above each edge, averaged over jumps.
pub type Shares = [Vec<f64>; 4];

/// The share above one edge, one value for each replica; NaN if there is no such edge.
pub fn above(all: &[Shares], quantity: Quantity, edge: f64) -> Vec<f64> {
    let place = quantity.edges().iter().position(|own| *own == edge);
    let share = |shares: &Shares| place.map_or(f64::NAN, |place| shares[quantity as usize][place]);
    all.iter().map(share).collect()
}

/// The distance between two samples of replicas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    /// The largest difference between the mean shares above an edge: Kolmogorov's distance, at the edges.
    pub distance: f64,
    /// The probability of at least this distance if the replicas are assigned to the two samples at random.
    pub p: f64,
}

/// Number of random assignments behind a p-value.
const DEALS: u64 = 999;

/// The distance of two samples, by a permutation test: it may treat the rods of a replica as dependent.
pub fn apart(one: &[Shares], other: &[Shares], quantity: Quantity, seed: u64) -> Apart {
    let edges = quantity.edges().len();
    let mut all: Vec<&Vec<f64>> = one.iter().chain(other).map(|r| &r[quantity as usize]).collect();
    let distance = |all: &[&Vec<f64>]| {
        let (a, b) = all.split_at(one.len());
        let mean = |sample: &[&Vec<f64>], edge: usize| {
            sample.iter().map(|shares| shares[edge]).sum::<f64>() / sample.len() as f64
        };
        (0..edges)
            .map(|edge| (mean(a, edge) - mean(b, edge)).abs())
            .fold(0.0, |most, next| if next > most || next.is_nan() { next } else { most })
    };
    let found = distance(&all);
    let mut rng = Pcg64Dxsm::seed_from_u64(seed);
    let as_far = (0..DEALS).filter(|_| {
        all.shuffle(&mut rng);
        // Sums in a different order differ by rounding.
        distance(&all) > found - 1e-12
    });
    Apart { distance: found, p: (1 + as_far.count()) as f64 / (1 + DEALS) as f64 }
}

/// The duration of the observation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Watch {
    /// Number of time steps in a jump.
    pub steps: u64,
    /// Strain of a time step.
    pub strain: f64,
    /// Number of jumps before the state is steady.
    pub before: u64,
    /// Number of jumps that are counted.
    pub jumps: u64,
}

impl Watch {
    /// Jumps over a strain of about 1, in the steps of the scene: `before` periods without counting, then `periods`
    /// with it.
    pub fn new(scene: &Scene, before: f64, periods: f64) -> Self {
        let period = strain_per_period(scene.particles.aspect_ratio);
        let strain = period / scene.steps_per_unit() as f64;
        let steps = (1.0 / strain).round().max(1.0);
        let jumps = |periods: f64| (periods * period / (steps * strain)).ceil() as u64;
        Self { steps: steps as u64, strain, before: jumps(before), jumps: jumps(periods) }
    }

    /// Strain of a jump.
    pub fn length(&self) -> f64 {
        self.steps as f64 * self.strain
    }
}

/// The shares of rods that `next` takes through one jump after the other; NaN if it stops.
// Not generic, so that it is compiled in this crate, which is optimised, and not in the suite, which is not.
pub fn observed(aspect_ratio: f64, watch: Watch, next: &mut dyn FnMut() -> Option<Vec<Vector3<f64>>>) -> Shares {
    let carry = free(shape_factor(aspect_ratio), watch.length());
    let mut values: [Vec<f64>; 4] = Default::default();
    let mut last: Vec<Vector3<f64>> = Vec::new();
    for jump in 0..=watch.before + watch.jumps {
        let Some(now) = next() else {
            return Quantity::ALL.map(|quantity| vec![f64::NAN; quantity.edges().len()]);
        };
        if jump > watch.before {
            for (from, to) in last.iter().zip(&now) {
                let seen = seen(aspect_ratio, from, &(carry * from), to);
                values.iter_mut().zip(seen).for_each(|(all, one)| all.push(one));
            }
        }
        last = now;
    }
    Quantity::ALL.map(|quantity| shares(&mut values[quantity as usize], &quantity.edges()))
}

/// Every quantity of a rod that went from `from` to `to`, and would have gone to `expected` by Jeffery's motion alone.
fn seen(aspect_ratio: f64, from: &Vector3<f64>, expected: &Vector3<f64>, to: &Vector3<f64>) -> [f64; 4] {
    let orbit = |p: &Vector3<f64>| bounded_orbit_constant((*p).into(), aspect_ratio);
    [
        expected.cross(to).norm().atan2(expected.dot(to).abs()),
        (orbit(to) - orbit(from)).abs(),
        orbit(to),
        to.y.abs().atan2(aspect_ratio * to.x.abs()) / FRAC_PI_2,
    ]
}

/// The share of values above each edge; NaN is above all edges.
fn shares(values: &mut [f64], edges: &[f64]) -> Vec<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let share = |edge: &f64| {
        let below = values.partition_point(|value| value <= edge);
        (values.len() - below) as f64 / values.len() as f64
    };
    edges.iter().map(share).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use shearbed::model::orientation::from_angles;
    use std::f64::consts::PI;

    const RATIO: f64 = 11.6;

    #[test]
    fn a_rod_that_nothing_kicks_has_made_no_jump() {
        let from = from_angles(0.3, 1.1).into_inner();
        for strain in [0.1, 1.0, 7.0] {
            let alone = free(shape_factor(RATIO), strain) * from;
            // Opposite directions are the same rod.
            for to in [alone.normalize(), -alone.normalize()] {
                let [angle, change, orbit, phase] = seen(RATIO, &from, &alone, &to);
                assert!(angle < 1e-15 && change < 1e-15, "{angle} {change}");
                // C of eq. 13, and A.4: tan φ = r_e tan(phase) with the phase growing by γ/(r_e + 1/r_e).
                let c = 1.1_f64.tan() * (RATIO.powi(2) * 0.3_f64.cos().powi(2) + 0.3_f64.sin().powi(2)).sqrt() / RATIO;
                assert!((orbit - c / (1.0 + c)).abs() < 1e-14);
                let after = (0.3_f64.tan() / RATIO).atan() + strain / (RATIO + 1.0 / RATIO);
                assert!((phase - after / FRAC_PI_2).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn jumps_are_angles_between_lines() {
        let from = from_angles(0.3, 1.1).into_inner();
        for kick in [0.01, 1.0, 3.0, PI - 0.02] {
            let axis = from.cross(&Vector3::z()).normalize();
            let to = from * kick.cos() + axis.cross(&from) * kick.sin();
            let [angle, ..] = seen(RATIO, &from, &from, &to);
            assert!((angle - kick.min(PI - kick)).abs() < 1e-14, "{kick}: {angle}");
        }
    }

    #[test]
    fn shares_are_of_values_above_the_edges() {
        let mut values = [0.5, 0.1, f64::NAN, 0.2];
        assert_eq!(shares(&mut values, &[0.0, 0.1, 0.2, 9.0]), [1.0, 0.75, 0.5, 0.25]);
    }

    /// Independent replicas with a common mean.
    fn made(mean: f64, seed: u64) -> Vec<Shares> {
        let mut rng = Pcg64Dxsm::seed_from_u64(seed);
        let one = || {
            let mut off: Vec<f64> = (0..100).map(|k| 0.01 * f64::from(k)).collect();
            off.shuffle(&mut rng);
            Quantity::ALL.map(|quantity| vec![mean + off[quantity as usize]; quantity.edges().len()])
        };
        std::iter::repeat_with(one).take(12).collect()
    }

    #[test]
    fn only_samples_that_differ_are_told_apart() {
        let p = |mean: f64, seed: u64| apart(&made(0.0, seed), &made(mean, 1000 + seed), Quantity::Orbit, seed).p;
        let trials = 200;
        let low = (0..trials).filter(|seed| p(0.0, *seed) <= 0.1).count() as f64;
        // A p-value is at most 0.1 in a tenth of the trials, to five standard errors of a share of 200: 0.106.
        assert!((low / trials as f64 - 0.1).abs() < 0.106, "{low}");
        assert!((0..10).all(|seed| p(0.8, seed) <= 0.002));
    }
}
