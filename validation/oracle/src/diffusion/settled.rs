//! The steady density by elimination, degree by degree from the highest, of all unknowns but ψ's mean.

use super::frame::Frame;
use super::harmonics::Basis;
use super::means::{Functionals, MEANS};
use super::operator::Operator;
use super::{NoAnswer, WANTED};
use crate::apart;
use crate::reference::isotropic::QUADRUPLES;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Largest number of multiplications of an elimination: about ten seconds.
const MOST_WORK: f64 = 3e10;

/// Refinements in a row after which a change below [`SMALL`] that has not become smaller is due to rounding.
const STALLED: usize = 3;

/// A larger change may stand still because the density is not resolved at all yet.
const SMALL: f64 = 1e-7;

/// Means over the steady density, and their change when harmonics were last added.
pub(super) fn refined(frame: &Frame) -> Result<([f64; MEANS], f64), NoAnswer> {
    if frame.motion.diffusivity == f64::INFINITY {
        return Ok((isotropic(), 0.0));
    }
    if frame.motion.diffusivity <= 0.0 {
        return Err(NoAnswer::Unsettled);
    }
    let of = |degree: usize, order: usize| {
        let basis = Basis { degree: degree & !1, order, even: frame.even };
        if basis.degree as f64 * (basis.width(basis.degree) as f64).powi(3) > MOST_WORK {
            return Err(NoAnswer::TooMuchWork);
        }
        steady(frame, basis).ok_or(NoAnswer::Unsettled)
    };
    let more = |size: usize| size + size / 3 + 2;
    let (mut degree, mut order) = (20, 14);
    let mut means = of(degree, order)?;
    let (mut least, mut stalled) = (f64::INFINITY, 0);
    loop {
        let higher = of(more(degree), order)?;
        let degrees = apart(&means, &higher);
        let wider = of(more(degree), more(order))?;
        let orders = apart(&higher, &wider);
        let change = degrees.max(orders);
        if change <= WANTED {
            return Ok((wider, change));
        }
        stalled = if change < least || least > SMALL { 0 } else { stalled + 1 };
        least = least.min(change);
        if stalled == STALLED {
            return Err(NoAnswer::TooMuchWork);
        }
        // Degree or order is not raised if its change is less than a tenth of the other's.
        if degrees > 0.1 * orders {
            degree = more(degree);
            means = higher;
        }
        if orders > 0.1 * degrees {
            order = more(order);
            means = if degrees > 0.1 * orders { wider } else { of(degree, order)? };
        }
    }
}

fn isotropic() -> [f64; MEANS] {
    let mut means = [0.0; MEANS];
    means[..3].fill(0.5);
    means[3..6].fill(1.0 / 3.0);
    for (mean, indices) in means[9..].iter_mut().zip(QUADRUPLES) {
        let count = |axis| indices.iter().filter(|i| **i == axis).count();
        // Those of a Gaussian, over the mean of |p|⁴.
        *mean = [1, 2, 3].map(|axis| [1.0, 0.0, 1.0, 0.0, 3.0][count(axis)]).iter().product::<f64>() / 15.0;
    }
    means
}

/// Means over the steady density with these harmonics; `None` if there is none: rods without diffusion.
///
/// With S_L = A_LL and S_{l−2} = A_{l−2,l−2} − A_{l−2,l} K_l, K_l = S_l⁻¹ A_{l,l−2}: u_l = −K_l u_{l−2}. A row g of a
/// mean is reduced along with it, g_{l−2} ← g_{l−2} − g_l K_l, so that no K of a high degree is stored.
pub(super) fn steady(frame: &Frame, basis: Basis) -> Option<[f64; MEANS]> {
    let operator = Operator::new(&frame.motion, basis);
    let functionals = Functionals::new(frame, &basis);
    let rows = |l: usize| {
        let range = basis.offset(l)..basis.offset(l) + basis.width(l);
        DMatrix::from_fn(3, basis.width(l), |mean, at| functionals.moduli[mean][range.start + at])
    };
    let mut top = basis.degree;
    let mut pivot = block(&operator, top, top);
    let mut means = rows(top);
    let mut kept = Vec::new();
    while top > 0 {
        let below = top - 2;
        let factor = pivot.lu().solve(&block(&operator, top, below))?;
        pivot = block(&operator, below, below) - block(&operator, below, top) * &factor;
        means = rows(below) - means * &factor;
        if top <= 4 {
            kept.push(factor);
        }
        top = below;
    }
    let mut low = DVector::from_element(1, (4.0 * PI).recip().sqrt());
    let mut unknowns = vec![low[0]];
    for factor in kept.iter().rev() {
        low = -(factor * low);
        unknowns.extend(low.iter());
    }
    let mut all = functionals.of(&unknowns);
    (0..3).for_each(|mean| all[mean] = means[(mean, 0)] * unknowns[0]);
    all.iter().all(|x| x.is_finite()).then_some(all)
}

fn block(operator: &Operator, to: usize, from: usize) -> DMatrix<f64> {
    let basis = operator.basis;
    let (row, column) = (basis.offset(to), basis.offset(from));
    let mut block = DMatrix::zeros(basis.width(to), basis.width(from));
    for at in 0..basis.width(to) {
        for (other, entry) in operator.row(row + at) {
            if (column..column + basis.width(from)).contains(&other) {
                block[(at, other - column)] = entry;
            }
        }
    }
    block
}
