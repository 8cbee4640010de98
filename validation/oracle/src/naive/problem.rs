//! The problem for the naive reference: a suspension, and the mistakes that can be made in it.

use super::inflow::OtherFlow;
use super::mistake::{Mistake, either};
use super::reading::Reading;
use std::f64::consts::TAU;

/// Orientations at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// phi = 2 pi R4, cos theta = 1 - 2 R5 (eq. 12).
    Isotropic,
    /// Every rod at the same angles.
    Fixed {
        /// phi from axis 1 towards axis 2, rad.
        phi_rad: f64,
        /// theta from axis 3, rad.
        theta_rad: f64,
    },
}

/// How a colliding rod turns over the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Update {
    /// p turns about p x pdot' by |pdot'| dt: A.14 without its pole.
    Rotation,
    /// A.14 taken literally, with the corrected A.13.
    Angles,
    /// Jeffery's exact step, then a turn about p x (pdot' - pdot) by |pdot' - pdot| dt: a contact without a change of
    /// rate leaves the free motion.
    ExactStepAndKick,
}

/// One suspension in plane Couette flow, u_2 = G x_1, or in another flow.
#[derive(Clone, Debug, PartialEq)]
pub struct NaiveProblem {
    /// N, rods in the control volume.
    pub count: usize,
    /// G, 1/s, not zero.
    pub shear_rate_per_s: f64,
    /// A flow in place of plane Couette flow.
    pub other_flow: Option<OtherFlow>,
    /// a, the full length of a rod, or its mean, mm.
    pub length_mm: f64,
    /// Standard deviation of a, percent of the mean.
    pub length_sd_percent: f64,
    /// Mean of r_e.
    pub aspect_ratio: f64,
    /// Standard deviation of r_e (eq. 11), percent of the mean.
    pub aspect_ratio_sd_percent: f64,
    /// Orientations at t = 0.
    pub orientation: Start,
    /// n, rods per cm^3.
    pub concentration_per_cm3: f64,
    /// H_1, H_2 and H_3 (eqs. 12, 14), mm, in place of the cube that follows from n.
    pub box_mm: Option<[f64; 3]>,
    /// alpha of eq. 7; 0: no collisions.
    pub alpha: f64,
    /// m of eq. 7.
    pub m: f64,
    /// Shortest arm of a contact, in units of the rod's own length.
    pub min_contact_arm: f64,
    /// How a colliding rod turns.
    pub update: Update,
    /// The interpretation of the paper where it leaves something open.
    pub reading: Reading,
    /// dt = T / steps_per_period, T that of the mean r_e.
    pub steps_per_period: usize,
    /// Seed of all streams.
    pub seed: u64,
    /// Index of the replica.
    pub replica: u64,
    /// A deliberate mistake, or `None`.
    pub mistake: Option<Mistake>,
}

impl NaiveProblem {
    /// Fig. 7 at 50 per cm^3 with rods of one size, in the project's interpretation of the paper, with the update
    /// `rotation`.
    pub fn paper(seed: u64, replica: u64) -> Self {
        Self {
            count: 100,
            shear_rate_per_s: 0.5,
            other_flow: None,
            length_mm: 0.72,
            length_sd_percent: 0.0,
            aspect_ratio: 11.6,
            aspect_ratio_sd_percent: 0.0,
            orientation: Start::Isotropic,
            concentration_per_cm3: 50.0,
            box_mm: None,
            alpha: 0.5,
            m: 3.0,
            min_contact_arm: 0.0,
            update: Update::Rotation,
            reading: Reading::default(),
            steps_per_period: 200,
            seed,
            replica,
            mistake: None,
        }
    }

    /// T of the mean aspect ratio, s (eq. 15).
    pub fn period_s(&self) -> f64 {
        let factor = either(self.mistake, Mistake::PeriodHalved, 0.5, 1.0);
        let strain = TAU * (self.aspect_ratio + 1.0 / self.aspect_ratio);
        factor * strain / self.shear_rate_per_s.abs()
    }

    /// The time step dt, s.
    pub fn time_step_s(&self) -> f64 {
        match self.other_flow {
            Some(flow) => flow.time_step_s(),
            None => self.period_s() / self.steps_per_period as f64,
        }
    }

    /// H_1, H_2 and H_3, mm: as given, or (N/n)^(1/3) of the cube.
    pub fn edges_mm(&self) -> [f64; 3] {
        let cm3_per_mm3 = either(self.mistake, Mistake::ConcentrationUnits, 1e-2, 1e-3);
        let volume_mm3 = self.count as f64 / (self.concentration_per_cm3 * cm3_per_mm3);
        let cube = |volume_mm3: f64| [volume_mm3.cbrt(); 3];
        match self.box_mm {
            Some([a, b, c]) if self.mistake == Some(Mistake::CubeForBox) => cube(a * b * c),
            Some(edges_mm) => edges_mm,
            None => cube(volume_mm3),
        }
    }

    /// L_ij = du_i/dx_j, 1/s.
    pub fn gradient_per_s(&self) -> [[f64; 3]; 3] {
        let Some(OtherFlow { gradient_per_s, .. }) = self.other_flow else {
            return [[0.0; 3], [self.shear_rate_per_s, 0.0, 0.0], [0.0; 3]];
        };
        let transposed = [0, 1, 2].map(|i| [0, 1, 2].map(|j| gradient_per_s[j][i]));
        either(self.mistake, Mistake::GradientTransposed, transposed, gradient_per_s)
    }
}
