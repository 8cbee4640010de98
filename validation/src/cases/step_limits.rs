//! The longest steps of fixed-step integrators against theory, by bisection (`docs/src/developer/step-limits.md`).

use super::integrators::Integrators;
use super::integrators::{in_angles, in_p};
use super::*;
use crate::methods::integrators::limits::{Limit, Property, longest};
use crate::methods::integrators::*;
use crate::studies::stability::theory;
use std::sync::Arc;

/// Integrators that should lose a property at a step given by theory.
struct Claimed {
    integrators: Integrators,
    property: Property,
    theory: fn(f64) -> f64,
    /// The error of the longest step, which is found too long, in δ², δ = π/1024: one of the 512 rods is that close to
    /// the extreme one.
    found_late: f64,
}

/// The extreme rods of explicit Euler are those with the largest Λ sin 2φ or Λ cos 2φ: the nearest rod has 1 − 2δ² of
/// it.
const OF_EULER: f64 = 3.0;
/// The Lie-group midpoint rule evaluates the rate half a step ahead, where rods are up to 1 + π/2 times as far apart:
/// (1 + π/2)²δ² of the largest rate.
const HALF_A_STEP_AHEAD: f64 = 7.0;
/// Midpoints are up to three times as far apart as the rods where p_3 changes its sign, 2(3δ)², and farther where that
/// limit meets that of the order, r_e = 2.5: five times is allowed.
const OF_MIDPOINTS: f64 = 50.0;

fn named(name: &str) -> Vec<Integrator> {
    let mut all = crate::methods::integrators::own();
    all.retain(|integrator| integrator.name == name);
    all
}

const EULER: Integrators = || named("explicit Euler in angles");
const HALF_EULER: Integrators =
    || in_angles(1, |problem, y, h| explicit_euler(|y| 0.5 * problem.angle_rates(&y), y, h));
const RK4_IN_ANGLES: Integrators = || named("RK4 in angles");
const IMPLICIT_MIDPOINT: Integrators = || named("implicit midpoint in p");

pub fn cases() -> Vec<Case> {
    let claimed =
        |property, found_late, integrators: Integrators, theory| Claimed { integrators, property, theory, found_late };
    let order = |integrators| claimed(Property::Order, OF_EULER, integrators, theory::euler_order);
    let turning = |integrators| claimed(Property::Turning, HALF_A_STEP_AHEAD, integrators, theory::euler_turning);
    let side = |integrators, theory| claimed(Property::Side, OF_MIDPOINTS, integrators, theory);
    let folded = |integrators, theory| claimed(Property::Order, OF_MIDPOINTS, integrators, theory);
    vec![
        Case::of(Judges::Integrator, "euler-step-limit")
            .claim("Explicit Euler's step on A.2 lets one rod overtake another where GΔt > 1/Λ, and never below.")
            .source("A.2; A.14 is such a step")
            .under_test(order(EULER))
            .mistake("half of the rate", order(HALF_EULER))
            .mistake("RK4", order(RK4_IN_ANGLES))
            .mistake("the exact propagator", order(|| vec![exact_propagator()]))
            .check(agrees),
        Case::of(Judges::Integrator, "step-limit-turning")
            .claim(
                "Explicit Euler and the Lie-group midpoint rule turn every rod in the plane of shear by less than half \
                 a turn a step up to GΔt = π(1 + 1/r_e²), and not beyond.",
            )
            .source("A.2; A.14 is such a step")
            .under_test(turning(|| [EULER(), named("Lie-group midpoint")].into_iter().flatten().collect()))
            .mistake("half of the rate", turning(HALF_EULER))
            .mistake("RK4", turning(RK4_IN_ANGLES))
            .mistake("the exact propagator", turning(|| vec![exact_propagator()]))
            .check(agrees),
        Case::of(Judges::Integrator, "rods-come-to-rest")
            .claim(
                "Just above GΔt = π(1 + 1/r_e²) explicit Euler brings every rod in the plane of shear to rest where \
                 there is no rest; just below it none stops.",
            )
            .source("A.2; A.14 is such a step")
            .under_test(EULER)
            .mistake("half of the rate", HALF_EULER)
            .mistake("RK4", RK4_IN_ANGLES)
            .check(rest),
        Case::of(Judges::Integrator, "step-limit-side")
            .claim("Explicit Euler lets no rod cross the plane of shear up to GΔt = 2/Λ, and not beyond.")
            .source("A.3; A.14 is such a step")
            .under_test(Claimed { found_late: OF_EULER, ..side(EULER, theory::euler_side) })
            .mistake("half of the rate", side(HALF_EULER, theory::euler_side))
            .mistake("RK4", side(RK4_IN_ANGLES, theory::euler_side))
            .check(agrees),
        Case::of(Judges::Integrator, "implicit-midpoint-order")
            .claim(
                "The implicit midpoint rule keeps the order of rods in the plane of shear at every step for r_e < 1 + \
                 √2, and for longer rods up to GΔt = 2/(Λ(1 − u²)^{3/2}), 2u³ − 3u + 1/Λ = 0.",
            )
            .source("A.2; A.14 is such a step")
            .under_test(folded(IMPLICIT_MIDPOINT, theory::implicit_midpoint_order))
            .mistake(
                "no limit, as an A-stable method on a linear equation",
                folded(IMPLICIT_MIDPOINT, |_| f64::INFINITY),
            )
            .mistake(
                "the explicit midpoint rule",
                folded(|| named("Lie-group midpoint"), theory::implicit_midpoint_order),
            )
            .mistake("Newton's method after two changes", folded(two_changes, theory::implicit_midpoint_order))
            .check(agrees),
        Case::of(Judges::Integrator, "implicit-midpoint-side")
            .claim(
                "The implicit midpoint rule lets no rod cross the plane of shear up to GΔt = 4/Λ or up to where its \
                 order is lost, whichever is less, and not beyond.",
            )
            .source("A.3; A.14 is such a step")
            .under_test(side(IMPLICIT_MIDPOINT, theory::implicit_midpoint_one_solution))
            .mistake("4/Λ at every r_e", side(IMPLICIT_MIDPOINT, theory::implicit_midpoint_side))
            .mistake("where its order is lost, at every r_e", side(IMPLICIT_MIDPOINT, theory::implicit_midpoint_order))
            .mistake("explicit Euler", side(EULER, theory::implicit_midpoint_one_solution))
            .check(agrees),
        Case::of(Judges::Integrator, "step-limit-at-least")
            .claim(
                "Explicit methods of order p in angles keep the order of rods at least up to GΔtΛ = x, x + … + xᵖ/p! = \
                 1; in the plane of shear the Lie-group RKMK4 is RK4 in angles.",
            )
            .source("A.2; A.14 is such a step")
            .under_test(
                (|| {
                    ["explicit Euler in angles", "RK4 in angles", "Lie-group midpoint", "Lie-group RKMK4"]
                        .into_iter()
                        .flat_map(named)
                        .collect()
                }) as Integrators,
            )
            .mistake("RK4 in steps of three times the length", || {
                in_angles(4, |problem, y, h| rk4(|y| problem.angle_rates(&y), y, 3.0 * h))
            })
            .mistake("RK4 in p in place of RKMK4", || {
                vec![RK4_IN_ANGLES(), named("RK4 in p")].into_iter().flatten().collect()
            })
            .check(at_least),
        Case::of(Judges::Integrator, "rk4-near-a-sphere")
            .claim(
                "As r_e → 1, RK4 in p turns every rod up to GΔt = 2√6 and its length is bounded up to 4√2, its limit \
                 on the imaginary axis.",
            )
            .source("A.1; A.14 is such a step")
            .under_test((|| named("RK4 in p")) as Integrators)
            .mistake("RK4 in angles", RK4_IN_ANGLES)
            .mistake("explicit Euler in p", || in_p(1, false, |problem, p, h| p + h * problem.rate(&p)))
            .mistake("the linear equation with half its rate", || {
                in_p(4, false, |problem, p, h| rk4(|y| problem.rate(&y), p, 0.5 * h))
            })
            .check(near_a_sphere),
        Case::of(Judges::Integrator, "frozen-limit")
            .claim(
                "RK4 in p loses its length before the limit that frozen coefficients give on the real axis, GΔt = \
                 2.785/Λ, for r_e from 1.5 to 100.",
            )
            .source("A.1; A.14 is such a step")
            .under_test((|| named("RK4 in p")) as Integrators)
            .mistake("projected", || named("projected RK4 in p"))
            .mistake("in angles", RK4_IN_ANGLES)
            .mistake("steps of a third of the length", thirds)
            .check(frozen),
    ]
}

/// RK4 in p by three steps for each.
fn thirds() -> Vec<Integrator> {
    let thrice = |setting: Setting| setting.steps().map(|steps| Setting::Steps(3 * steps));
    let third = |rk4: Integrator| {
        let rk4 = Arc::new(rk4);
        let one = Arc::clone(&rk4);
        Integrator::new("in p", rk4.theory, move |problem, start, setting| {
            one.advance(problem, start, thrice(setting)?)
        })
        .with_many(move |problem, starts, setting| rk4.advance_all(problem, starts, thrice(setting)?))
    };
    named("RK4 in p").into_iter().map(third).collect()
}

/// The implicit midpoint rule, stopped after two iterations.
fn two_changes() -> Vec<Integrator> {
    in_p(2, true, |problem, p, h| {
        let mut m = p;
        for _ in 0..2 {
            let miss = m - p - problem.tangent_rate(&m) * (0.5 * h);
            let slope = nalgebra::Matrix3::identity() - problem.tangent_rate_slope(&m) * (0.5 * h);
            m -= slope.try_inverse().unwrap_or_default() * miss;
        }
        m + m - p
    })
}

/// Aspect ratios of rods, and of a disc, which behaves as a rod rotated by a right angle.
const RATIOS: [f64; 9] = [0.1, 1.1, 1.5, 2.0, 2.5, 3.0, 11.6, 100.0, 1e4];

fn agrees(claimed: &Claimed, _: &Effort) -> Vec<Evidence> {
    let judged = |integrator: Integrator| {
        let off = RATIOS.map(|r| {
            let expected = (claimed.theory)(r);
            match longest(&integrator, claimed.property, r) {
                Limit::At(strain) => (strain / expected - 1.0).abs(),
                Limit::Beyond(strain) if expected > strain => 0.0,
                Limit::Beyond(_) | Limit::Below(_) => f64::INFINITY,
            }
        });
        Evidence::on(format!("relative difference of the longest step and theory, {}", integrator.name), "–")
            .within(worst(off), claimed.found_late * (PI / 1024.0).powi(2))
            .because(
                "δ² times what stretches δ: of 512 rods one is within δ = π/1024 of the extreme one, where what is \
                 judged is flat",
            )
    };
    (claimed.integrators)().into_iter().map(judged).collect()
}

fn rest(integrators: &Integrators, _: &Effort) -> Vec<Evidence> {
    let [mut moving, mut resting] = [0.0; 2];
    for integrator in integrators() {
        for (r, k) in pairs([2.0, 11.6, 100.0], 0..32) {
            let limit = theory::euler_turning(r);
            let start = orientation::from_angles(PI * f64::from(k) / 32.0, FRAC_PI_2);
            // The angle turned in the last of many steps, up to sign.
            let last = |strain: f64| {
                let steps = |steps: u64| {
                    let turns = steps as f64 * strain / RodProblem::new(r, 1.0).strain();
                    integrator.advance(&RodProblem::new(r, turns), &start, Setting::Steps(steps))
                };
                match (steps(1000), steps(1001)) {
                    (Ok(a), Ok(b)) => apart_rad(&a, &b),
                    _ => f64::NAN,
                }
            };
            let (above, below) = (last(1.02 * limit), last(0.98 * limit));
            moving += f64::from(above.is_nan() || above > 1e-6);
            resting += f64::from(below.is_nan() || below < 1e-6);
        }
    }
    vec![
        Evidence::on("rods still moving after 1000 steps of 1.02 times the limit", "rods").exact(moving),
        Evidence::on("rods at rest after 1000 steps of 0.98 times the limit", "rods").exact(resting),
    ]
}

fn at_least(integrators: &Integrators, _: &Effort) -> Vec<Evidence> {
    let mut evidence = Vec::new();
    let mut classical: Vec<f64> = Vec::new();
    for integrator in integrators() {
        let Theory::Order(order) = integrator.theory else {
            continue;
        };
        let longest = RATIOS.map(|r| match longest(&integrator, Property::Order, r) {
            Limit::At(strain) => strain,
            _ => f64::NAN,
        });
        let above = |(r, longest): (&f64, f64)| {
            let ratio = theory::runge_kutta_order_at_least(order, *r) / longest;
            if ratio < 1.0 { 0.0 } else { ratio - 1.0 }
        };
        let quantity = "relative excess of the bound over the longest step without overtaking";
        let because = "a bound from below, and for explicit Euler the limit itself: too few rods find a step too \
                       long, which is no excuse; the bisection ends at 10⁻⁷";
        evidence.push(
            Evidence::on(format!("{quantity}, {}", integrator.name), "–")
                .within(worst(RATIOS.iter().zip(longest).map(above)), 1e-6)
                .because(because),
        );
        if order == 4 {
            let off = classical.iter().zip(longest).map(|(first, longest)| (longest / first - 1.0).abs());
            evidence.push(
                Evidence::on(format!("relative difference to the first of order 4, {}", integrator.name), "–")
                    .within(worst(off), 1e-6)
                    .because("the bisection ends at 10⁻⁷"),
            );
            if classical.is_empty() {
                classical = longest.into();
            }
        }
    }
    evidence
}

fn near_a_sphere(integrators: &Integrators, _: &Effort) -> Vec<[Evidence; 2]> {
    let r = 1.0 + 1e-5;
    let off = |limit: Limit, expected: f64| match limit {
        Limit::At(strain) => strain / expected - 1.0,
        // No limit was found although there should be one.
        _ => 1.0,
    };
    let judged = |integrator: Integrator| {
        let turning = off(longest(&integrator, Property::Turning, r), theory::rk4_turning_of_a_sphere());
        let length = off(longest(&integrator, Property::Length, r), theory::rk4_length_of_a_sphere());
        [
            Evidence::on("relative difference of the longest turning step and 2√6", "–").within(turning, 2e-5).because(
                "rates of rods of r_e = 1 + 10⁻⁵ differ by Λ = 10⁻⁵, and of 512 rods one is within δ = π/1024 of the \
                 fastest: δ² = 10⁻⁵",
            ),
            Evidence::on("relative difference of the longest step with a bounded length and 4√2", "–")
                .within(length, 3e-3)
                .because(
                    "|R|² = 1 + 0.89(y² − 8): in the 22 steps of ten periods |p| grows to 1.5 at y² = 8.04, which is \
                     0.26 % more",
                ),
        ]
    };
    integrators().into_iter().map(judged).collect()
}

fn frozen(integrators: &Integrators, _: &Effort) -> Evidence {
    let all = integrators();
    let shares = pairs(&all, [1.5, 2.0, 3.0, 11.6, 100.0]).map(|(integrator, r)| {
        match longest(integrator, Property::Length, r) {
            Limit::At(strain) => strain / (2.785 * theory::euler_order(r)),
            _ => f64::INFINITY,
        }
    });
    Evidence::on("largest step with a bounded length over 2.785/(ΛG)", "–")
        .within(worst(shares), 0.99)
        .because("a hundredth below differs from equal: ten periods find a growth of 10⁻³ a step")
}
