//! The density in time: exp(At) of the sparse operator by Taylor's series, with as many harmonics as each time needs.

use super::NoAnswer;
use super::frame::Frame;
use super::harmonics::Basis;
use super::means::Functionals;
use super::operator::Operator;
use super::start::projected;

/// The accuracy of a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The norm of the harmonics that are left out.
    pub tail: f64,
    /// The norm of the operator times a step.
    pub step: f64,
    /// The largest degree.
    pub most: usize,
}

/// Largest number of multiplications of a solution: about a minute.
const MOST_WORK: f64 = 1e11;

/// The largest degree of a density that is turned to other axes: seconds.
const MOST_TURNED: usize = 128;

/// What is read off a density.
pub enum Read<'a> {
    /// The means, in the order of [`Means`](super::Means).
    Means,
    /// ψ in these directions of the laboratory's axes.
    Density(&'a [[f64; 3]]),
}

/// A density that is integrated in time.
pub struct Density<'a> {
    frame: &'a Frame,
    accuracy: Accuracy,
    operator: Operator,
    unknowns: Vec<f64>,
    norm: f64,
    work: f64,
}

impl<'a> Density<'a> {
    /// Starts from the unknowns `unknowns` of `basis`.
    pub fn new(frame: &'a Frame, accuracy: Accuracy, basis: Basis, unknowns: Vec<f64>) -> Self {
        let operator = Operator::new(&frame.motion, basis);
        let norm = frame.motion.norm(basis.degree);
        Self { frame, accuracy, operator, unknowns, norm, work: 0.0 }
    }

    /// Advances the density by `time_s` seconds.
    ///
    /// # Errors
    ///
    /// If that takes too much work.
    pub fn advance(&mut self, time_s: f64) -> Result<(), NoAnswer> {
        let mut left = time_s;
        while left > 0.0 {
            let steps = (left * self.norm / self.accuracy.step).ceil().max(1.0);
            let (after, work) = self.after(left / steps)?;
            let basis = self.operator.basis;
            let (degree, order) = needed(&basis, &after, self.accuracy.tail);
            // A step is accepted if its result leaves the margin empty; else it is repeated with more harmonics.
            let full = (
                degree + 2 > basis.degree && basis.degree < self.accuracy.most,
                order + 2 > basis.order && basis.order < basis.degree,
            );
            if full.0 || full.1 {
                let more = |now: usize, full: bool| if full { now + now / 4 + 4 } else { now };
                self.keep(more(basis.degree, full.0), more(basis.order, full.1));
                continue;
            }
            self.unknowns = after;
            left = if steps == 1.0 { 0.0 } else { left - left / steps };
            // The rest would take about as much a step: what is far too much is refused at once.
            if self.work + work * (steps - 1.0) > 2.0 * MOST_WORK {
                return Err(NoAnswer::TooMuchWork);
            }
            // Reduces the harmonics if many are empty.
            if 2 * basis.degree > 3 * degree + 32 || 2 * basis.order > 3 * order + 16 {
                self.keep(degree + degree / 4 + 8, order + order / 4 + 4);
            }
        }
        Ok(())
    }

    /// Σ (hA)^k/k! applied to the unknowns, up to terms below the rounding of doubles, and its multiplications.
    fn after(&mut self, time_s: f64) -> Result<(Vec<f64>, f64), NoAnswer> {
        let mut sum = self.unknowns.clone();
        let mut term = sum.clone();
        let mut next = vec![0.0; sum.len()];
        let least = 1e-17 * norm(&term);
        let mut before = f64::INFINITY;
        let mut work = 0.0;
        for k in 1..1000 {
            self.operator.apply(time_s / f64::from(k), &term, &mut next);
            std::mem::swap(&mut term, &mut next);
            sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum += term);
            let size = norm(&term);
            work += self.operator.len() as f64;
            if before + size <= least {
                break;
            }
            before = size;
        }
        self.work += work;
        if self.work > MOST_WORK { Err(NoAnswer::TooMuchWork) } else { Ok((sum, work)) }
    }

    /// Changes to this many harmonics.
    fn keep(&mut self, degree: usize, order: usize) {
        let basis = self.operator.basis;
        let degree = (degree.min(self.accuracy.most) + 1) & !1;
        let kept = Basis { degree, order: order.min(degree), ..basis };
        self.unknowns = kept.take(&basis, &self.unknowns);
        self.operator = Operator::new(&self.frame.motion, kept);
        self.norm = self.frame.motion.norm(degree);
    }

    /// What is asked for at the current time.
    pub fn read(&self, read: &Read) -> Vec<f64> {
        match read {
            Read::Means => Functionals::new(self.frame, &self.operator.basis).of(&self.unknowns).into(),
            Read::Density(directions) => directions.iter().map(|p| self.value(*p)).collect(),
        }
    }

    /// ψ in a direction of the laboratory's axes.
    fn value(&self, p: [f64; 3]) -> f64 {
        let values = self.operator.basis.values(self.frame.inward(p));
        values.iter().zip(&self.unknowns).map(|(value, unknown)| value * unknown).sum()
    }

    /// The harmonics of this density in other axes, of the same degree.
    ///
    /// # Errors
    ///
    /// If that takes too much work.
    pub fn seen_from(&self, frame: &Frame) -> Result<(Basis, Vec<f64>), NoAnswer> {
        let basis = self.operator.basis;
        if self.frame.axes == frame.axes && basis.even == frame.even {
            return Ok((basis, self.unknowns.clone()));
        }
        if basis.degree > MOST_TURNED {
            return Err(NoAnswer::TooMuchWork);
        }
        let turned = Basis { order: basis.degree, even: false, ..basis };
        Ok((turned, projected(&turned, &|p| self.value(frame.outward(p)))))
    }
}

/// The smallest degree and order beyond which the norm is below `tail`.
fn needed(basis: &Basis, unknowns: &[f64], tail: f64) -> (usize, usize) {
    let (mut degrees, mut orders) = (vec![0.0; basis.degree + 1], vec![0.0; basis.order + 1]);
    for ((l, m, _), value) in basis.unknowns().zip(unknowns) {
        degrees[l] += value * value;
        orders[m] += value * value;
    }
    let last = |squares: &[f64]| {
        let mut beyond = 0.0;
        let full = |(_, square): &(usize, &f64)| {
            beyond += **square;
            beyond > tail * tail
        };
        squares.iter().enumerate().rev().find(full).map_or(0, |(at, _)| at)
    };
    (last(&degrees), last(&orders))
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|x| x * x).sum::<f64>().sqrt()
}
