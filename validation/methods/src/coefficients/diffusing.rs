//! Synthetic rods that turn by Jeffery's equation and by rotary diffusion: Folgar & Tucker's model itself, rod by rod,
//! sharing no code with the core.

use super::{Means, watched};
use nalgebra::{Matrix3, Vector3};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Dxsm;

/// Parameters of the rods' motion in u_2 = x_1, where time is strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffusion {
    /// The shape factor Λ.
    pub shape_factor: f64,
    /// Rotary diffusivity over G; C_I δ is Folgar & Tucker's.
    pub diffusivity: Matrix3<f64>,
    /// Strain of a step.
    pub strain: f64,
}

impl Diffusion {
    /// Folgar & Tucker's with this C_I.
    pub fn isotropic(shape_factor: f64, c_i: f64, strain: f64) -> Self {
        Self { shape_factor, diffusivity: Matrix3::identity() * c_i, strain }
    }
}

/// The rods of one replica.
#[derive(Clone, Debug)]
pub struct Diffusing {
    /// The rods' directions.
    pub rods: Vec<Vector3<f64>>,
    half: Matrix3<f64>,
    diffusion: Diffusion,
    /// The root of 2C times the strain of a step.
    root: Matrix3<f64>,
    rng: Pcg64Dxsm,
}

/// exp((W + ΛD)γ) over a strain γ: p turns to the direction of its product with p. (W + ΛD)² is −ω² in axes 1 and 2.
pub fn free(shape_factor: f64, strain: f64) -> Matrix3<f64> {
    let omega = 0.5 * (1.0 - shape_factor * shape_factor).sqrt();
    let (s, c) = (omega * strain).sin_cos();
    let (m12, m21) = (0.5 * (shape_factor - 1.0), 0.5 * (shape_factor + 1.0));
    Matrix3::new(c, m12 * s / omega, 0.0, m21 * s / omega, c, 0.0, 0.0, 0.0, 1.0)
}

impl Diffusing {
    /// `count` rods in random directions.
    pub fn isotropic(count: usize, diffusion: Diffusion, seed: u64) -> Self {
        let mut rng = Pcg64Dxsm::seed_from_u64(seed);
        let spread = (diffusion.diffusivity * (2.0 * diffusion.strain)).symmetric_eigen();
        let roots = Matrix3::from_diagonal(&spread.eigenvalues.map(|value| value.max(0.0).sqrt()));
        Self {
            rods: (0..count).map(|_| drawn(&mut rng).normalize()).collect(),
            half: free(diffusion.shape_factor, 0.5 * diffusion.strain),
            diffusion,
            root: spread.eigenvectors * roots * spread.eigenvectors.transpose(),
            rng,
        }
    }

    /// Half a step of Jeffery's equation, a step of diffusion, half a step of Jeffery's equation. The diffusion is that
    /// of ∇·(C·∇ψ) on the sphere (Phelps & Tucker 2009): a random step in space, made a direction again, and a drift
    /// −C·p, which an isotropic C does not have across p.
    pub fn step(&mut self) {
        let drift = self.diffusion.diffusivity * self.diffusion.strain;
        for p in &mut self.rods {
            let turned = (self.half * *p).normalize();
            let moved = (turned + self.root * drawn(&mut self.rng) - drift * turned).normalize();
            *p = (self.half * moved).normalize();
        }
    }

    /// The means over `steps` steps, with J as what is beyond a motion `alone` ([`free`] of the rods' own Λ and strain
    /// of a step).
    pub fn means(&mut self, alone: &Matrix3<f64>, steps: usize) -> Means {
        let (strain, start) = (self.diffusion.strain, self.rods.clone());
        let mut next = || {
            self.step();
            Some(self.rods.clone())
        };
        watched(alone, strain, start, steps, &mut next).unwrap_or_default()
    }
}

fn drawn(rng: &mut Pcg64Dxsm) -> Vector3<f64> {
    Vector3::from_fn(|_, _| StandardNormal.sample(rng))
}
