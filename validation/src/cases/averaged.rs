//! The model's limit as Δt → 0 if the arms are bounded, and the difference of the two updates if they are not
//! (docs/src/theory/time-step.md).

use super::*;
use crate::oracle::jeffery::direction_rate_per_s;
use crate::oracle::naive::NaiveProblem;
use crate::studies::kicks::averaged::{Apart, apart, scene};
use shearbed::model::collision::{share_velocity, step_angles, turn};
use shearbed::model::contact::contact;
use shearbed::model::orientation::from_angles;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "averaged-motion")
            .claim(
                "With a shortest arm, the model tends to the averaged (P_c-weighted) motion as Δt → 0, path by path; \
                 with arms of every size it does not.",
            )
            .source("eqs 7, 8, A.13, A.14; docs/src/theory/time-step.md")
            .under_test(Limit { min_arm: 0.5, change: |_| {} })
            .mistake("arms of every size", Limit { min_arm: 0.0, change: |_| {} })
            .mistake(
                "an average without the push of collisions",
                Limit { min_arm: 0.5, change: |average| average.alpha = 1e-9 },
            )
            .check(averaged),
        Case::of(Judges::Core, "arm-pushed")
            .claim(
                "A collision pushes a short arm away from 0 where the gap opens, and towards 0 where it closes: dr/dt \
                 = h² ℓ·D·ℓ/(2 r sin²χ).",
            )
            .source("A.13, A.14; docs/src/theory/time-step.md")
            .under_test((|rates| rates[0]) as Kick)
            .mistake("a kick of the wrong sign", |[kick, _]| -kick)
            .mistake("twice the kick: the sum of the contact points' velocities for their mean", |[kick, _]| 2.0 * kick)
            .mistake("the other rod's kick", |[_, other]| other)
            .check(pushed),
        Case::of(Judges::Core, "updates-in-the-limit")
            .claim(
                "A kick of a given angle ends elsewhere by `angles` than by `rotation` however short the step; at a \
                 given rate both are Jeffery's step up to (GΔt)².",
            )
            .source("A.14; docs/src/theory/time-step.md")
            .under_test([turn as Update, step_angles])
            .mistake("twice the same update", [turn as Update, turn])
            .mistake("a turn by half the angle", [|p, rate, time| turn(p, rate, 0.5 * time), step_angles])
            .check(updates),
    ]
}

/// The shortest arm, and the change of the averaged motion.
struct Limit {
    min_arm: f64,
    change: fn(&mut NaiveProblem),
}

fn averaged(limit: &Limit, effort: &Effort) -> Evidence {
    // Pilot of 60 replicas at seed 9001: 0.157 with a deviation of 0.169 for a half; 0.6 brings 0.08 more.
    let design = Design::new(0.2, 0.19);
    let steps = [100, 800];
    let [coarse, fine] = steps.map(|steps| -> Vec<Apart> {
        let mut scene = scene(effort, steps, limit.min_arm);
        // Few rods and many replicas, as the naive average examines every pair.
        scene.particles.count = 16;
        // Many collisions, so that their effect shows soon.
        lab::interaction(&mut scene).alpha = 2.0;
        lab::replicas(effort.samples(design), |replica| apart(&scene, steps / 2, limit.change, replica))
    });
    let falls = (coarse.iter().zip(&fine))
        .map(|(coarse, fine)| (0.6 * coarse.square - fine.square) / (coarse.square + fine.square));
    let [coarse, fine] = steps;
    Evidence::on(
        format!(
            "0.6 × the mean sin² between the two paths at {coarse} steps a period, less that at {fine}, over the sum \
         of both; half a period"
        ),
        "–",
    )
    .exceeds(Sample::of(falls), 0.0, design.effect)
    .because("∝ Δt in the limit, an eighth; paths that do not converge stay as far apart, −0.2")
}

type Update = fn(&UnitVector3<f64>, &Vector3<f64>, f64) -> (UnitVector3<f64>, f64);

fn updates([rotation, angles]: &[Update; 2], _: &Effort) -> Vec<Evidence> {
    let ends_apart = |p: &UnitVector3<f64>, rate: &Vector3<f64>, time: f64| {
        rotation(p, rate, time).0.cross(&angles(p, rate, time).0).norm()
    };
    let flow = shearbed::model::flow::VelocityGradient::plane_couette(1.0).expect("finite");
    let propagator = Propagator::new(&flow, 11.6);
    let rods = (0..20).map(|k| {
        let p = from_angles(0.3 + 0.3 * f64::from(k), 0.4 + 0.05 * f64::from(k));
        let across = p.cross(&Vector3::new(0.2, -0.7, 0.5)).normalize();
        (p, (across + p.cross(&across)).normalize())
    });
    let rods: Vec<_> = rods.collect();
    // A kick of 1 rad in a shorter and shorter step.
    let kicked = rods.iter().map(|(p, way)| [1e-2, 1e-8].map(|time| ends_apart(p, &(way / time), time)));
    let distance: f64 = kicked.clone().map(|[long, _]| long / 20.0).sum();
    // Summed over rods, so that no single rod with a small second-order term decides; at Δt, and at 2Δt. A distance of
    // 0 has no order; infinity makes the check fail.
    type Distance<'a> = dyn Fn(&UnitVector3<f64>, &Vector3<f64>, f64) -> f64 + 'a;
    let order = |apart: &Distance| {
        let [one, two] = [1e-4, 2e-4].map(|time| rods.iter().map(|(p, way)| apart(p, way, time)).sum::<f64>());
        if one > 0.0 { (two / one).log2() - 2.0 } else { f64::INFINITY }
    };
    // Such a collision turns the rod along a straight line, while Jeffery's path is curved.
    let off_path = |update: &Update| {
        order(&|p, _, time| {
            let rate = direction_rate_per_s(flow.per_s(), 11.6, p);
            update(p, &rate, time).0.cross(&propagator.after(p, time)).norm()
        })
    };
    let because = "the next term of the series is GΔt = 10⁻⁴ times derivatives of a rate, of order 1/sin³ θ < 20";
    vec![
        Evidence::on("how much the two ends of a kick of 1 rad come nearer as Δt goes from 10⁻² to 10⁻⁸", "–")
            .within(worst(kicked.map(|[long, short]| (long - short).abs())), 1e-14)
            .because("round-off: only rate × Δt counts"),
        Evidence::on("by how much less than 0.1 the sine of the angle between the two ends is on average", "–")
            .exact((0.1 - distance).max(0.0)),
        Evidence::on("order in Δt of the distance of both ends at a given rate, less 2", "–")
            .within(order(&ends_apart), 2e-3)
            .because(because),
        Evidence::on(
            "order in Δt of what a colliding rod is off Jeffery's path where the kick is 0, less 2; by rotation",
            "–",
        )
        .within(off_path(rotation), 2e-3)
        .because(because),
        Evidence::on("the same by angles", "–").within(off_path(angles), 2e-3).because(because),
    ]
}

/// The change of A's rate, from the changes ṗ′ − ṗ of A and of B.
type Kick = fn([Vector3<f64>; 2]) -> Vector3<f64>;

/// The rate of change of A's arm when a collision turns A alone, by the core: contact, kick, turn, and contact again.
fn arm_rate(kick: Kick, p: [Vector3<f64>; 2], separation: &Vector3<f64>, time: f64) -> Option<f64> {
    let flow = shearbed::model::flow::VelocityGradient::plane_couette(1.0)?;
    let units = p.map(UnitVector3::new_unchecked);
    let before = contact(separation, &p[0], &p[1], [0.0; 2])?;
    let free = units.map(|p| direction_rate_per_s(flow.per_s(), LONG, &p));
    let after = share_velocity(&before, &(flow.per_s() * separation), free);
    let changes = [after[0] - free[0], after[1] - free[1]];
    let turned = turn(&units[0], &kick(changes), time).0;
    let arm = contact(separation, &turned, &p[1], [0.0; 2])?.arms[0];
    Some((arm - before.arms[0]) / time)
}

/// An aspect ratio at which 1 − Λ = 2·10⁻⁸.
const LONG: f64 = 1e4;

fn pushed(kick: &Kick, _: &Effort) -> Vec<Evidence> {
    const ARM: f64 = 1e-4;
    let (mut worst, mut wrong, mut opening) = (0.0f64, 0, 0);
    for k in 0..400 {
        let k = f64::from(k);
        // Directions, gap and the other arm vary; the arm of A is ARM.
        let p = [from_angles(2.4 * k, 0.2 + (0.61 * k) % 2.7), from_angles(1.1 + 1.7 * k, 0.3 + (0.37 * k) % 2.5)];
        let normal = p[0].cross(&p[1]);
        let line = normal.normalize();
        let (gap, other) = (0.5 + (0.29 * k) % 0.5, (0.83 * k) % 2.0 - 1.0);
        if normal.norm() < 0.3 || (line.x * line.y).abs() < 0.05 {
            continue;
        }
        let separation = ARM * p[0].into_inner() - other * p[1].into_inner() + gap * line;
        let expected = gap * gap * line.x * line.y / (2.0 * ARM * normal.norm_squared());
        let rate = arm_rate(*kick, p.map(UnitVector3::into_inner), &separation, 1e-4 * ARM * ARM).unwrap_or(f64::NAN);
        worst = larger(worst, (rate / expected - 1.0).abs());
        wrong += u32::from((rate > 0.0) != (line.x * line.y > 0.0));
        opening += u32::from(line.x * line.y > 0.0);
    }
    vec![
        Evidence::on("dr/dt while colliding over h² ℓ·D·ℓ/(2 r sin²χ), less 1", "–")
            .within(worst, 1e-5)
            .because("left out: terms in 1 − Λ = 2·10⁻⁸ over h ℓ·D·ℓ ≥ 0.02, and the square of the turn, 10⁻⁸"),
        Evidence::on(format!("pairs, of which {opening} open, with an arm that moves the other way"), "pairs")
            .exact(f64::from(wrong)),
    ]
}
