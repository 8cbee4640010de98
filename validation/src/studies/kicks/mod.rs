//! The limit Δt → 0: how often collisions kick rods by large angles, how heavy the tail is, and what remains if
//! the arms are bounded (docs/src/theory/time-step.md).
//!
//! A kick is |ṗ′ − ṗ|Δt, the effect of the collision. The whole turn |ṗ′|Δt also contains Jeffery's own |ṗ|Δt, which at
//! 200 steps a period exceeds 0.1 rad in every flip without any collision.

pub(crate) mod averaged;
pub mod study;
pub(crate) mod tail;

use super::*;
use crate::oracle::kicks::chance_of_pair;
use nalgebra::SMatrix;
use shearbed::suspension::Collision;
use std::ops::Range;

/// The angles above which kicks are counted.
pub const THRESHOLDS_RAD: [f64; 4] = [0.01, 0.1, 1.0, 10.0];

/// A function that returns the angles of a collision; a check may replace it by another.
pub type Angles = fn(&Collision) -> [f64; 2];

/// |ṗ′ − ṗ|Δt of both rods.
pub fn kicks_rad(collision: &Collision) -> [f64; 2] {
    collision.kicks_rad
}

/// The definition of counted kicks and of their sides.
#[derive(Clone, Copy)]
pub struct Counted {
    /// The angles that count as kicks.
    pub angles: Angles,
    /// True if the liquid pulls the contact points of two rods apart.
    pub opens: fn(&Vector3<f64>, &Vector3<f64>) -> bool,
    /// How many times per period the formula is evaluated for the directions.
    pub looks_per_period: u64,
}

/// Kicks, separated by closing and opening gaps.
pub const KICKS: Counted = Counted { angles: kicks_rad, opens: is_opening, looks_per_period: 200 };

/// GΔt of a scene in plane Couette flow.
pub fn step_strain(scene: &Scene) -> f64 {
    strain_per_period(scene.particles.aspect_ratio) / scene.steps_per_unit() as f64
}

/// Numbers of kicks above each of [`THRESHOLDS_RAD`]: in the row `CLOSING` where the gap was closing, ℓ·D·ℓ < 0, in
/// the row `OPENING` where it was opening.
pub type Sides = SMatrix<f64, 2, 4>;
pub(crate) const CLOSING: usize = 0;
pub(crate) const OPENING: usize = 1;

/// The counts of one replica over a window, per rod and period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    pub(crate) kicks: Sides,
    /// The prediction for them by the formula for fresh arms, from the directions and collisions of the run.
    pub fresh: Sides,
    /// Number of rods that collided, two for each collision.
    pub collided: f64,
}

/// Counts the kicks of one replica over whole periods. NaN if the run stopped.
pub fn count(scene: &Scene, replica: u64, periods: Range<u64>, counted: Counted) -> Counts {
    let mut suspension = lab::suspension(scene, replica);
    let (steps, strain) = (scene.steps_per_unit(), step_strain(scene));
    let aspect_ratios = suspension.aspect_ratios();
    let mut counts = Counts::default();
    let mut chances = Sides::zeros();
    for step in 0..periods.end * steps {
        let within = step >= periods.start * steps;
        let directions = if within { suspension.directions() } else { Vec::new() };
        if within && step % (steps / counted.looks_per_period).max(1) == 0 {
            chances = mean_chances(&directions, &aspect_ratios, strain, counted.opens);
        }
        let Ok(collisions) = suspension.step() else {
            return Counts { kicks: Sides::repeat(f64::NAN), ..counts };
        };
        for collision in collisions.iter().filter(|_| within) {
            let [a, b] = collision.rods.map(|rod| directions[rod]);
            counts.add((counted.opens)(&a, &b), (counted.angles)(collision));
            counts.fresh += 2.0 * chances;
        }
    }
    counts.over((aspect_ratios.len() as u64 * (periods.end - periods.start)) as f64)
}

/// True if a kick is above a threshold or NaN, so that NaN is detected.
pub fn is_above(kick_rad: f64, threshold_rad: f64) -> bool {
    kick_rad > threshold_rad || kick_rad.is_nan()
}

/// True if the liquid pulls the contact points of two rods apart: ℓ·D·ℓ > 0 with ℓ ∝ p_A × p_B.
fn is_opening(a: &Vector3<f64>, b: &Vector3<f64>) -> bool {
    let normal = a.cross(b);
    normal.x * normal.y > 0.0
}

/// The formula's chances of a kick above each threshold, closing and opening, over pairs of statistically independent
/// rods.
fn mean_chances(
    directions: &[Vector3<f64>],
    aspect_ratios: &[f64],
    strain: f64,
    opens: fn(&Vector3<f64>, &Vector3<f64>) -> bool,
) -> Sides {
    let count = directions.len();
    let mut sums = Sides::zeros();
    let mut pairs = 0.0;
    for shift in 1..count.min(3) {
        for i in 0..count {
            let j = (i + shift) % count;
            let [a, b] = [directions[i], directions[j]];
            let mut side = sums.row_mut(if opens(&a, &b) { OPENING } else { CLOSING });
            for (sum, threshold) in side.iter_mut().zip(THRESHOLDS_RAD) {
                *sum += chance_of_pair(a.into(), b.into(), aspect_ratios[j], threshold / strain);
            }
            pairs += 1.0;
        }
    }
    sums / pairs
}

impl Counts {
    fn add(&mut self, opening: bool, angles: [f64; 2]) {
        let mut side = self.kicks.row_mut(if opening { OPENING } else { CLOSING });
        for (count, threshold) in side.iter_mut().zip(THRESHOLDS_RAD) {
            *count += angles.iter().filter(|angle| **angle > threshold).count() as f64;
        }
        self.collided += 2.0;
    }

    fn over(self, rod_periods: f64) -> Self {
        Self { kicks: self.kicks / rod_periods, fresh: self.fresh / rod_periods, collided: self.collided / rod_periods }
    }
}

/// The counts of many replicas of a scene at one step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepCounts {
    pub(crate) steps_per_period: u64,
    /// The window, in periods.
    pub periods: Range<u64>,
    pub(crate) counts: Vec<Counts>,
}

impl StepCounts {
    /// The mean over replicas of a number per replica.
    pub fn mean(&self, value: impl Fn(&Counts) -> f64) -> Sample {
        Sample::of(self.counts.iter().map(value))
    }
}

/// Counts the kicks of a scene at `steps_per_period` over a window of periods.
pub fn rates(scene: &Scene, steps_per_period: u64, periods: Range<u64>, replicas: u64, counted: Counted) -> StepCounts {
    let mut scene = scene.clone();
    scene.time =
        Time { steps_per_unit: Some(steps_per_period), outputs_per_unit: Some(1), ..Time::periods(periods.end as f64) };
    StepCounts {
        steps_per_period,
        counts: lab::replicas(replicas, |replica| count(&scene, replica, periods.clone(), counted)),
        periods,
    }
}

/// The kicks of one step from a fresh start: isotropic rods at random places.
pub fn of_one_step(suspension: &mut Suspension, angles: Angles) -> Vec<f64> {
    (suspension.step()).map_or(vec![f64::NAN], |collisions| collisions.iter().flat_map(angles).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kicks_are_sorted_by_size_and_by_what_the_gap_does() {
        let mut counts = Counts::default();
        counts.add(true, [0.05, 20.0]);
        counts.add(false, [0.001, 0.5]);
        let counts = counts.over(2.0);
        assert_eq!(counts.kicks, Sides::from_row_slice(&[0.5, 0.5, 0.0, 0.0, 1.0, 0.5, 0.5, 0.5]));
        assert_eq!(counts.collided, 2.0);
        // ℓ along (1, 1, 0): stretched by u_2 = x_1; along (1, −1, 0): squeezed.
        let line = |b: Vector3<f64>| is_opening(&Vector3::z(), &b);
        assert!(line(Vector3::new(1.0, -1.0, 0.0)) && !line(Vector3::new(1.0, 1.0, 0.0)));
    }

    #[test]
    fn a_window_is_part_of_the_run() {
        let mut scene = lab::interacting_scene(&crate::judge::case::Effort::gate());
        lab::interaction(&mut scene).concentration_per_cm3 = Some(400.0);
        let collided = |periods| rates(&scene, 50, periods, 2, KICKS).mean(|counts| counts.collided).mean;
        let (both, parts) = (collided(0..2), [collided(0..1), collided(1..2)]);
        assert!((2.0 * both - parts[0] - parts[1]).abs() < 1e-12 && parts[0] != parts[1]);
    }
}
