//! Checks of results: every rod must have a unit direction, every sum must be
//! finite, and the traces of ⟨pp⟩ and ⟨pppp⟩ must be 1.

use crate::observable::{Block, Observe, Sum, lane_sum};

/// The largest deviation from 1 of a block's mean |p|²: p = q/|q| is rounded about ten times, each time by at most ε/2
/// relatively, and counts twice; the sum over 128 rods in 8 lanes is rounded 24 times.
const DIRECTION: f64 = 32.0 * f64::EPSILON;

/// The largest deviation from 1 of the trace of ⟨pp⟩: 10⁸ rods are summed as 16 per lane, 512 blocks per chunk and 1526
/// chunks, each sum with a relative rounding of at most ε/2.
const TRACE: f64 = 4096.0 * f64::EPSILON;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    /// Index of the rod, counted from the first rod checked; `None` if the fault is not of a single rod.
    pub rod: Option<usize>,
    pub cause: String,
}

/// Fails if a rod of `block` has no unit direction: if its length is off by more than 5e-13 or is not a number. One sum
/// checks all rods, which costs less than a comparison per rod.
#[inline]
pub(crate) fn directions(block: &Block) -> Result<(), Fault> {
    let [p1, p2, p3] = &block.p;
    let square = move |k: usize| p1[k] * p1[k] + p2[k] * p2[k] + p3[k] * p3[k];
    let count = block.len as f64;
    // NaN fails this comparison too.
    if (lane_sum(block.len, square) - count).abs() <= count * DIRECTION { Ok(()) } else { Err(farthest(block, square)) }
}

/// A fault that names the rod whose |p|² is farthest from 1.
fn farthest(block: &Block, square: impl Fn(usize) -> f64) -> Fault {
    let off = |rod: &usize| match (square(*rod) - 1.0).abs() {
        off if off.is_nan() => f64::INFINITY,
        off => off,
    };
    let rods = 0..block.len;
    let first_of_equals = |a, b| if off(&b) > off(&a) { b } else { a };
    let rod = rods.reduce(first_of_equals).unwrap_or(0);
    let [p1, p2, p3] = block.p.each_ref().map(|axis| axis[rod]);
    Fault {
        rod: Some(rod),
        cause: format!(
            "its direction came out as ({p1}, {p2}, {p3}), whose length is not 1: the motion of r_e = {} in this flow \
             is out of reach of double precision",
            block.aspect_ratio[rod]
        ),
    }
}

/// Fails if sums of an observable are not finite; `block` is the last that was added.
#[inline]
pub(crate) fn sums(observable: &dyn Observe, block: &Block, sums: &[Sum]) -> Result<(), Fault> {
    if sums.iter().all(Sum::is_finite) {
        return Ok(());
    }
    let culprit = (0..block.len).find_map(|rod| {
        let mut own = vec![Sum::default(); sums.len()];
        observable.add(&alone(block, rod), &mut own);
        let channel = own.iter().position(|sum| !sum.value.is_finite())?;
        Some((rod, channel, own[channel].value))
    });
    Err(match culprit {
        Some((rod, channel, value)) => Fault {
            rod: Some(rod),
            cause: format!(
                "its {} came out as {value}, at r_e = {}",
                observable.columns()[channel],
                block.aspect_ratio[rod]
            ),
        },
        None => Fault { rod: None, cause: format!("the sum of {} is not finite", observable.name()) },
    })
}

/// Fails if `sums` over `count` rods are of a tensor whose trace, over all pairs of indices, is not 1.
pub(crate) fn trace(observable: &dyn Observe, sums: &[Sum], count: usize) -> Result<(), Fault> {
    let Some((tensor, sum)) = observable.trace(sums) else {
        return Ok(());
    };
    let trace = sum / count as f64;
    if (trace - 1.0).abs() <= TRACE {
        Ok(())
    } else {
        Err(Fault { rod: None, cause: format!("the trace of {tensor} came out as {trace}, not 1") })
    }
}

fn alone(block: &Block, rod: usize) -> Block {
    let mut one = Block { len: 1, ..Block::default() };
    for (axis, from) in one.p.iter_mut().zip(&block.p) {
        axis[0] = from[rod];
    }
    one.aspect_ratio[0] = block.aspect_ratio[rod];
    one.weight[0] = block.weight[rod];
    one
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::orientation::from_angles;
    use crate::observable::Observable;

    /// A block of `len` directions all over the sphere.
    fn block(len: usize) -> Block {
        let mut block = Block { len, ..Block::default() };
        for rod in 0..len {
            let p = from_angles(2.4 * rod as f64, 0.1 + 3.0 * rod as f64 / len as f64);
            for (axis, value) in block.p.iter_mut().zip([p.x, p.y, p.z]) {
                axis[rod] = value;
            }
        }
        block
    }

    #[test]
    fn good_directions_pass_and_any_other_is_named() {
        for len in [1, 7, 8, 100, 128] {
            assert_eq!(directions(&block(len)), Ok(()));
            for wrong in
                [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0], [0.6, 0.8, 1e-5], [1.0 - 1e-12, 0.0, 0.0]]
            {
                let rod = len / 2;
                let mut spoiled = block(len);
                (0..3).for_each(|axis| spoiled.p[axis][rod] = wrong[axis]);
                let fault = directions(&spoiled).unwrap_err();
                assert_eq!(fault.rod, Some(rod), "{wrong:?}");
                assert!(fault.cause.contains("whose length is not 1"));
            }
        }
        // Values beyond the block's end are ignored.
        let mut short = block(10);
        short.len = 9;
        short.p[0][9] = f64::NAN;
        assert_eq!(directions(&short), Ok(()));
    }

    #[test]
    fn sums_that_are_not_finite_name_the_rod_and_its_channel() {
        let good = block(20);
        for observable in Observable::ALL {
            let mut found = vec![Sum::default(); observable.width()];
            observable.add(&good, &mut found);
            assert_eq!(sums(&*observable, &good, &found), Ok(()));
            assert_eq!(trace(&*observable, &found, 20), Ok(()));
        }
        let mut spoiled = block(20);
        spoiled.p[2][13] = f64::NAN;
        let mut found = vec![Sum::default(); 3];
        Observable::Projections.add(&spoiled, &mut found);
        let fault = sums(&*Observable::Projections, &spoiled, &found).unwrap_err();
        assert_eq!(fault.rod, Some(13));
        assert_eq!(fault.cause, "its x3 came out as NaN, at r_e = 1");
        // No rod of this block caused it.
        let fault = sums(&*Observable::Projections, &good, &found).unwrap_err();
        assert_eq!((fault.rod, fault.cause.as_str()), (None, "the sum of projections is not finite"));
    }

    #[test]
    fn a_trace_that_is_not_one_is_refused() {
        let good = block(128);
        let mut found = vec![Sum::default(); 6];
        Observable::OrientationTensor.add(&good, &mut found);
        assert_eq!(trace(&*Observable::OrientationTensor, &found, 128), Ok(()));
        // A lost rod, then lost digits.
        assert!(trace(&*Observable::OrientationTensor, &found, 129).is_err());
        found[1].value += 1e-9;
        let fault = trace(&*Observable::OrientationTensor, &found, 128).unwrap_err();
        assert!(fault.cause.starts_with("the trace of ⟨pp⟩ came out as 1.0000000000"));
        found[1].value = f64::NAN;
        assert!(trace(&*Observable::OrientationTensor, &found, 128).is_err());
        // ⟨pppp⟩: each component of its trace counts.
        let mut found = vec![Sum::default(); 15];
        Observable::OrientationTensor4.add(&good, &mut found);
        assert_eq!(trace(&*Observable::OrientationTensor4, &found, 128), Ok(()));
        for k in [0, 3, 5, 10, 12, 14] {
            let mut spoiled = found.clone();
            spoiled[k].value += 1e-9;
            let fault = trace(&*Observable::OrientationTensor4, &spoiled, 128).unwrap_err();
            assert!(fault.cause.starts_with("the trace of ⟨pppp⟩"), "{k}");
        }
    }
}
