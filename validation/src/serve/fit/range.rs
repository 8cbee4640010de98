//! `[SET:]KEY=FROM:TO`: a key of the scene and the range in which its value is sought, for all sets of points or for
//! one.

use crate::oracle::reference::big::finite;
use crate::serve::sweep::key_and_text;
use serde::Serialize;

/// A range of positive values is covered evenly in the logarithm if its ends have at least this ratio.
const DECADE: f64 = 10.0;

/// A key of the scene with the range of its value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Range {
    /// The key, such as `interaction.alpha`.
    pub key: String,
    /// The set of points whose scene alone has this parameter, counted from 1; none where all scenes share it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub set: Option<usize>,
    /// The smallest value, in the unit of the key.
    pub from: f64,
    /// The largest value, above `from`.
    pub to: f64,
}

impl Range {
    /// Parses `[SET:]KEY=FROM:TO`.
    pub fn parse(text: &str) -> Result<Self, String> {
        const SHAPE: &str = "KEY=FROM:TO is allowed, as interaction.alpha=0.05:5, and SET:KEY=FROM:TO";
        let (set, text) = match text.split_once(':') {
            Some((set, rest)) if !set.contains('=') => {
                let number = set.trim().parse().ok().filter(|number| *number > 0);
                (Some(number.ok_or_else(|| format!("{set:?} is no set of points; {SHAPE}"))?), rest)
            }
            _ => (None, text),
        };
        let (key, ends) = key_and_text(text, SHAPE)?;
        let (from, to) = (ends.split_once(':')).ok_or_else(|| format!("{ends:?} is no range; {SHAPE}"))?;
        let refused = |text: &str| format!("{text:?} is no end of a range; a finite number is allowed: {SHAPE}");
        let number = |text: &str| finite(text).ok_or_else(|| refused(text));
        let (from, to) = (number(from)?, number(to)?);
        if from < to {
            Ok(Self { key: key.to_owned(), set, from, to })
        } else {
            Err(format!("{from}:{to} is no range; FROM < TO is allowed"))
        }
    }

    /// The parameter as given: `interaction.alpha`, `2:interaction.alpha`.
    pub fn label(&self) -> String {
        self.set.map_or_else(|| self.key.clone(), |set| format!("{set}:{}", self.key))
    }

    /// The last word of the key, for sentences and names of files: `alpha`, `alpha_2`.
    pub fn name(&self) -> String {
        let last = self.key.rsplit('.').next().unwrap_or(&self.key);
        self.set.map_or_else(|| last.to_owned(), |set| format!("{last}_{set}"))
    }

    /// True if the parameter applies to the scene of `set`, counted from 0.
    pub fn is_of(&self, set: usize) -> bool {
        self.set.is_none_or(|own| own == set + 1)
    }

    /// True if the range is covered evenly in the logarithm: both ends positive and at least a factor of ten apart.
    pub fn is_logarithmic(&self) -> bool {
        self.from > 0.0 && self.to / self.from >= DECADE
    }

    /// `value` on the scale on which the range is covered evenly; −∞ for a value without a logarithm.
    pub fn scaled(&self, value: f64) -> f64 {
        if self.is_logarithmic() { value.max(0.0).ln() } else { value }
    }

    /// The value at `scaled` on that scale, clamped to the range.
    pub fn value(&self, scaled: f64) -> f64 {
        let value = if self.is_logarithmic() { scaled.exp() } else { scaled };
        value.clamp(self.from, self.to)
    }

    /// Derivative of the value with respect to its place on that scale.
    pub fn slope(&self, scaled: f64) -> f64 {
        if self.is_logarithmic() { scaled.exp() } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_positive_ranges_are_logarithmic_and_keep_their_ends() {
        let range = Range::parse("interaction.alpha=0.05:5").unwrap();
        assert!(range.is_logarithmic());
        assert_eq!(range.name(), "alpha");
        for value in [0.05, 0.5, 5.0] {
            let back = range.value(range.scaled(value));
            assert!((back - value).abs() < 1e-15 * value.max(1.0), "{back}");
        }
        // dα/d ln α = α.
        assert!((range.slope(range.scaled(0.7)) - 0.7).abs() < 1e-15);
        assert_eq!(range.value(9.0), 5.0);
        for text in ["a=0:5", "a=-1:5", "a=1:9"] {
            assert!(!Range::parse(text).unwrap().is_logarithmic(), "{text}");
        }
    }

    #[test]
    fn a_range_may_be_of_one_set() {
        let of_all = Range::parse("interaction.alpha=0.05:5").unwrap();
        let own = Range::parse("2:interaction.alpha=0.05:5").unwrap();
        assert_eq!((own.set, own.key.as_str()), (Some(2), "interaction.alpha"));
        assert_eq!((own.label().as_str(), own.name().as_str()), ("2:interaction.alpha", "alpha_2"));
        assert_eq!([0, 1, 2].map(|set| own.is_of(set)), [false, true, false]);
        assert_eq!((of_all.label().as_str(), of_all.is_of(7)), ("interaction.alpha", true));
    }
}
