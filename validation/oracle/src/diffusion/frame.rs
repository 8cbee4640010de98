//! The axes of the harmonics, chosen such that few harmonics are needed.
//!
//! Rods gather about one axis. If it is the pole, they need many degrees l, but orders m only for the shape of the
//! peak. If the flow has a plane of reflection through that axis, the azimuth is counted from the plane and ψ has only
//! cosines.

use super::operator::Motion;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// The axes of the harmonics, and the motion of rods in them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The rows are the axes x, y, z of the harmonics, in laboratory coordinates.
    pub axes: Matrix3<f64>,
    /// The motion in these axes.
    pub motion: Motion,
    /// True if ψ stays even in the azimuth when it is even at t = 0.
    pub even: bool,
}

impl Frame {
    /// The axes for a motion that is given in the laboratory's axes.
    pub fn of(motion: &Motion) -> Self {
        let spin = motion.spin;
        if spin == Vector3::zeros() {
            return Self::of_extension(motion);
        }
        // Products of three rates would be 0 or ∞ for very slow or fast flows; powers of two change no digit.
        let scale = (-spin.amax().max(motion.strain.amax()).log2().floor()).exp2();
        let (unit_spin, unit_strain) = (spin * scale, motion.strain * scale);
        let across = unit_spin.cross(&(unit_strain * unit_spin)).norm();
        let plane = across <= 8.0 * f64::EPSILON * unit_spin.norm_squared() * unit_strain.norm();
        let gathered = gathered(motion);
        let normal = spin.normalize();
        let within = gathered - normal * normal.dot(&gathered);
        if !plane || within.norm() < 0.1 {
            let other = Vector3::ith(gathered.iamin(), 1.0);
            let x = gathered.cross(&other).normalize();
            let axes = Matrix3::from_rows(&[x, gathered.cross(&x), gathered].map(|axis| axis.transpose()));
            return Self { axes, motion: turned(motion, &axes), even: false };
        }
        let z = within.normalize();
        let axes = Matrix3::from_rows(&[normal.cross(&z), normal, z].map(|axis| axis.transpose()));
        let mut motion = turned(motion, &axes);
        for (i, j) in [(0, 1), (1, 0), (1, 2), (2, 1)] {
            motion.strain[(i, j)] = 0.0;
        }
        motion.spin = Vector3::new(0.0, motion.spin.y, 0.0);
        Self { axes, motion, even: true }
    }

    /// The same axes for the flow times a factor, with another diffusivity in 1/s.
    pub fn times(&self, factor: f64, diffusivity: f64) -> Self {
        let Motion { strain, spin, .. } = self.motion;
        Self { motion: Motion { strain: strain * factor, spin: spin * factor, diffusivity }, ..*self }
    }

    /// The axes of an extension: the pole is the axis of the largest stretching.
    fn of_extension(motion: &Motion) -> Self {
        let eigen = SymmetricEigen::new(motion.strain);
        let mut order = [0, 1, 2];
        order.sort_by(|i, j| eigen.eigenvalues[*i].total_cmp(&eigen.eigenvalues[*j]));
        let [x, y] = [0, 1].map(|k| eigen.eigenvectors.column(order[k]).into_owned());
        let axes = Matrix3::from_rows(&[x, y, x.cross(&y)].map(|axis| axis.transpose()));
        let rates = Vector3::from(order.map(|k| eigen.eigenvalues[k]));
        let motion = Motion { strain: Matrix3::from_diagonal(&rates), ..*motion };
        Self { axes, motion, even: true }
    }

    /// Converts a direction from the harmonics' axes to the laboratory's.
    pub fn outward(&self, p: [f64; 3]) -> [f64; 3] {
        (self.axes.transpose() * Vector3::from(p)).into()
    }

    /// Converts a direction from the laboratory's axes to the harmonics'.
    pub fn inward(&self, p: [f64; 3]) -> [f64; 3] {
        (self.axes * Vector3::from(p)).into()
    }
}

fn turned(motion: &Motion, axes: &Matrix3<f64>) -> Motion {
    let strain = axes * motion.strain * axes.transpose();
    // The axes are right-handed: ω transforms as a vector.
    Motion { strain: (strain + strain.transpose()) * 0.5, spin: axes * motion.spin, ..*motion }
}

/// The mean axis of free rods over a long time. Any axis would be right; with this one, few orders m are needed.
fn gathered(motion: &Motion) -> Vector3<f64> {
    const STEPS: usize = 4000;
    let generator = motion.strain + motion.spin.cross_matrix();
    let step = (generator * (0.5 / generator.norm())).exp();
    let (mut map, mut sum) = (Matrix3::identity(), Matrix3::zeros());
    for _ in 0..STEPS {
        map = step * map;
        map /= map.norm();
        sum += map * map.transpose();
    }
    let eigen = SymmetricEigen::new(sum);
    eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned()
}
