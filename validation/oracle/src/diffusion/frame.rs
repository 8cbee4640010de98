//! The axes of the harmonics: those in which few of them are needed.
//!
//! Rods gather about one axis. About a pole they need many degrees l, but orders m for the shape of the peak alone. Where the
//! flow has a plane of reflection through that axis, the azimuth is counted from it and ψ has cosines alone.

use super::operator::Motion;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Axes, and what turns rods in them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Its rows are the axes x, y, z of the harmonics.
    pub axes: Matrix3<f64>,
    /// In these axes.
    pub motion: Motion,
    /// Whether ψ is even in the azimuth, if it was at t = 0.
    pub even: bool,
}

impl Frame {
    /// The axes for a motion that is given in those of the laboratory.
    pub fn of(motion: &Motion) -> Self {
        let spin = motion.spin;
        if spin == Vector3::zeros() {
            return Self::of_extension(motion);
        }
        let across = spin.cross(&(motion.strain * spin)).norm();
        let plane = across <= 8.0 * f64::EPSILON * spin.norm_squared() * motion.strain.norm();
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

    /// The axes of an extension: the one that stretches most is the pole.
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

    /// A direction of the harmonics' axes in those of the laboratory.
    pub fn outward(&self, p: [f64; 3]) -> [f64; 3] {
        (self.axes.transpose() * Vector3::from(p)).into()
    }

    /// A direction of the laboratory in the harmonics' axes.
    pub fn inward(&self, p: [f64; 3]) -> [f64; 3] {
        (self.axes * Vector3::from(p)).into()
    }
}

fn turned(motion: &Motion, axes: &Matrix3<f64>) -> Motion {
    let strain = axes * motion.strain * axes.transpose();
    // Axes of the right hand: ω turns as a vector.
    Motion { strain: (strain + strain.transpose()) * 0.5, spin: axes * motion.spin, ..*motion }
}

/// The axis about which free rods are, on average over a long time. Any axis is right; this one needs few orders m.
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
