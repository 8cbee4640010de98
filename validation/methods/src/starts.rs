//! Ways to choose initial directions of a free suspension: each rod is isotropic by itself, but the rods need not be
//! independent of each other. The fewer clusters and gaps, the smaller the error of a mean.

use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;
use shearbed::model::orientation::isotropic;
use shearbed::model::phase::Phase;
use shearbed::motion::couette;
use statrs::distribution::{ContinuousCDF, Normal};

/// A rod: its direction, and the quantile of its aspect ratio in (0, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// The rod's direction.
    pub p: [f64; 3],
    /// The quantile of the rod's aspect ratio; ½ if all rods have the same.
    pub quantile: f64,
}

/// A way to choose initial directions.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// A short name.
    pub name: &'static str,
    /// The exponent of N with which the root-mean-square error of X̄₁ falls by theory: for rods of one aspect ratio
    /// (directions alone, two numbers a rod), and for rods of unequal ones (three numbers a rod).
    pub exponents: [f64; 2],
    /// Chooses about `count` rods, with different aspect ratios if `unequal`.
    pub lay: fn(count: usize, unequal: bool, rng: &mut Pcg64Dxsm) -> Vec<Rod>,
}

/// Every start, in the order of the tables.
pub const ALL: [Start; 3] = [
    Start { name: "random", exponents: [-0.5, -0.5], lay: random },
    Start {
        name: "stratified",
        // A Lipschitz function varies by N^(−1/d) in one of N cells: N^(−½−1/d).
        exponents: [-1.0, -5.0 / 6.0],
        lay: stratified,
    },
    Start {
        name: "Fibonacci lattice",
        // The kink of |p_1|: see docs/src/verification/integrators.md.
        exponents: [-1.25, -1.0],
        lay: fibonacci,
    },
];

/// X̄₁ of free rods of Gaussian aspect ratio, from these directions and quantiles, each moved directly to t/T =
/// `turns`.
pub fn mean_x1(rods: &[Rod], aspect_ratio: f64, sd_percent: f64, turns: f64) -> f64 {
    let r = aspect_ratio;
    let sum: f64 = match Normal::new(r, 0.01 * sd_percent * r) {
        Ok(gaussian) if sd_percent > 0.0 => (rods.iter())
            .map(|rod| {
                let own = gaussian.inverse_cdf(rod.quantile);
                let phase = Phase::of_turns(turns * (r + 1.0 / r) / (own + 1.0 / own));
                couette(rod.p, own, phase)[0].abs()
            })
            .sum(),
        _ => {
            let phase = Phase::of_turns(turns);
            rods.iter().map(|rod| couette(rod.p, r, phase)[0].abs()).sum()
        }
    };
    sum / rods.len() as f64
}

/// Directions drawn as a scene draws them (eq. 12), aspect ratios by eq. 11.
fn random(count: usize, unequal: bool, rng: &mut Pcg64Dxsm) -> Vec<Rod> {
    let lay = |_| rod([rng.random(), rng.random(), own(unequal, || rng.random())]);
    (0..count).map(lay).collect()
}

/// One rod drawn from each of kᵈ cells of equal probability.
fn stratified(count: usize, unequal: bool, rng: &mut Pcg64Dxsm) -> Vec<Rod> {
    let d = if unequal { 3 } else { 2 };
    let k = (count as f64).powf(1.0 / f64::from(d)).round().max(1.0) as usize;
    let cell = |cell: usize| {
        let mut at = |axis: u32| ((cell / k.pow(axis) % k) as f64 + rng.random::<f64>()) / k as f64;
        rod([at(0), at(1), own(unequal, || at(2))])
    };
    (0..k.pow(d)).map(cell).collect()
}

/// The spherical Fibonacci lattice (Hannay & Nye 2004), rotated as a whole at random, so that each rod is
/// isotropic; aspect ratios by a further coordinate of Roberts' R₂ sequence, shifted at random.
fn fibonacci(count: usize, unequal: bool, rng: &mut Pcg64Dxsm) -> Vec<Rod> {
    // 1/g and 1/g² for the root of g^(d+1) = g + 1: the golden ratio, and the plastic number.
    let [around, along] =
        if !unequal { [0.618_033_988_749_894_8, 0.0] } else { [0.754_877_666_246_692_8, 0.569_840_290_998_053_2] };
    let turn = rotation(rng);
    let shift = own(unequal, || rng.random());
    let lay = |k: usize| {
        let (index, height) = (k as f64, (k as f64 + 0.5) / count as f64);
        let rod = rod([(index * around).fract(), height, (index * along + shift).fract()]);
        let p = turn * Vector3::from(rod.p);
        Rod { p: p.into(), ..rod }
    };
    (0..count).map(lay).collect()
}

/// The quantile of an aspect ratio; ½ if all rods have the same.
fn own(unequal: bool, mut quantile: impl FnMut() -> f64) -> f64 {
    if unequal { quantile() } else { 0.5 }
}

fn rod([r4, r5, quantile]: [f64; 3]) -> Rod {
    let p = isotropic(r4, r5);
    Rod { p: [p.x, p.y, p.z], quantile }
}

/// A uniformly distributed rotation: four normal numbers are an isotropic quaternion.
fn rotation(rng: &mut Pcg64Dxsm) -> Rotation3<f64> {
    let mut normal = || StandardNormal.sample(rng);
    let quaternion = Quaternion::new(normal(), normal(), normal(), normal());
    UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn every_start_is_isotropic_with_even_quantiles() {
        for start in ALL {
            for unequal in [false, true] {
                let (mut moments, mut rods) = ([0.0; 5], 0.0);
                for seed in 0..40 {
                    for rod in (start.lay)(1000, unequal, &mut Pcg64Dxsm::seed_from_u64(seed)) {
                        let [x, y, z] = rod.p;
                        assert!((x * x + y * y + z * z - 1.0).abs() < 1e-14);
                        assert!(unequal && (0.0..1.0).contains(&rod.quantile) || rod.quantile == 0.5);
                        let of_rod = [x.abs(), y.abs(), z.abs(), 3.0 * x * y + 0.5, rod.quantile];
                        moments.iter_mut().zip(of_rod).for_each(|(sum, value)| *sum += value);
                        rods += 1.0;
                    }
                }
                // 40 000 rods with deviations of 0.29 to 0.8 each: standard errors of 0.0014 to 0.004.
                for moment in moments {
                    assert!((moment / rods - 0.5).abs() < 0.02, "{} {moments:?}", start.name);
                }
            }
        }
    }

    #[test]
    fn a_stratified_start_fills_every_cell_once() {
        let rods = stratified(1000, true, &mut Pcg64Dxsm::seed_from_u64(1));
        let mut cells: Vec<_> = (rods.iter())
            .map(|rod| {
                let around = rod.p[1].atan2(rod.p[0]).rem_euclid(std::f64::consts::TAU);
                let parts = [around / std::f64::consts::TAU, 0.5 * (1.0 - rod.p[2]), rod.quantile];
                parts.map(|part| (10.0 * part) as u32)
            })
            .collect();
        cells.sort_unstable();
        cells.dedup();
        assert_eq!(cells.len(), 1000);
    }
}
