//! The channels of observables, by name and index.

use super::Observable;

/// One channel of an observable: a column of its table.
///
/// ```
/// use shearbed::observable::Channel;
/// assert_eq!(Channel::X[0].name(), "x1");
/// assert_eq!(Channel::named("x1"), Some(Channel::X[0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    pub(crate) observable: Observable,
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

    /// The name of the channel's column.
    pub fn name(self) -> String {
        self.observable.columns()[self.index].to_owned()
    }

    /// Its symbol, with a unit in parentheses: `φ̄ (rad)`.
    pub fn symbol(self) -> String {
        self.observable.symbol(self.index)
    }

    /// The least and the largest mean that it can have.
    pub fn range(self) -> [f64; 2] {
        self.observable.range(self.index)
    }

    /// The channel whose column has this name.
    pub fn named(name: &str) -> Option<Self> {
        let mut all = Observable::ALL.into_iter().flat_map(Observable::channels);
        all.find(|channel| channel.name() == name)
    }

    /// The index of this channel among the channels of `observables`, one observable after the other; `None` if it is
    /// not among them.
    pub(crate) fn place(self, observables: &[Observable]) -> Option<usize> {
        let before = observables.iter().position(|o| *o == self.observable)?;
        let start: usize = observables[..before].iter().map(|o| o.width()).sum();
        Some(start + self.index)
    }
}
