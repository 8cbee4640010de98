//! How near an answer must be to a mistake's curve, and what is said of it then.

use super::mistakes::IN_THE_START;
pub(super) use crate::methods::turning::apart;

/// An answer belongs to a mistake's curve if it is a thousand times nearer to it than to the truth: for one direction
/// and some fifty curves this happens by chance with a probability of 10⁻⁴, for several rows far more rarely.
pub(super) const NEARER: f64 = 1e-3;

/// What a wrong answer in time is.
pub(super) const CURVE: &str = "this is the curve";

/// What a wrong answer without time is.
pub(super) const VALUES: &str = "these are the values";

/// How the names of other orders of axes begin.
pub const LAID_OUT: &str = "axes in the order ";

/// Above this number of names none is reported: most mistakes share a curve that has come to rest.
const MOST_NAMES: usize = 5;

/// The diagnosis of an answer to one problem.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnosis {
    /// The diagnosis in words, if it is certain.
    pub said: Option<String>,
    /// The mistakes whose curve the answer is.
    pub suspects: Vec<String>,
    /// How far the answer is from that curve.
    pub distance: f64,
}

impl Diagnosis {
    /// A sentence without a known mistake.
    pub(super) fn sentence(said: &str) -> Self {
        Self { said: Some(said.to_owned()), ..Self::default() }
    }

    /// A finding that is its own name.
    pub(super) fn named(what: &str, name: &str) -> Self {
        Self { suspects: vec![name.to_owned()], ..Self::sentence(&format!("{what} {name}")) }
    }

    /// Nothing, where the answer is farther from the curve than `most`.
    pub(super) fn within(self, most: f64) -> Self {
        if self.distance <= most { self } else { Self::default() }
    }
}

/// The largest of the distances; `None` at the first that is missing, NaN or above `most`: most curves are far already
/// in the first row.
pub(super) fn largest_within(most: f64, distances: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    distances.map(|distance| distance.filter(|distance| *distance <= most)).try_fold(0.0, |a: f64, b| Some(a.max(b?)))
}

/// An answer that a wrong code may give.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Near {
    pub(super) distance: f64,
    /// The name, to stand after "this is the curve of".
    pub(super) name: String,
    /// Names of the mistake alone, which other problems may share.
    pub(super) suspects: Vec<String>,
    pub(super) advice: &'static str,
    /// The number of differences from what is asked.
    pub(super) changes: u8,
}

impl Near {
    pub(super) fn new(distance: f64, name: &str) -> Self {
        Self { distance, name: name.to_owned(), suspects: vec![name.to_owned()], advice: "", changes: 1 }
    }
}

/// The nearest of `near` with the fewest changes, and those that are indistinguishable from it here, in words after
/// `what`; `rest` is added.
pub(super) fn said(what: &str, mut near: Vec<Near>, tolerance: f64, rest: &str) -> Diagnosis {
    near.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let Some(nearest) = near.first().map(|near| near.distance.max(f64::EPSILON)) else { return Diagnosis::default() };
    near.retain(|near| near.distance <= (10.0 * nearest).max(tolerance));
    let fewest = near.iter().map(|near| near.changes).min().unwrap_or_default();
    near.retain(|near| near.changes == fewest);
    // Plane Couette flow is its own mirror image in axis 3: reversals in the start and in the answer are the same.
    let found: Vec<_> = near.iter().map(|near| near.name.clone()).collect();
    near.retain(|near| !near.name.strip_suffix(IN_THE_START).is_some_and(|name| found.iter().any(|own| own == name)));
    // A mistake is likelier than other axes.
    near.sort_by_key(|near| near.name.starts_with(LAID_OUT));
    let names: Vec<_> = near.iter().map(|near| near.name.as_str()).collect();
    let advice = shared(near.iter().map(|near| near.advice));
    let said = format!("{what} of {}, to {nearest:.0e}{rest}{advice}", names.join(" or of "));
    let said = (names.len() <= MOST_NAMES).then_some(said);
    let mut suspects: Vec<_> = near.into_iter().flat_map(|near| near.suspects).collect();
    suspects.sort();
    suspects.dedup();
    Diagnosis { said, suspects, distance: nearest }
}

/// Advice that all give, to stand at the end of a sentence.
pub(super) fn shared<'a>(mut advice: impl Iterator<Item = &'a str>) -> String {
    let first = advice.next().filter(|first| !first.is_empty() && advice.all(|other| other == *first));
    first.map_or(String::new(), |advice| format!("; {advice}"))
}

#[test]
fn only_the_nearest_are_named() {
    let near = [("a", 1e-9), ("b", 5e-9), ("c", 2e-8)].map(|(name, distance)| Near::new(distance, name));
    let named = |tolerance| said(CURVE, near.to_vec(), tolerance, "").suspects;
    assert_eq!((named(0.0), named(3e-8)), (vec!["a".into(), "b".into()], vec!["a".into(), "b".into(), "c".into()]));
    let found = said(CURVE, near.to_vec(), 0.0, "");
    assert_eq!(
        (found.clone().within(1e-9), found.within(9e-10)),
        (said(CURVE, near.to_vec(), 0.0, ""), Diagnosis::default())
    );
}
