//! Limits of integrators in p, and the lower bound by their order.

use super::*;

pub(super) fn at_least(integrators: &Integrators, _: &Effort) -> Vec<Evidence> {
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

pub(super) fn near_a_sphere(integrators: &Integrators, _: &Effort) -> Vec<[Evidence; 2]> {
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

pub(super) fn frozen(integrators: &Integrators, _: &Effort) -> Evidence {
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
