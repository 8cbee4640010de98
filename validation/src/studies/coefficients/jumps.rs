//! Kicks compared with rotary diffusion of the same C_I: how far rods deviate from Jeffery's motion after a fixed strain, and
//! their final orbits and phases.

mod show;
#[cfg(test)]
mod tests;

pub(super) use show::{figures, tables};

use super::{Coefficients, Setting, scene};
use crate::judge::case::Effort;
use crate::judge::lab;
use crate::judge::statistics::{Estimate, worst};
use crate::methods::coefficients::{Diffusing, Diffusion, free};
use nalgebra::Vector3;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;
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
    /// Jumps over a strain of about 1, in the steps of the scene: `before` periods without counting, then `periods` with it.
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

/// Shares of `replicas` replicas of interacting rods.
pub fn kicked(scene: &Scene, watch: Watch, replicas: u64) -> Vec<Shares> {
    let one = |replica| {
        let mut rods = lab::suspension(scene, replica);
        observed(scene.particles.aspect_ratio, watch, || {
            let stopped = (0..watch.steps).any(|_| rods.step().is_err());
            (!stopped).then(|| rods.directions())
        })
    };
    (0..replicas).into_par_iter().map(one).collect()
}

/// The same for as many rods in the same steps that turn by Jeffery's equation and rotary diffusion of C_I. Their seeds are the
/// effort's streams from `stream` on.
pub fn diffused(
    scene: &Scene,
    c_i: f64,
    watch: Watch,
    replicas: u64,
    (effort, stream): (&Effort, u64),
) -> Vec<Shares> {
    let aspect_ratio = scene.particles.aspect_ratio;
    let diffusion = Diffusion::isotropic(shape_factor(aspect_ratio), c_i, watch.strain);
    let one = |replica| {
        let mut rods = Diffusing::isotropic(scene.particles.count, diffusion, effort.seed(stream + replica));
        observed(aspect_ratio, watch, || {
            (0..watch.steps).for_each(|_| rods.step());
            Some(rods.rods.clone())
        })
    };
    (0..replicas).into_par_iter().map(one).collect()
}

/// The shares of rods that `next` takes through one jump after the other; NaN if it stops.
fn observed(aspect_ratio: f64, watch: Watch, mut next: impl FnMut() -> Option<Vec<Vector3<f64>>>) -> Shares {
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
    let mut all: Vec<&Vec<f64>> = one.iter().chain(other).map(|r| &r[quantity as usize]).collect();
    let distance = |all: &[&Vec<f64>]| {
        let (a, b) = all.split_at(one.len());
        let mean = |sample: &[&Vec<f64>], edge: usize| {
            sample.iter().map(|shares| shares[edge]).sum::<f64>() / sample.len() as f64
        };
        worst((0..quantity.edges().len()).map(|edge| (mean(a, edge) - mean(b, edge)).abs()))
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

/// A suspension, and diffusion with its measured C_I.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The suspension.
    pub setting: Setting,
    /// The suspension's C_I.
    pub c_i: Estimate,
    /// Strain of a jump.
    pub strain: f64,
    /// Replicas of the suspension.
    pub kicks: Vec<Shares>,
    /// Replicas with diffusion.
    pub diffusion: Vec<Shares>,
}

/// Compares the suspensions whose C_I is known to be above 0: diffusion needs a positive C_I.
pub fn compared(rows: &[&Coefficients], effort: &Effort) -> Vec<Compared> {
    let diffusive = rows.iter().filter(|row| row.c_i.readable() && row.c_i.value > 0.0);
    let compare = |row: &&Coefficients| {
        let scene = scene(row.setting, effort);
        let watch = Watch::new(&scene, row.periods as f64, row.periods as f64);
        Compared {
            setting: row.setting,
            c_i: row.c_i,
            strain: watch.length(),
            kicks: kicked(&scene, watch, row.replicas),
            diffusion: diffused(&scene, row.c_i.value, watch, row.replicas, (effort, STREAM)),
        }
    };
    diffusive.map(compare).collect()
}

/// The first stream of seeds for the study's diffusion.
const STREAM: u64 = 1 << 20;
