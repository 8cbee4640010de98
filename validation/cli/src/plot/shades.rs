//! Curves of a sweep over one key with numbers, in shades from the smallest value to the largest.

use super::Drawn;
use shearbed_validation::oracle::reference::big::finite;
use shearbed_validation::present::plot::names;
use std::collections::BTreeSet;

/// With fewer curves their colours and names in the legend are easier to read.
const LEAST: usize = 6;

/// Orders and shades the curves, if they are many, of one channel, and of one sweep over numbers. Their bands, which
/// would cover each other, are left out.
pub(super) fn colour(drawn: &mut Drawn) {
    let value = |point: &Option<Vec<(String, String)>>| match point.as_deref() {
        Some([(key, value)]) => Some((key.clone(), finite(value)?)),
        _ => None,
    };
    let Some(points) = drawn.runs.iter().map(|run| value(&run.point)).collect::<Option<Vec<_>>>() else { return };
    let key = points[0].0.clone();
    let values: BTreeSet<u64> = points.iter().map(|(_, value)| value.to_bits()).collect();
    if drawn.channels.len() > 1
        || values.len() < points.len()
        || points.len() < LEAST
        || points.iter().any(|(other, _)| *other != key)
    {
        return;
    }
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|a, b| points[*a].1.total_cmp(&points[*b].1));
    let shaded = order.iter().map(|k| {
        let mut curve = drawn.figure.curves[*k].clone();
        curve.label = names::short(&points[*k].1.to_string());
        curve.half_band = None;
        curve
    });
    drawn.figure.curves = shaded.collect();
    drawn.figure.shaded_by = Some(names::key(&key));
}
