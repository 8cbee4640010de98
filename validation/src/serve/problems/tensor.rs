//! Problems of means over infinitely many free rods that are isotropic at t = 0.

use super::asked::{COUETTE, SECOND, direction, periods_s};
use super::{Built, Kind, Problem, ProblemDef, tolerance};
use crate::files::csv::split;
use crate::oracle::reference::big::{Bits, digits};
use crate::oracle::reference::isotropic::Covariance;
use crate::oracle::reference::motion::{Motion, Unit};

/// Significant digits of a certified number: the quadrature is good to 24.
const DIGITS: usize = 22;

pub(super) fn problems() -> Vec<ProblemDef> {
    vec![
        ProblemDef::new("isotropic-3", "a_ij(t) of isotropic rods, r_e = 3", |def| {
            moments(def, COUETTE, 3.0, couette_times(3.0))
        }),
        ProblemDef::new("isotropic-11.6", "a_ij(t) of isotropic rods, r_e = 11.6", |def| {
            moments(def, COUETTE, 11.6, couette_times(11.6))
        }),
        ProblemDef::new("isotropic-extension", "a_ij(t) of isotropic rods in uniaxial extension", |def| {
            let extension = [[-0.5, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, 1.0]];
            moments(def, extension, 11.6, vec![0.25, 0.5, 1.0, 2.0, 3.0])
        }),
        ProblemDef::new("unequal-rods", "Mean projections of isotropic rods of unequal aspect ratios", unequal_rods),
    ]
}

/// Times up to a period, not only at its points of symmetry.
fn couette_times(aspect_ratio: f64) -> Vec<f64> {
    periods_s(aspect_ratio, &[0.02, 0.1, 0.2, 0.25, 0.4, 0.5, 0.7, 1.0])
}

fn moments(def: &ProblemDef, gradient_per_s: [[f64; 3]; 3], aspect_ratio: f64, times_s: Vec<f64>) -> Built {
    let motion = Motion { gradient_per_s, aspect_ratio };
    let end_s = times_s.last().copied().unwrap_or_default();
    let of_rods = match motion.couette() {
        Some(rate) => tolerance::couette(aspect_ratio, rate * end_s),
        None => tolerance::general(&motion, 0.0, &all_round(), end_s),
    };
    let row = |time: &f64| {
        let covariance = Covariance::at(&motion, &Bits(64).of(*time), Unit::Second);
        let moments = covariance.expect("seconds have a meaning in every flow").second();
        let values = moments.iter().map(|x| digits(x, DIGITS));
        std::iter::once(format!("{time:?}")).chain(values).collect()
    };
    let certified = times_s.iter().map(row).collect();
    let problem = Problem {
        summary: format!(
            "The orientation tensor a_ij = ⟨p_i p_j⟩ of infinitely many free rods of r_e = {aspect_ratio} that are \
             isotropic at t = 0, exact (elliptic integrals). A closure approximation of a_ijkl misses these values by \
             the error of the closure; a code that follows rods needs a quadrature over their starts that has \
             converged."
        ),
        gradient_per_s,
        aspect_ratio,
        times_s,
        tolerance: of_rods,
        because: because(of_rods),
        equations: vec![
            "the solution of Jeffery's equation (A.4 and A.5 of Lee & Springer 1982), averaged over isotropic starts \
             (their eq. 12): a_ij = ½∫ (adj M)_ij (det M)^(-3/2) dx, M = (F Fᵀ)⁻¹ + x, F = exp((W + ΛD)t), from x = 0 \
             to infinity"
                .into(),
        ],
        ..Problem::new(def, Kind::Tensor, &SECOND)
    };
    Built::new(problem, certified)
}

fn unequal_rods(def: &ProblemDef) -> Built {
    const SD_PERCENT: f64 = 3.6;
    let motion = Motion { gradient_per_s: COUETTE, aspect_ratio: 11.6 };
    let times_s = periods_s(motion.aspect_ratio, &[0.25, 0.5, 0.75, 1.0, 2.0, 3.0]);
    let of_rods = tolerance::couette(motion.aspect_ratio, motion.strain(times_s[times_s.len() - 1], Unit::Second));
    let problem = Problem {
        summary: "Mean projections x_i = ⟨|p_i|⟩ of infinitely many free rods, isotropic at t = 0, whose r_e is \
            Gaussian with mean 11.6 and a standard deviation of 3.6 % (the paper's): each has its own period, so the \
            phases mix and the oscillation dies out without any collision. By quadrature over r_e."
            .into(),
        aspect_ratio_sd_percent: SD_PERCENT,
        times_s,
        tolerance: of_rods,
        because: because(of_rods),
        equations: vec![
            "the solution of Jeffery's equation (A.4 and A.5 of Lee & Springer 1982), averaged over isotropic starts \
             (their eq. 12): means of |p_i| (their eq. 4) are elliptic integrals; then averaged over a Gaussian r_e \
             (their eq. 11)"
                .into(),
        ],
        ..Problem::new(def, Kind::Tensor, &["x1", "x2", "x3"])
    };
    Built::new(problem, UNEQUAL.lines().skip(1).map(split).collect())
}

/// The certified answer of `unequal-rods`, written by `examples/certify.rs`, which takes minutes.
const UNEQUAL: &str = include_str!("data/unequal-rods.csv");

fn because(tolerance: f64) -> String {
    format!(
        "A mean over rods is no worse than its worst rod, and |d(p_i p_j)| and |d|p_i|| are no more than the angle by \
         which p is off. A right code in double precision has every rod to {tolerance:e} rad at the last time, by the \
         rule of the problems of single rods, and weights of starts and aspect ratios that sum to 1 and have converged \
         add nothing."
    )
}

/// Directions all around, none of them on an axis.
fn all_round() -> Vec<[f64; 3]> {
    let thetas = (0..8).map(|i| 0.1 + 0.19 * f64::from(i));
    thetas.flat_map(|theta| (0..6).map(move |k| direction(0.2 + f64::from(k), theta))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::isotropic::mean_projections_polydisperse;
    use crate::oracle::reference::unequal::means_to_22_digits;

    #[test]
    fn the_table_of_unequal_rods_is_computed_anew_and_by_a_quadrature_in_doubles() {
        let built = crate::serve::problems::named("unequal-rods").unwrap();
        let (r, sd_percent) = (built.problem.aspect_ratio, built.problem.aspect_ratio_sd_percent);
        let rate = built.problem.gradient_per_s[1][0];
        // A quarter of a period: d = 2/π, and steps of 1/16 are d/10.
        let first = |sd_percent: f64| {
            let means = means_to_22_digits(rate, r, sd_percent, built.problem.times_s[0], 4);
            means.map(|x| digits(&x, DIGITS))
        };
        assert_eq!(first(sd_percent), built.certified[0][1..]);
        assert_ne!(first(3.7), built.certified[0][1..]);
        assert_eq!(built.certified.len(), built.problem.times_s.len());
        for (time, row) in built.problem.times_s.iter().zip(&built.certified) {
            assert_eq!(format!("{time:?}"), row[0]);
            let by_doubles =
                |sd_percent| mean_projections_polydisperse(r, sd_percent, time / super::super::asked::period_s(r));
            let off = |expected: [f64; 3]| {
                let found = row[1..].iter().map(|x| x.parse::<f64>().unwrap());
                crate::oracle::worst(found.zip(expected).map(|(a, b)| (a - b).abs()))
            };
            // The claimed accuracy of the quadrature in doubles.
            assert!(off(by_doubles(sd_percent)) < 2e-12, "{time}");
            assert!(off(by_doubles(3.7)) > 1e-6, "{time}");
            // More digits than rounding in doubles can lose, except for zeros at the end.
            let most = row[1..].iter().map(|x| x.len()).max().unwrap();
            assert!(most >= DIGITS, "{row:?}");
        }
    }
}
