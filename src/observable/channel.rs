//! The channels of observables, and their names.

use super::{BINS, Observable};

/// One number of an observable: a column of its table.
///
/// ```
/// use shearbed::observable::Channel;
/// assert_eq!(Channel::X[0].name(), "x1");
/// assert_eq!(Channel::named("x1"), Some(Channel::X[0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    observable: Observable,
    index: usize,
}

impl Channel {
    /// x1, x2 and x3: the mean projections on the axes.
    pub const X: [Self; 3] = [Self::projection(0), Self::projection(1), Self::projection(2)];

    /// phi: the mean of φ folded into [0, π/2] (eq. 18).
    pub const PHI: Self = Self::new(Observable::MeanAngle, 0);

    const fn projection(index: usize) -> Self {
        Self::new(Observable::Projections, index)
    }

    pub(super) const fn new(observable: Observable, index: usize) -> Self {
        Self { observable, index }
    }

    /// The name of its column.
    pub fn name(self) -> String {
        let fixed: &[&str] = match self.observable {
            Observable::Projections => &["x1", "x2", "x3"],
            Observable::PlanarProjections => &["x1x2", "x2x3", "x1x3"],
            Observable::MeanAngle => &["phi"],
            Observable::OrbitConstant => &["c_b"],
            Observable::OrientationTensor => &["a11", "a22", "a33", "a12", "a13", "a23"],
            Observable::OrientationTensor4 => &[
                "a1111", "a1112", "a1113", "a1122", "a1123", "a1133", "a1222", "a1223", "a1233", "a1333",
                "a2222", "a2223", "a2233", "a2333", "a3333",
            ],
            Observable::ParticleStress => &["s12_per_mu_fiber_g", "n1_per_mu_fiber_g", "n2_per_mu_fiber_g"],
        };
        match fixed.get(self.index) {
            Some(&name) => name.to_owned(),
            None => format!("density_from_{:.2}", (self.index - 1) as f64 / BINS as f64),
        }
    }

    /// The channel whose column has this name.
    pub fn named(name: &str) -> Option<Self> {
        let mut all = Observable::ALL.into_iter().flat_map(Observable::channels);
        all.find(|channel| channel.name() == name)
    }

    /// Which of the channels of `observables`, put one after the other, it is.
    pub(crate) fn place(self, observables: &[Observable]) -> Option<usize> {
        let before = observables.iter().position(|o| *o == self.observable)?;
        let start: usize = observables[..before].iter().map(|o| o.width()).sum();
        Some(start + self.index)
    }
}
