//! Likelihood-ratio tests of hypotheses about fitted keys: that a key has a given value, or that two sets of points
//! share one value. The statistic is the rise of χ²: its minimum under the hypothesis less its minimum.

use super::error::HypothesisError;
use super::range::Range;
use super::search::Fit;
use crate::methods::least_squares::profile::{fixed, rise_of, rise_to};
use crate::oracle::reference::big::finite;
use crate::serve::sweep::key_and_text;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Places along the box of two tied keys, before the minimum is sought between them.
const PLACES: usize = 17;

/// A place nearer than this to an edge of the box counts as at the edge: the golden section ends within 4e-4.
const EDGE: f64 = 1e-3;

/// Number of bisections for an end of an interval: to 1e-5 of a box.
const HALVINGS: usize = 18;

/// Steps of the golden section towards the least χ²: to 4e-4 of a box, and χ² depends on the square of that.
const STEPS: usize = 12;

/// The smallest p-value that is reported.
pub const LEAST_P: f64 = 1e-6;

/// A hypothesis about fitted keys.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    text: String,
    /// The label of a fitted key.
    key: String,
    against: Against,
}

#[derive(Clone, Debug, PartialEq)]
enum Against {
    Value(f64),
    /// The label of another fitted key.
    Key(String),
}

/// A hypothesis about parameters of a fit, by their indices.
enum Asked {
    Value(usize, f64),
    /// The difference of two parameters is 0.
    Difference([usize; 2]),
}

/// The result of a test.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tested {
    /// The text of the hypothesis.
    pub hypothesis: String,
    /// χ² at its least under the hypothesis, less χ² at its least.
    pub rise_of_chi2: f64,
    /// True if the hypothesis lies outside the last box of the search: then the rise is at least, and p at most, what
    /// is given here.
    pub beyond_the_box: bool,
    /// The probability of a larger rise under the hypothesis, by χ² of one degree of freedom; never below 10⁻⁶, as
    /// simulations did not test smaller values.
    pub p_value: f64,
    /// The first value less the second, for a comparison of two keys.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub difference: Option<Difference>,
}

/// A difference of two values in their unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// The best value.
    pub estimate: f64,
    /// The 68 % interval by profile likelihood.
    pub low_68: f64,
    /// Its upper end.
    pub high_68: f64,
    /// The 95 % interval.
    pub low_95: f64,
    /// Its upper end.
    pub high_95: f64,
    /// True where an end of the 95 % interval, lower and upper, is set by an edge of the box: the points may allow
    /// more.
    pub ends_at_edge: [bool; 2],
}

impl Hypothesis {
    /// Parses `[SET:]KEY=VALUE`.
    ///
    /// # Errors
    ///
    /// A text of another form; the message lists the allowed forms.
    pub fn parse(text: &str) -> Result<Self, String> {
        const SHAPE: &str =
            "KEY=VALUE is allowed, as interaction.alpha=1, and SET:KEY=OTHER:KEY for two sets with a value each";
        let (key, other) = text.split_once('=').ok_or_else(|| format!("{text:?} is no hypothesis; {SHAPE}"))?;
        let (key, other) = (key.trim(), other.trim());
        let against = match (finite(other), other.split_once(':')) {
            (Some(value), _) => Against::Value(value),
            (_, Some((_, last))) if key.split_once(':').is_some_and(|(_, own)| own == last) && key != other => {
                Against::Key(other.to_owned())
            }
            _ => return Err(format!("{other:?} is no value; {SHAPE}")),
        };
        key_and_text(&format!("{}=", key.rsplit(':').next().unwrap_or(key)), SHAPE)?;
        Ok(Self { text: format!("{key}={other}"), key: key.to_owned(), against })
    }

    /// The text of the hypothesis.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The hypothesis with the indices of its keys among the fitted ones.
    fn asked(&self, ranges: &[Range]) -> Result<Asked, HypothesisError> {
        let axis = |label: &String| {
            let axis = ranges.iter().position(|range| range.label() == *label);
            axis.ok_or_else(|| HypothesisError::NotFitted(label.clone(), ranges.iter().map(Range::label).collect()))
        };
        let own = axis(&self.key)?;
        match &self.against {
            Against::Value(value) => {
                let Range { from, to, .. } = ranges[own];
                if (from..=to).contains(value) {
                    Ok(Asked::Value(own, *value))
                } else {
                    Err(HypothesisError::OutOfRange(*value, [from, to]))
                }
            }
            Against::Key(label) => {
                let axes = [own, axis(label)?];
                let [a, b] = axes.map(|axis| &ranges[axis]);
                if a.from.max(b.from) <= a.to.min(b.to) {
                    Ok(Asked::Difference(axes))
                } else {
                    Err(HypothesisError::NothingInCommon([a.from, a.to, b.from, b.to]))
                }
            }
        }
    }

    /// Checks the hypothesis against the fitted keys and their ranges.
    ///
    /// # Errors
    ///
    /// A key that is not fitted, a value outside its range, or two ranges without a common value.
    pub fn check(&self, ranges: &[Range]) -> Result<(), HypothesisError> {
        self.asked(ranges).map(|_| ())
    }

    /// Performs the likelihood-ratio test.
    ///
    /// # Errors
    ///
    /// Those of [`Hypothesis::check`].
    pub fn test(&self, fit: &Fit) -> Result<Tested, HypothesisError> {
        let (rise, beyond_the_box, difference) = match self.asked(&fit.ranges)? {
            Asked::Value(axis, value) => {
                let place = fit.place(axis, value);
                let rise = rise_to(&fit.best, &fixed(&fit.best, &[(axis, place.clamp(-1.0, 1.0))]));
                // The value at the box's edge differs from the edge by rounding.
                (rise, place.abs() > 1.0 + 1e-9, None)
            }
            Asked::Difference(axes) => {
                let tied = Tied { fit, axes };
                let (low, high) = tied.ends();
                let rise = tied.rise(0.0_f64.clamp(low, high)).0;
                (rise, !(low..=high).contains(&0.0), Some(tied.difference()))
            }
        };
        let p = ChiSquared::new(1.0).map_or(f64::NAN, |law| law.sf(rise));
        Ok(Tested {
            hypothesis: self.text.clone(),
            rise_of_chi2: rise,
            p_value: if p < LEAST_P { LEAST_P } else { p },
            beyond_the_box,
            difference,
        })
    }
}

struct Tied<'a> {
    fit: &'a Fit,
    axes: [usize; 2],
}

impl Tied<'_> {
    /// The smallest and the largest difference within the box.
    fn ends(&self) -> (f64, f64) {
        let [a, b] = self.axes.map(|axis| [-1.0, 1.0].map(|place| self.fit.value(axis, place)));
        (a[0] - b[1], a[1] - b[0])
    }

    /// The rise of χ² at the best pair with this difference, and true if that pair is at an edge of the box.
    fn rise(&self, difference: f64) -> (f64, bool) {
        let [a, b] = self.axes;
        let at = |place: f64| {
            let other = self.fit.place(b, self.fit.value(a, place) - difference);
            // Allows for rounding at the edges.
            if other.abs() > 1.0 + 1e-9 {
                return f64::INFINITY;
            }
            rise_to(&self.fit.best, &fixed(&self.fit.best, &[(a, place), (b, other.clamp(-1.0, 1.0))]))
        };
        // The part of the box in which both keys are inside it.
        let [low, high] = [-1.0, 1.0].map(|side| {
            let place = self.fit.place(a, self.fit.value(b, side) + difference);
            place.clamp(-1.0, 1.0)
        });
        let place = |k: usize| low + (high - low) * k as f64 / (PLACES - 1) as f64;
        let least = (0..PLACES).min_by(|i, j| at(place(*i)).total_cmp(&at(place(*j)))).unwrap_or_default();
        let (mut from, mut to) = (place(least.saturating_sub(1)), place((least + 1).min(PLACES - 1)));
        for _ in 0..STEPS {
            let [left, right] = [0.382, 0.618].map(|part| from + part * (to - from));
            if at(left) < at(right) { to = right } else { from = left }
        }
        let best = if at(0.5 * (from + to)) < at(place(least)) { 0.5 * (from + to) } else { place(least) };
        (at(best), (best - low).min(high - best) < EDGE)
    }

    fn difference(&self) -> Difference {
        let [a, b] = self.axes.map(|axis| self.fit.value(axis, self.fit.best.place[axis]));
        let (low, high) = self.ends();
        let end = |confidence: f64, edge: f64| {
            let level = rise_of(confidence);
            if self.rise(edge).0 <= level {
                return (edge, true);
            }
            let (mut inner, mut outer) = (a - b, edge);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (inner + outer);
                *(if self.rise(middle).0 <= level { &mut inner } else { &mut outer }) = middle;
            }
            let found = 0.5 * (inner + outer);
            (found, self.rise(found).1)
        };
        let [inner, outer] = [0.68, 0.95].map(|confidence| [end(confidence, low), end(confidence, high)]);
        Difference {
            estimate: a - b,
            low_68: inner[0].0,
            high_68: inner[1].0,
            low_95: outer[0].0,
            high_95: outer[1].0,
            ends_at_edge: outer.map(|(_, at_edge)| at_edge),
        }
    }
}
