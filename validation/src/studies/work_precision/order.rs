//! The convergence of a fixed-step integrator: observed order with its sign, Richardson's value and
//! Roache's grid convergence index.

use super::*;
use crate::studies::integrators;

/// The largest difference of an observed order from theory (DiffEqDevTools.jl's convergence tests). Its sign is kept.
pub const ORDER_TOLERANCE: f64 = 0.2;

/// The error up to which one of some step must be for an order to be seen, in rad.
const RESOLVED_RAD: f64 = 0.1;

/// Roache's safety factor for three grids.
const SAFETY: f64 = 1.25;

/// One of a sequence of runs that each have twice as many steps as the one before.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Halving {
    /// Number of equal steps over the problem.
    pub steps: u64,
    /// The errors against the closed form, if the run ended.
    pub errors: Option<Errors>,
    /// |p_1| at the end, the number to extrapolate.
    pub value: Option<f64>,
    /// log₂ of the previous run's orientation error over this run's: negative if the error grows.
    pub order: Option<f64>,
}

/// The comparison of an observed order with theory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum OrderVerdict {
    /// Within [`ORDER_TOLERANCE`] on two pairs after each other, beyond which all errors may be round-off.
    AsTheory,
    /// Not within it.
    Not,
    /// Not within it, but still coming nearer at the finest step, or nearest to it and still changing, as where the
    /// leading error passes through zero.
    Unsettled,
    /// Fewer than two pairs are above round-off.
    RoundOff,
    /// The errors at every step are above 0.1 rad, too large to show an order.
    TooCoarse,
}

/// Three grids' extrapolation (Roache 1994; the references are in `docs/src/verification/integrators.md`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Richardson {
    /// Steps of the finest of the three grids.
    pub steps: u64,
    /// The order from the three values, without a reference.
    pub order: f64,
    /// The value extrapolated to Δt = 0 by the order of theory.
    pub value: f64,
    /// The distance of `value` from the closed form.
    pub error: f64,
    /// The grid convergence index of the finest grid, relative.
    pub index: f64,
    /// The relative error that the index should bound.
    pub true_error: f64,
}

/// The convergence of a fixed-step integrator.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Convergence {
    /// The integrator's name.
    pub integrator: String,
    pub(crate) theory: u32,
    /// The runs, from coarse to fine.
    pub halvings: Vec<Halving>,
    /// The orders of the last two pairs above round-off.
    pub judged: Vec<f64>,
    /// The orders that settle `found`: those judged, or earlier ones if these may be round-off.
    pub observed: Vec<f64>,
    /// The comparison of the observed orders with theory.
    pub found: OrderVerdict,
    /// The extrapolation, if three grids converge.
    pub richardson: Option<Richardson>,
}

/// The problem in words, and the convergence of every fixed-step integrator of the project.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Orders {
    pub(crate) problem: String,
    /// The convergence of each integrator.
    pub studies: Vec<Convergence>,
}

/// Convergence on a rod of this aspect ratio ([`RodProblem::mid_flip`]).
pub fn of_rod(aspect_ratio: f64) -> Orders {
    of_all(aspect_ratio, 0.2, 1.0, 1.0, "as in the benches")
}

/// Convergence on a scene of free rods in plane Couette flow at `shear_rate_per_s`, with its time in periods: one rod
/// of its mean aspect ratio from its own start, for its own number of periods.
pub fn of_scene(scene: &Scene, shear_rate_per_s: f64) -> Orders {
    let ([phi, theta], whose) = start(scene, shear_rate_per_s);
    of_all(scene.particles.aspect_ratio, phi, theta, scene.time.duration, whose)
}

/// The steps that [`of_scene`] takes, all runs of all integrators together.
pub fn steps_of_scene(scene: &Scene, shear_rate_per_s: f64) -> f64 {
    let [phi, theta] = start(scene, shear_rate_per_s).0;
    let (problem, _) = RodProblem::into_flip(scene.particles.aspect_ratio, phi, theta, scene.time.duration);
    let stepped = integrators::all().iter().filter(|it| matches!(it.theory, Theory::Order(_))).count();
    let coarsest = coarsest(&problem);
    stepped as f64 * coarsest as f64 * (2f64.powi(doublings(coarsest) as i32 + 1) - 1.0)
}

/// φ and θ of the start of [`of_scene`], and whose they are.
fn start(scene: &Scene, shear_rate_per_s: f64) -> ([f64; 2], &'static str) {
    match scene.particles.common_start_deg() {
        // The reversed flow is its own mirror image, φ ↔ −φ.
        Some([phi_deg, theta_deg]) => {
            ([shear_rate_per_s.signum() * phi_deg.to_radians(), theta_deg.to_radians()], "the scene's own start")
        }
        None if scene.particles.rods.is_some() => ([0.2, 1.0], "as the scene's starts are many"),
        None => ([0.2, 1.0], "as the scene draws its starts at random"),
    }
}

/// Convergence from GΔt of about 1 to 1/4096, or to 2²² steps if that is coarser.
fn of_all(aspect_ratio: f64, phi: f64, theta: f64, turns: f64, whose: &str) -> Orders {
    let (problem, start) = RodProblem::into_flip(aspect_ratio, phi, theta, turns);
    let doublings = doublings(coarsest(&problem));
    Orders {
        problem: format!(
            "One rod of r_e = {aspect_ratio} from φ = {phi:.4} and θ = {theta:.4} rad ({whose}) over {:.5} periods, \
             into a flip, to φ = 1 rad",
            problem.turns
        ),
        studies: (integrators::all().iter())
            .filter_map(|integrator| study(integrator, &problem, &start, doublings))
            .collect(),
    }
}

fn doublings(coarsest: u64) -> u32 {
    22u32.saturating_sub(coarsest.ilog2()).clamp(4, 12)
}

/// The number of steps at which GΔt is about 1.
fn coarsest(problem: &RodProblem) -> u64 {
    (problem.strain().ceil() as u64).next_power_of_two().max(8)
}

/// Halves the step `doublings` times, from GΔt of about 1. `None` for an integrator without equal steps.
pub fn study(
    integrator: &Integrator,
    problem: &RodProblem,
    start: &UnitVector3<f64>,
    doublings: u32,
) -> Option<Convergence> {
    let Theory::Order(theory) = integrator.theory else {
        return None;
    };
    let coarsest = coarsest(problem);
    let mut halvings: Vec<Halving> = Vec::new();
    for k in 0..=doublings {
        let steps = coarsest << k;
        let setting = Setting::Steps(steps);
        let end = integrator.advance(problem, start, setting).ok();
        let end = end.filter(|end| end.iter().all(|component| component.is_finite()));
        let errors = end.map(|end| Errors::of(&end, problem, start));
        let before = halvings.last().and_then(|halving| halving.errors);
        halvings.push(Halving {
            steps,
            errors,
            value: end.map(|p| p.x.abs() / p.norm()),
            order: errors.zip(before).map(|(now, before)| (before.orientation_rad / now.orientation_rad).log2()),
        });
    }
    let floor = round_off(problem.aspect_ratio, problem.turns);
    let judged = judged(&halvings, floor);
    let (verdict, observed) = compare(&halvings, &judged, theory, |steps| most_round_off(problem, steps));
    Some(Convergence {
        integrator: integrator.name.clone(),
        theory,
        found: verdict,
        observed,
        judged,
        richardson: richardson(&halvings, theory, problem.reference(start).x.abs(), floor),
        halvings,
    })
}

/// The largest error that is round-off of most integrators with steps: the time has the relative error ε, φ moves by
/// max(r_e, 1/r_e) times the phase, and thousands of steps add up.
pub(crate) fn round_off(aspect_ratio: f64, turns: f64) -> f64 {
    1000.0 * f64::EPSILON * aspect_ratio.max(1.0 / aspect_ratio) * turns.max(1.0)
}

/// The largest error that may be round-off of any integrator after this many steps. While the rod lies along the flow
/// (a disc across it), an error of φ shifts the phase by max(r_e, 1/r_e) times as much, and the flip multiplies that by
/// the same factor: so in angles and by rotations. Roundings of steps that differ grow as their root; a sphere turns
/// equally in every step, with the same rounding.
fn most_round_off(problem: &RodProblem, steps: u64) -> f64 {
    let (r, steps) = (problem.aspect_ratio, steps as f64);
    let of_steps = if r == 1.0 { 10.0 * steps } else { 100.0 * steps.sqrt() };
    f64::EPSILON * r.max(1.0 / r).powi(2) * problem.turns.max(1.0) * of_steps.max(1000.0)
}

fn judged(halvings: &[Halving], floor: f64) -> Vec<f64> {
    let orders = orders_above(halvings, |_| floor);
    orders[orders.len().saturating_sub(2)..].to_vec()
}

/// The orders of the runs before the first at round-off: from it on, all orders are noise.
fn orders_above(halvings: &[Halving], round_off: impl Fn(u64) -> f64) -> Vec<f64> {
    let above = halvings.iter().take_while(|halving| is_above(halving, &round_off));
    above.filter_map(|halving| halving.order).collect()
}

fn is_above(halving: &Halving, round_off: impl Fn(u64) -> f64) -> bool {
    halving.errors.is_some_and(|errors| errors.orientation_rad > round_off(halving.steps))
}

/// Compares the judged orders with theory. If they do not hold, the last two after each other that do, if all errors
/// beyond them may be round-off; else the last three above it. Returns the orders that settle it, too.
fn compare(
    halvings: &[Halving],
    judged: &[f64],
    theory: u32,
    most_round_off: impl Fn(u64) -> f64,
) -> (OrderVerdict, Vec<f64>) {
    let off = |order: f64| (order - f64::from(theory)).abs();
    let hold = |orders: &[f64]| orders.len() == 2 && orders.iter().all(|order| off(*order) < ORDER_TOLERANCE);
    let noise_after = |k: usize| !halvings[k + 1..].iter().any(|halving| is_above(halving, &most_round_off));
    let pair = |k: usize| Some(vec![halvings[k - 1].order?, halvings[k].order?]);
    let earlier = || {
        let pairs = (2..halvings.len()).rev().filter(|k| noise_after(*k)).filter_map(pair);
        pairs.into_iter().find(|orders| hold(orders))
    };
    if let Some(orders) = Some(judged.to_vec()).filter(|orders| hold(orders)).or_else(earlier) {
        return (OrderVerdict::AsTheory, orders);
    }
    let above = orders_above(halvings, &most_round_off);
    let least = halvings.iter().filter_map(|halving| halving.errors).map(|errors| errors.orientation_rad);
    if least.fold(f64::INFINITY, f64::min) > RESOLVED_RAD {
        return (OrderVerdict::TooCoarse, Vec::new());
    }
    let last = above[above.len().saturating_sub(3)..].to_vec();
    let is_nearest = |order: f64| off(order) < 0.5;
    let verdict = match *last {
        [.., a, b] if is_nearest(a) && is_nearest(b) && (a - b).abs() > 0.5 * off(b) => OrderVerdict::Unsettled,
        [first, second, last] if off(first) > off(second) && 0.6 * off(second) > off(last) => OrderVerdict::Unsettled,
        [_, _] | [_, _, _] => OrderVerdict::Not,
        _ => OrderVerdict::RoundOff,
    };
    (verdict, last)
}

/// The extrapolation from the finest three grids whose differences are above round-off.
fn richardson(halvings: &[Halving], theory: u32, exact: f64, floor: f64) -> Option<Richardson> {
    halvings.windows(3).rev().find_map(|grids| {
        let [coarse, middle, fine] = [grids[0].value?, grids[1].value?, grids[2].value?];
        let (first, last) = (coarse - middle, middle - fine);
        let gain = 2f64.powi(theory as i32) - 1.0;
        let shrinks = first / last > 1.0;
        if !shrinks || last.abs() <= gain * floor {
            return None;
        }
        let value = fine - last / gain;
        Some(Richardson {
            steps: grids[2].steps,
            order: (first / last).log2(),
            value,
            error: (value - exact).abs(),
            index: SAFETY * (last / fine).abs() / gain,
            true_error: (fine / exact - 1.0).abs(),
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn synthetic(errors: &[f64]) -> Vec<Halving> {
        let of = |orientation_rad| Errors { orientation_rad, orbit_constant: 0.0, phase_turns: 0.0, length: 0.0 };
        (0..errors.len())
            .map(|k| Halving {
                steps: 8 << k,
                errors: Some(of(errors[k])),
                value: Some(0.5 + errors[k]),
                order: (k > 0).then(|| (errors[k - 1] / errors[k]).log2()),
            })
            .collect()
    }

    #[test]
    fn an_order_keeps_its_sign_and_round_off_is_not_judged() {
        let verdict = |errors: &[f64], theory| {
            let halvings = synthetic(errors);
            compare(&halvings, &judged(&halvings, 1e-12), theory, |_| 1e-12).0
        };
        assert_eq!(verdict(&[0.4, 0.1, 0.025, 0.00625], 2), OrderVerdict::AsTheory);
        assert_eq!(verdict(&[0.00625, 0.025, 0.1, 0.4], 2), OrderVerdict::Not, "it diverges");
        assert_eq!(verdict(&[0.4, 0.2, 0.1, 0.025], 2), OrderVerdict::Not);
        assert_eq!(verdict(&[1e-9, 6e-11, 4e-12, 1e-15, 2e-14], 4), OrderVerdict::AsTheory);
        assert_eq!(verdict(&[1e-9, 1e-15, 1e-9, 1e-9], 4), OrderVerdict::RoundOff);
        assert_eq!(verdict(&[f64::NAN, 0.1, f64::NAN], 4), OrderVerdict::RoundOff);
        // Below what may be round-off an order may still hold, and end in noise; above it, a lower order at the end is
        // one.
        assert_eq!(verdict(&[1.6e-12, 1e-13, 6e-15, 1e-15, 3e-15], 4), OrderVerdict::AsTheory);
        assert_eq!(verdict(&[1e-4, 6.3e-6, 4e-7, 1e-7, 5e-8, 2.5e-8], 4), OrderVerdict::Not);
        assert_eq!(verdict(&[0.4, 0.15, 0.058, 0.025], 1), OrderVerdict::Unsettled);
        // The orders 1.1, 1.4 and 1.2, and 5.5, 3.8 and 3.5; those of a stall that changes, 3.9 and −0.5, and 3.6 and
        // 3.6, are none of 4.
        assert_eq!(verdict(&[0.8, 0.373, 0.141, 0.0613], 1), OrderVerdict::Unsettled);
        assert_eq!(verdict(&[7e-7, 1.55e-8, 1.11e-9, 9.8e-11], 4), OrderVerdict::Unsettled);
        assert_eq!(verdict(&[7e-7, 1.55e-8, 1e-9, 1.4e-9], 4), OrderVerdict::Not);
        assert_eq!(verdict(&[7e-7, 5.8e-8, 4.8e-9, 4e-10], 4), OrderVerdict::Not);
        assert_eq!(verdict(&[1.15, 1.15, 1.15, 0.8, 0.3], 1), OrderVerdict::TooCoarse);
        assert_eq!(verdict(&[1.15, 0.8, 0.05, 0.05, 0.05], 1), OrderVerdict::Not);
    }

    #[test]
    fn richardson_is_exact_for_a_pure_power() {
        let halvings = synthetic(&[0.064, 0.016, 0.004, 0.001]);
        let extrapolated = richardson(&halvings, 2, 0.5, 1e-12).unwrap();
        assert_eq!(extrapolated.steps, 64);
        assert!((extrapolated.order - 2.0).abs() < 1e-12 && extrapolated.error < 1e-15);
        // For a pure power the index is the safety factor times the true error, relative to the finest value.
        assert!((extrapolated.index / (0.001 / 0.501) - SAFETY).abs() < 1e-12);
        assert!(richardson(&synthetic(&[0.1, 0.2, 0.4]), 2, 0.5, 1e-12).is_none());
        assert!(richardson(&synthetic(&[0.1, -0.2, 0.1]), 2, 0.5, 1e-12).is_none());
    }
}
