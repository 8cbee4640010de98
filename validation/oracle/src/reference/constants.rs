//! Constants of a motion in plane Couette flow: T, ⟨φ⟩, orbits, and the means when phases are mixed.

use super::big::{Big, Bits, each_power};
use super::motion::Motion;
use super::rod::{self, Direction};

const BITS: Bits = Bits(192);

/// A constant of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// Name of the constant.
    pub quantity: &'static str,
    /// Value in `unit`.
    pub value: Big,
    /// Unit, `1` for pure numbers.
    pub unit: &'static str,
    /// Source: equation numbers are Lee & Springer's.
    pub equation: &'static str,
}

fn constant(quantity: &'static str, value: Big, unit: &'static str, equation: &'static str) -> Constant {
    Constant { quantity, value, unit, equation }
}

/// The constants of plane Couette flow for one r_e; `start` is that of a single rod, or `None` for rods isotropic at t
/// = 0.
///
/// `None` in any other flow.
pub fn constants(motion: &Motion, start: Option<Direction>) -> Option<Vec<Constant>> {
    let rate = BITS.of(motion.couette()?.abs());
    let strain = motion.strain_per_period(BITS);
    let r = BITS.of(motion.aspect_ratio);
    let two_pi = BITS.pi() * BITS.of(2.0);
    let square = r.sqr();
    let mut all = vec![
        constant("period", &strain / &rate, "s", "15"),
        constant("strain_per_period", strain.clone(), "1", "15"),
        constant("angular_velocity", two_pi * &rate / strain, "1/s", "A.4, 15"),
        constant("lambda", (&square - BITS.of(1.0)) / (&square + BITS.of(1.0)), "1", "A.1"),
        constant("mean_angle", mean_angle(&r), "rad", "19"),
    ];
    let (names, values, equation) = match start {
        Some(start) => {
            let (p, c_b) = rod::orbit(motion, start);
            let [across, along] = inclination(&p, &r);
            all.push(constant("c_b", c_b, "1", "13, 18"));
            let equation = "A.4, A.5, 13: mean over a period";
            (PHASE_MEANS, phase_means(&across, &along, &r), equation)
        }
        None => {
            let equation = "A.4, A.5, 12, 13: mean over a period, then over isotropic orbits";
            (PLATEAUS, plateaus(&r), equation)
        }
    };
    let means = names.into_iter().zip(values);
    all.extend(means.map(|(name, value)| constant(name, value, "1", equation)));
    Some(all)
}

const PHASE_MEANS: [&str; 6] = ["mean_x1", "mean_x2", "mean_x3", "mean_a11", "mean_a22", "mean_a33"];
const PLATEAUS: [&str; 6] = ["plateau_x1", "plateau_x2", "plateau_x3", "plateau_a11", "plateau_a22", "plateau_a33"];

/// ⟨φ⟩ of eq. 19, rad: (2/π)[π²/8 + ∫₁^{r_e} ln x/(x² − 1) dx] = π/4 + (2/π) χ₂((r_e − 1)/(r_e + 1)).
///
/// Legendre's χ₂(x) = Σ x^{2k+1}/(2k+1)², by its series for x² ≤ 0.2, and beyond by χ₂(x) + χ₂(k) = π²/8 + ln k artanh
/// k with k = (1 − x)/(1 + x) (Lewin, Polylogarithms, 1.67).
fn mean_angle(r: &Big) -> Big {
    let one = BITS.of(1.0);
    let (pi, half) = (BITS.pi(), BITS.of(0.5));
    let factor = BITS.of(2.0) / &pi;
    let x = (r - &one) / (r + &one);
    let tail = |k: &Big| &factor * (chi_2(k) - k.ln() * k.atanh());
    if x.sqr() <= BITS.of(0.2) {
        &pi / BITS.of(4.0) + factor * chi_2(&x)
    } else if x > Big::ZERO {
        pi * half - tail(&(one / r))
    } else {
        tail(r)
    }
}

/// χ₂(x) for |x| ≤ ½: 96 terms leave 2⁻¹⁹².
fn chi_2(x: &Big) -> Big {
    let square = x.sqr();
    let mut power = x.clone();
    let mut sum = BITS.of(0.0);
    for k in 0..96 {
        sum += &power / BITS.of(f64::from((2 * k + 1_i32).pow(2)));
        power *= &square;
    }
    sum
}

/// sin β and cos β with tan β = C, of a rod along p.
fn inclination(p: &[Big; 3], r: &Big) -> [Big; 2] {
    let across = (p[0].sqr() + (&p[1] / r).sqr()).sqrt();
    let long = (across.sqr() + p[2].sqr()).sqrt();
    [&across / &long, p[2].sqr().sqrt() / long]
}

/// Means over a period of |p₁|, |p₂|, |p₃|, p₁², p₂², p₃² of a rod in the orbit C = tan β.
///
/// From φ = 0 the rod is p ∝ (sin β cos ωt, r_e sin β sin ωt, cos β). With s² = r_e² − 1 the quarter-period integrals
/// of |p_i| are asinh(s sin β)/s, (r_e/s) atan(s sin β) and cos β K; for r_e < 1, s is imaginary. With |q| = w at ωt =
/// π/2, those of p_i² are sin²β/(1 + w), r_e² sin²β/(w(1 + w)) and cos²β/w.
fn phase_means(sine: &Big, cosine: &Big, r: &Big) -> [Big; 6] {
    let one = BITS.of(1.0);
    let far = (cosine.sqr() + (r * sine).sqr()).sqrt();
    let difference = (r - &one) * (r + &one);
    let s = difference.sqr().sqrt().sqrt();
    let x = &s * sine;
    let (first, second) = if x == Big::ZERO {
        (sine.clone(), sine.clone())
    } else if difference > Big::ZERO {
        (x.asinh() / &s, x.atan() / &s)
    } else {
        (x.atan2(&far) / &s, (&x / &far).asinh() / &s)
    };
    let factor = BITS.of(2.0) / BITS.pi();
    let third = cosine * complete(&far, &one, &one);
    let across = sine.sqr();
    [
        &factor * first,
        &factor * r * second,
        factor * third,
        &across / (&one + &far),
        r.sqr() * across / (&far * (&one + &far)),
        cosine.sqr() / far,
    ]
}

/// Means of |p₁|, |p₂|, |p₃|, p₁², p₂², p₃² when the phases of isotropic rods are mixed: their orbits do not change.
///
/// ∫ f(C) ⟨…⟩_C dC with f(C) = (2r_e/π) C E(m)/((1 + C²)^½(1 + r_e²C²)), m = (1 − r_e²)C²/(1 + C²), by the trapezoid
/// rule in u = ln C. It is analytic for |Im u| < π/2, so the error falls as e^{−2π·½π/h}: with h = ln 9/8 that is
/// e^{−80} at 0.95 of it. It rises as C or faster below min(1, 1/r_e) and falls as 1/C above max(1, 1/r_e): beyond 62
/// there, e^{−62}.
fn plateaus(r: &Big) -> [Big; 6] {
    let one = BITS.of(1.0);
    let steps = |range: f64| (range / 1.125f64.ln()).ceil() as usize;
    let knee = -super::big::double(&r.ln());
    let (left, right) = (steps(62.0 - knee.min(0.0)), steps(62.0 + knee.max(0.0)));
    let mut sums = [0; 6].map(|_| BITS.of(0.0));
    let add = |c: &Big| {
        let square = c.sqr();
        let (whole, long) = (&one + &square, &one + (r * c).sqr());
        let k = (&long / &whole).sqrt();
        let cosine = &one / whole.sqrt();
        let sine = c * &cosine;
        // f(C) C without the factor 2r_e/π.
        let weight = square * complete(&k, &one, &k.sqr()) * &cosine / long;
        for (sum, mean) in sums.iter_mut().zip(phase_means(&sine, &cosine, r)) {
            *sum += mean * &weight;
        }
    };
    let up = BITS.of(1.125);
    each_power(&one, &up, left, right, add);
    let factor = BITS.of(2.0) * r / BITS.pi() * up.ln();
    sums.map(|sum| sum * &factor)
}

/// ∫₀^{π/2} (a cos²t + b sin²t)(cos²t + k² sin²t)^{-½} dt, k > 0 (Bulirsch's cel with p = 1): K for a = b = 1, E for b
/// = k².
fn complete(k: &Big, a: &Big, b: &Big) -> Big {
    let (mut k, mut a, mut b) = (k.clone(), a.clone(), b.clone());
    let (mut e, mut m, mut p) = (k.clone(), BITS.of(1.0), BITS.of(1.0));
    let two = BITS.of(2.0);
    loop {
        let before = a.clone();
        a += &b / &p;
        let g = &e / &p;
        b = &two * (before * &g + &b);
        p += g;
        let last = m.clone();
        m += &k;
        // The next step would square this difference.
        let apart = (&last - &k) / &last;
        if apart.sqr() <= BITS.of(2f64.powi(-200)) {
            return BITS.pi() / &two * (a * &m + b) / (&m * (&m + p));
        }
        k = &two * e.sqrt();
        e = &k * &m;
    }
}

#[cfg(test)]
mod tests {
    use super::super::big::double;
    use super::*;
    use crate::closed_form;
    use crate::isotropic::plateau_projections;
    use crate::quadrature::{integrate, spread};
    use std::f64::consts::TAU;

    fn apart(found: &Big, expected: f64) -> f64 {
        (double(found) - expected).abs()
    }

    fn doubles(values: &[Big]) -> Vec<f64> {
        values.iter().map(double).collect()
    }

    #[test]
    fn mean_angles_are_eq_19_on_both_sides_of_their_seams() {
        let seams = [1.0 - 1e-5, 1.0 + 1e-5, 1.42 / 0.58, 0.58 / 1.42];
        let beside = seams.into_iter().flat_map(|r| [r * (1.0 - 1e-14), r * (1.0 + 1e-14)]);
        for r in spread(200).map(|(u, _)| 1e8f64.powf(2.0 * u - 1.0)).chain(beside) {
            let found = mean_angle(&BITS.of(r));
            // Eq. 19 as it stands, with a panel that ends where φ is 45° and another at a quarter period.
            let phi = |turns: f64| (r * (TAU * turns).sin()).atan2((TAU * turns).cos());
            let expected = 4.0 * integrate(phi, &[0.0, r.recip().atan() / TAU, 0.25], 1e-15);
            assert!(apart(&found, expected) < 2e-15, "{r}");
            assert!(apart(&found, closed_form::mean_angle(r)) < 4e-16, "{r}");
            // Wrong variant: φ at the middle of the quarter, T/8.
            assert!(r.ln().abs() < 0.1 || apart(&found, r.atan()) > 1e-9);
            let sum = found + mean_angle(&(BITS.of(1.0) / BITS.of(r)));
            assert!(((sum - BITS.pi() / BITS.of(2.0)) * BITS.of(1e50)).sqr() < BITS.of(1.0));
        }
        let half_pi = std::f64::consts::FRAC_PI_2;
        assert_eq!(double(&mean_angle(&BITS.of(1.0))), half_pi / 2.0);
        assert_eq!(double(&mean_angle(&BITS.of(1e100))), half_pi);
        assert!(double(&mean_angle(&BITS.of(1e-100))) < 2e-98);
    }

    #[test]
    fn phase_means_are_those_of_the_motion() {
        for (u, v) in spread(100) {
            let (r, c) = (1e4f64.powf(1.5 * u - 0.5), 1e3f64.powf(2.0 * v - 1.0));
            let cosine = BITS.of(1.0) / (BITS.of(1.0) + BITS.of(c).sqr()).sqrt();
            let found = phase_means(&(BITS.of(c) * &cosine), &cosine, &BITS.of(r));
            // The motion itself over a whole period: panels end where a component is 0 or φ is 45° off an axis.
            let (sin_beta, cos_beta) = c.atan().sin_cos();
            let squares_at = |turns: f64| {
                let (s, co) = (TAU * turns).sin_cos();
                let q = [sin_beta * co, r * sin_beta * s, cos_beta].map(|x| x * x);
                q.map(|x| x / (q[0] + q[1] + q[2]))
            };
            let knee = r.recip().atan() / TAU;
            let mut breaks = [0.0, 0.25, 0.5, 0.75, 1.0, knee, 0.5 - knee, 0.5 + knee, 1.0 - knee];
            breaks.sort_by(f64::total_cmp);
            let expected = [0, 1, 2].map(|i| integrate(|turns| squares_at(turns)[i].sqrt(), &breaks, 1e-15));
            // The tolerance is the round-off of eight panels and their halvings.
            assert!((0..3).all(|i| apart(&found[i], expected[i]) < 1e-14), "{r} {c}");
            let in_doubles = closed_form::phase_means(c, r);
            assert!((0..3).all(|i| apart(&found[i], in_doubles[i]) < 1e-15), "{r} {c}");
            // Wrong variant: r_e upside down.
            let wrong = closed_form::phase_means(c, 1.0 / r);
            assert!(r.ln().abs() < 0.1 || (0..3).any(|i| apart(&found[i], wrong[i]) > 1e-5));
            // A fine grid of phases converges geometrically for p².
            let n = 200_000;
            let mut squares = [0.0; 3];
            for k in 0..n {
                let share = squares_at(f64::from(k) / f64::from(n));
                (0..3).for_each(|i| squares[i] += share[i] / f64::from(n));
            }
            assert!((0..3).all(|i| apart(&found[3 + i], squares[i]) < 1e-12), "{r} {c}");
            let sum = &found[3] + &found[4] + &found[5] - BITS.of(1.0);
            assert!(apart(&sum, 0.0) < 1e-50);
        }
    }

    #[test]
    fn plateaus_are_the_doubles_own_and_those_of_a_sphere() {
        for r in [0.01, 0.3, 3.0, 11.6, 300.0] {
            let (found, expected) = (plateaus(&BITS.of(r)), plateau_projections(r));
            for i in 0..3 {
                // The tolerance is the claimed accuracy of the quadrature in doubles.
                assert!((double(&found[i]) / expected[i] - 1.0).abs() < 5e-15, "{r} {i}");
            }
            let sum: f64 = doubles(&found[3..]).iter().sum();
            assert!((sum - 1.0).abs() < 1e-15);
            assert!(apart(&found[0], closed_form::phase_means(3f64.sqrt(), r)[0]) > 1e-6);
        }
        let sphere = doubles(&plateaus(&BITS.of(1.0)));
        let expected = [0.5, 0.5, 0.5, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0];
        assert_eq!(sphere, expected);
    }
}
