//! The claims of `docs/src/verification/integrators.md` on the problem and the integrators, beyond orders and limits.

use super::integrators::Integrators;
use super::integrators::in_p;
use super::*;
use crate::methods::integrators::*;
use crate::studies::stability::orbit::Place;
use crate::studies::work_precision::order;

/// A function that returns ṗ at an aspect ratio, in units of G.
type Rate = fn(&RodProblem, &Vector3<f64>) -> Vector3<f64>;

/// A function that returns ∂ṗ_i/∂p_j at an aspect ratio, in units of G.
type Slope = fn(&RodProblem, &Vector3<f64>) -> Matrix3<f64>;

pub fn cases() -> Vec<Case> {
    let through_shape: Rate = |problem, p| {
        let shape = shearbed::model::jeffery::shape_factor(problem.aspect_ratio);
        let pull = Vector3::new(-0.5 * (1.0 - shape) * p.y, 0.5 * (1.0 + shape) * p.x, 0.0);
        pull - p * (shape * p.x * p.y)
    };
    vec![
        Case::of(Judges::Integrator, "where-errors-show")
            .claim(
                "A phase that is off by a tenth of a period shows as an angle of less than 1/r_e where a long rod lies \
                 along the flow, and as more than ½ in its flip.",
            )
            .source("A.4")
            .under_test(1.0)
            .mistake("rods a thousandth as long", 1e-3)
            .check(where_errors_show),
        Case::of(Judges::Integrator, "right-hand-side-digits")
            .claim(
                "The right-hand sides of the integrators keep every digit of 1 − Λ, and with it the period, up to r_e \
                 = 10⁸.",
            )
            .source("eqs 15, A.1")
            .under_test((|problem: &RodProblem, p: &Vector3<f64>| problem.rate(p)) as Rate)
            .mistake("from Λ itself", through_shape)
            .mistake("1/r_e² for 1/(r_e² + 1)", |problem, p| {
                let r2 = problem.aspect_ratio.powi(2);
                Vector3::new(-p.y / r2, p.x, 0.0) - p * (p.x * p.y)
            })
            .check(digits),
        Case::of(Judges::Integrator, "flip-not-stiff")
            .claim(
                "No eigenvalue of Jeffery's equation in p is larger than (⅓ + Λ²)^½ G, or ½(1 + |Λ|) G where |Λ| < ⅓: \
                 at most 2/√3 G, so the flip is short, but the equation is not stiff.",
            )
            .source("A.1")
            .under_test((|problem: &RodProblem, p: &Vector3<f64>| problem.rate_slope(p)) as Slope)
            .mistake("the pull along p left out of the slope", |problem, p| {
                problem.rate_slope(p) + slope_of_pull(problem, p)
            })
            .mistake("twice the pull along p", |problem, p| problem.rate_slope(p) - slope_of_pull(problem, p))
            .mistake("a rod 1 % longer", |problem, p| RodProblem::new(1.01 * problem.aspect_ratio, 1.0).rate_slope(p))
            .check(eigenvalues),
        Case::of(Judges::Integrator, "who-loses-length")
            .claim("The integrators that do not claim to keep |p| lose it: each by more than round-off.")
            .source("A.1; p·ṗ = 0")
            .under_test(crate::methods::integrators::own as Integrators)
            .mistake("projected RK4 not said to keep it", || {
                in_p(4, false, |problem, p, h| rk4(|y| problem.rate(&y), p, h).normalize())
            })
            .check(lose_length),
        Case::of(Judges::Integrator, "coarse-steps")
            .claim(
                "At GΔt = 10 and r_e = 11.6 RK4 in p gives no finite direction, and projected RK4 a wrong one of \
                 length 1.",
            )
            .source("A.1")
            .under_test(10.0)
            .mistake("GΔt = 0.1", 0.1)
            .check(coarse),
        Case::of(Judges::Integrator, "grid-convergence-index")
            .claim(
                "At r_e = 11.6 the grid convergence index bounds the error of every fixed-step integrator on its \
                 finest three grids.",
            )
            .source("A.4, A.5")
            .under_test(crate::methods::integrators::own as Integrators)
            .mistake("explicit Euler said to be of order 3", || {
                in_p(3, false, |problem, p, h| p + h * problem.tangent_rate(&p))
            })
            .check(index_bounds),
    ]
}

fn slope_of_pull(problem: &RodProblem, p: &Vector3<f64>) -> Matrix3<f64> {
    let shape = shearbed::model::jeffery::shape_factor(problem.aspect_ratio);
    p * Vector3::new(shape * p.y, shape * p.x, 0.0).transpose()
}

fn where_errors_show(scale: &f64, _: &Effort) -> Vec<Evidence> {
    let apart = |r: f64, turns: [f64; 2]| {
        let rods = scale * r;
        let [a, b] = turns.map(|turns| Place::mid_flip(rods).before(turns).direction(rods).into_inner());
        apart_rad(&a, &b)
    };
    let ratios = [11.6, 100.0, 1e4, 1e8];
    vec![
        Evidence::on(
            "largest angle between two directions along the flow, a tenth of a period apart, times r_e",
            "rad",
        )
        .within(worst(ratios.map(|r| apart(r, [0.2, 0.3]) * r)), 1.0)
        .because(
            "A.4: π/2 − φ = cot(κ)/r_e, and cot κ changes by 2 cot 72° = 0.65 between the two, for the longest \
                 rods",
        ),
        Evidence::on("½ over the smallest angle between the flip and a tenth of a period before", "1/rad")
            .within(worst(ratios.map(|r| 0.5 / apart(r, [0.0, 0.1]))), 1.0)
            .because("from φ = 1 to a rod along the flow, π/2"),
    ]
}

fn digits(rate: &Rate, _: &Effort) -> [Evidence; 2] {
    let ratios = [1.01, 2.0, 11.6, 1e4, 1e8, 0.1, 1e-4, 1e-8];
    let rates = |r: f64| {
        let problem = RodProblem::new(r, 1.0);
        (rate(&problem, &Vector3::x()).y, -rate(&problem, &Vector3::y()).x)
    };
    // r_e² = long/short, without cancellation.
    let ratio = ratios.map(|r| {
        let (long, short) = rates(r);
        ((long / short).sqrt() / r - 1.0).abs()
    });
    let period = ratios.map(|r| {
        let (long, short) = rates(r);
        (2.0 * PI / (long * short).sqrt() / (2.0 * PI * (r + 1.0 / r)) - 1.0).abs()
    });
    let because = "a square, a sum, a quotient, a root: a dozen roundings";
    [("r_e read off the right-hand side", ratio), ("the period read off it", period)].map(|(what, errors)| {
        Evidence::on(format!("relative error of {what}"), "–")
            .within(worst(errors), 12.0 * f64::EPSILON)
            .because(because)
    })
}

/// The largest eigenvalue over G by theory, and its place φ of a rod in the plane of shear: there the
/// eigenvalues are −2Λxy ± i(½(1 − Λ) + Λx²) with x = cos φ, y = sin φ; out of the plane |λ|² is linear in y² and less.
fn largest_eigenvalue(r: f64) -> (f64, f64) {
    let shape = (r * r - 1.0) / (r * r + 1.0);
    let size = shape.abs();
    // A disc behaves as a rod rotated by a right angle.
    let first = if shape < 0.0 { PI / 2.0 } else { 0.0 };
    if size < 1.0 / 3.0 {
        return (0.5 * (1.0 + size), first);
    }
    let cos_squared = (1.0 + 3.0 * size) / (6.0 * size);
    ((1.0 / 3.0 + size * size).sqrt(), first + cos_squared.sqrt().acos())
}

fn eigenvalues(slope: &Slope, _: &Effort) -> Vec<Evidence> {
    let ratios = [1e-4, 0.1, 0.8, 1.01, 1.5, 2.0, 11.6, 1e4];
    let largest = |r: f64, phi: f64, theta: f64| {
        let p = orientation::from_angles(phi, theta).into_inner();
        worst(slope(&RodProblem::new(r, 1.0), &p).complex_eigenvalues().iter().map(|value| value.norm()))
    };
    let apart = ratios.map(|r| {
        let (expected, phi) = largest_eigenvalue(r);
        (largest(r, phi, PI / 2.0) / expected - 1.0).abs()
    });
    let above = pairs(ratios, pairs(0..48, 0..=24)).map(|(r, (i, j))| {
        let (phi, theta) = (PI * f64::from(i) / 24.0, PI * f64::from(j) / 24.0);
        largest(r, phi, theta) / largest_eigenvalue(r).0 - 1.0
    });
    let because = "eigenvalues of a matrix near 1, whose two largest are apart by 1.1 or more where they are largest";
    vec![
        Evidence::on("by how much the largest eigenvalue of ∂ṗ/∂p exceeds theory, over 1152 directions", "G")
            .within(worst(above), 1e-13)
            .because(because),
        Evidence::on("relative difference of the two where theory has it largest", "–")
            .within(worst(apart), 1e-13)
            .because(because),
    ]
}

fn lose_length(integrators: &Integrators, _: &Effort) -> Evidence {
    let (problem, start) = RodProblem::mid_flip(11.6);
    let steps = 1024;
    let keeps = |integrator: &Integrator| {
        let setting = match integrator.theory {
            Theory::Adaptive => Setting::Tolerance(1e-6),
            _ => Setting::Steps(steps),
        };
        let off = grade(integrator, &problem, &start, setting).map_or(0.0, |errors| errors.length);
        off <= 4.0 * steps as f64 * f64::EPSILON
    };
    let all = integrators();
    let losing = all.iter().filter(|integrator| !integrator.keeps_length && integrator.theory != Theory::Exact);
    Evidence::on("integrators listed as losing |p| that keep it to round-off", "integrators")
        .exact(losing.filter(|integrator| keeps(integrator)).count() as f64)
}

fn coarse(strain: &f64, _: &Effort) -> Evidence {
    let (problem, start) = RodProblem::mid_flip(11.6);
    let steps = Setting::Steps((problem.strain() / strain).round() as u64);
    let mut unlike = 0.0;
    for integrator in crate::methods::integrators::own() {
        let graded = grade(&integrator, &problem, &start, steps);
        let as_said = match (integrator.name.as_str(), graded) {
            ("RK4 in p", graded) => graded == Err(Failure::NotFinite),
            ("projected RK4 in p", Ok(errors)) => errors.length < 1e-12 && errors.orientation_rad > 0.01,
            ("projected RK4 in p", Err(_)) => false,
            _ => true,
        };
        unlike += f64::from(!as_said);
    }
    Evidence::on("of RK4 in p and projected RK4 in p, those that end otherwise than claimed", "integrators")
        .exact(unlike)
}

fn index_bounds(integrators: &Integrators, _: &Effort) -> Evidence {
    let (problem, start) = RodProblem::mid_flip(11.6);
    let shares = (integrators().iter())
        .filter_map(|integrator| order::study(integrator, &problem, &start, 8))
        .map(|study| study.richardson.map_or(f64::NAN, |richardson| richardson.true_error / richardson.index))
        .collect::<Vec<_>>();
    Evidence::on("largest error over its index", "× its index")
        .within(worst(shares), 1.0)
        .because("the index is 1.25 times the error where the error falls with the order of theory")
}
