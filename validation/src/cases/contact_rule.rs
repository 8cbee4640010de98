//! The contact rule's invariants as properties, and the corrected A.13 against the text's.

use super::*;
use shearbed::model::collision::{angle_rates, share_velocity, step_angles, turn};
use shearbed::model::contact::contact;

/// Two rods just before a collision: positions, directions, the liquid's velocities and ṗ.
#[derive(Clone, Copy, Debug)]
struct Pair {
    x: [Vector3<f64>; 2],
    p: [UnitVector3<f64>; 2],
    u: [Vector3<f64>; 2],
    rate: [Vector3<f64>; 2],
}

/// A rule that returns ṗ′ of both rods; `None` if they have no contact.
type ContactRule = fn(&Pair) -> Option<[Vector3<f64>; 2]>;

fn core_rule(pair: &Pair) -> Option<[Vector3<f64>; 2]> {
    with_arms(pair, |arms| arms)
}

fn with_arms(pair: &Pair, arms: fn([f64; 2]) -> [f64; 2]) -> Option<[Vector3<f64>; 2]> {
    let mut contact = contact(&(pair.x[1] - pair.x[0]), &pair.p[0], &pair.p[1], [0.0; 2])?;
    contact.arms = arms(contact.arms);
    Some(share_velocity(&contact, &(pair.u[1] - pair.u[0]), pair.rate))
}

fn scaled_change(pair: &Pair, factor: f64) -> Option<[Vector3<f64>; 2]> {
    let after = core_rule(pair)?;
    Some([0, 1].map(|k| pair.rate[k] + (after[k] - pair.rate[k]) * factor))
}

/// ℓ and the arms from the normal equations of the shortest line, by another method than the core's.
fn geometry(pair: &Pair) -> (Vector3<f64>, [f64; 2]) {
    let d = pair.x[1] - pair.x[0];
    let (a, b) = (pair.p[0].into_inner(), pair.p[1].into_inner());
    let c = a.dot(&b);
    let square = 1.0 - c * c;
    let arms = [(d.dot(&a) - c * d.dot(&b)) / square, (c * d.dot(&a) - d.dot(&b)) / square];
    (a.cross(&b).normalize(), arms)
}

/// The velocities of both contact points with direction rates `rate` (A.7).
fn contact_velocities(pair: &Pair, rate: &[Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    let (_, arms) = geometry(pair);
    [0, 1].map(|k| pair.u[k] + arms[k] * rate[k])
}

/// The scale of a property's violation: the kick, ∝ 1/r, times the condition number of the arm. Round-off ε in
/// the places and directions moves the contact points by ε|d|/sin², with sin that of the crossing angle.
fn scale(pair: &Pair) -> f64 {
    let (_, arms) = geometry(pair);
    let shortest = arms[0].abs().min(arms[1].abs());
    let longest = 1.0 + arms[0].abs().max(arms[1].abs());
    let fastest = pair.u[0].norm() + pair.u[1].norm() + pair.rate[0].norm() + pair.rate[1].norm();
    let kick = 1.0 + longest * fastest / shortest;
    let distance = 1.0 + (pair.x[1] - pair.x[0]).norm();
    let square = pair.p[0].cross(&pair.p[1]).norm_squared();
    kick * (1.0 + distance / (square * shortest))
}

/// A pair in general position: crossing at more than 6°, arms longer than 10⁻³.
fn pair(random: &mut Pcg64Dxsm) -> Pair {
    loop {
        let pair = any_pair(random);
        let (_, arms) = geometry(&pair);
        if pair.p[0].cross(&pair.p[1]).norm() > 0.1 && arms.iter().all(|r| r.abs() > 1e-3) {
            return pair;
        }
    }
}

fn any_pair(random: &mut Pcg64Dxsm) -> Pair {
    let mut vectors = || [(); 2].map(|()| Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)));
    let (x, u, v) = (vectors(), vectors(), vectors());
    let p = [(); 2].map(|()| {
        let (phi, theta) = (random.random_range(-PI..PI), random.random_range(0.05..3.09));
        orientation::from_angles(phi, theta)
    });
    let rate = [0, 1].map(|k| v[k] - p[k].into_inner() * v[k].dot(&p[k]));
    Pair { x, p, u, rate }
}

fn invariants(rule: &ContactRule, effort: &Effort) -> [Evidence; PROPERTIES.len()] {
    let mut random = Pcg64Dxsm::seed_from_u64(effort.seed(0));
    let mut worst = [0.0f64; PROPERTIES.len()];
    for _ in 0..effort.pick(2_000, 50_000) {
        let pair = pair(&mut random);
        for ((_, property), worst) in PROPERTIES.iter().zip(&mut worst) {
            let violation = property(*rule, &pair).map_or(f64::NAN, |violation| violation / scale(&pair));
            *worst = larger(*worst, violation);
        }
    }
    let because = "some dozens of roundings, over the kick times the condition of its arm";
    std::array::from_fn(|k| Evidence::on(PROPERTIES[k].0, "–").within(worst[k], 64.0 * f64::EPSILON).because(because))
}

/// A function that returns (φ̇′, θ̇′) from a direction and ṗ′.
type AngleRates = fn(&UnitVector3<f64>, &Vector3<f64>) -> (f64, f64);

/// A.13 as in the text at hand: φ̇′ without 1/sin θ, θ̇′ with sin θ and cos θ exchanged.
fn printed_a13(p: &UnitVector3<f64>, rate: &Vector3<f64>) -> (f64, f64) {
    let (phi, theta) = orientation::angles(p);
    (
        -rate.x * phi.sin() + rate.y * phi.cos(),
        rate.x * theta.sin() * phi.cos() + rate.y * theta.sin() * phi.sin() - rate.z * theta.cos(),
    )
}

/// Compares the rates with those of a turning rod's angles, by central differences.
fn against_turning(rates: &AngleRates, _: &Effort) -> [Evidence; 2] {
    let angles = [(0.3, 0.2), (1.0, 0.8), (2.2, 1.4), (-1.5, 2.6), (-2.8, 1.0)];
    let errors = pairs(angles, [[0.3, -0.8, 0.5], [-0.2, 0.1, 0.9], [0.7, 0.7, -0.1]]).map(|((phi, theta), along)| {
        let p = orientation::from_angles(phi, theta);
        let rate = Vector3::from(along).cross(&p);
        let dt = 1e-4;
        let [ahead, behind] = [rate, -rate].map(|rate| orientation::angles(&turn(&p, &rate, dt).0));
        let (phi_rate, theta_rate) = rates(&p, &rate);
        let off = |rate: f64, ahead: f64, behind: f64| (rate - (ahead - behind) / (2.0 * dt)).abs();
        (off(phi_rate, ahead.0, behind.0), off(theta_rate, ahead.1, behind.1))
    });
    let (phi, theta): (Vec<_>, Vec<_>) = errors.unzip();
    let because = "the central difference's own error: Δt²/6 times a third derivative of 8(|ṗ|/sin θ)³ ≤ 8·5³ at most";
    [("φ̇′", phi), ("θ̇′", theta)].map(|(rate, errors)| {
        Evidence::on(format!("error of {rate}"), "rad per unit time").within(worst(errors), 2e-6).because(because)
    })
}

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "contact-rule")
            .claim("The contact rule keeps its invariants for any two rods in contact.")
            .source("eqs 5, 6, A.7–A.12")
            .under_test(core_rule as ContactRule)
            .mistake("no collision at all", |pair| Some(pair.rate))
            .mistake("the sum in place of the mean", |pair| scaled_change(pair, 2.0))
            .mistake("the kick with the wrong sign", |pair| scaled_change(pair, -1.0))
            .mistake("arms exchanged", |pair| with_arms(pair, |[a, b]| [b, a]))
            .mistake("arms without their sign", |pair| with_arms(pair, |arms| arms.map(f64::abs)))
            .mistake("the liquid's velocity left out", |pair| core_rule(&Pair { u: [Vector3::zeros(); 2], ..*pair }))
            .mistake("only A moved", |pair| Some([core_rule(pair)?[0], pair.rate[1]]))
            .check(invariants),
        Case::of(Judges::Core, "corrected-a13")
            .claim("The corrected A.13 is the rate of the angles of a turning rod; the text's is not.")
            .source("A.13, A.14")
            .under_test(angle_rates as AngleRates)
            .mistake("A.13 as in the text", printed_a13)
            .mistake("only φ̇′ corrected", |p, rate| (angle_rates(p, rate).0, printed_a13(p, rate).1))
            .mistake("only θ̇′ corrected", |p, rate| (printed_a13(p, rate).0, angle_rates(p, rate).1))
            .check(against_turning),
    ]
}

type Property = fn(ContactRule, &Pair) -> Option<f64>;

fn changed(pair: &Pair, change: impl Fn(&mut Pair, usize)) -> Pair {
    let mut changed = *pair;
    (0..2).for_each(|k| change(&mut changed, k));
    changed
}

fn difference(a: [Vector3<f64>; 2], b: [Vector3<f64>; 2]) -> f64 {
    (a[0] - b[0]).norm() + (a[1] - b[1]).norm()
}

/// Each invariant with its violation, 0 where it holds.
const PROPERTIES: [(&str, Property); 11] = [
    ("velocity normal to the contact line unchanged (eq. 5, A.9)", |rule, pair| {
        let after = rule(pair)?;
        let (line, _) = geometry(pair);
        let change = |k: usize| {
            let dv = contact_velocities(pair, &after)[k] - contact_velocities(pair, &pair.rate)[k];
            (dv - line * line.dot(&dv)).norm()
        };
        Some(larger(change(0), change(1)))
    }),
    ("velocities along the contact line equal (eq. 6, A.10)", |rule, pair| {
        let [a, b] = contact_velocities(pair, &rule(pair)?);
        Some(geometry(pair).0.dot(&(a - b)).abs())
    }),
    ("their sum unchanged (eq. 6)", |rule, pair| {
        let sum = |rate: &[Vector3<f64>; 2]| {
            let [a, b] = contact_velocities(pair, rate);
            geometry(pair).0.dot(&(a + b))
        };
        Some((sum(&rule(pair)?) - sum(&pair.rate)).abs())
    }),
    ("ṗ′ normal to p, and |p| = 1 after either update", |rule, pair| {
        let after = rule(pair)?;
        let off = |k: usize| {
            let lengths = [turn(&pair.p[k], &after[k], 0.1).0, step_angles(&pair.p[k], &after[k], 0.1).0];
            let stretched = worst(lengths.iter().map(|p| (p.norm() - 1.0).abs()));
            stretched + after[k].dot(&pair.p[k]).abs()
        };
        Some(larger(off(0), off(1)))
    }),
    ("A and B exchanged", |rule, pair| {
        let swapped = changed(pair, |swapped, k| {
            let other = 1 - k;
            (swapped.x[k], swapped.p[k]) = (pair.x[other], pair.p[other]);
            (swapped.u[k], swapped.rate[k]) = (pair.u[other], pair.rate[other]);
        });
        let [b, a] = rule(&swapped)?;
        Some(difference(rule(pair)?, [a, b]))
    }),
    ("p → −p of one rod", |rule, pair| {
        let mut turned = *pair;
        (turned.p[0], turned.rate[0]) = (-pair.p[0], -pair.rate[0]);
        let [minus_a, b] = rule(&turned)?;
        Some(difference(rule(pair)?, [-minus_a, b]))
    }),
    ("a rotated frame", |rule, pair| {
        let q = Rotation3::from_euler_angles(0.3, -1.1, 2.0);
        let turned = changed(pair, |pair, k| {
            pair.x[k] = q * pair.x[k];
            pair.p[k] = q * pair.p[k];
            pair.u[k] = q * pair.u[k];
            pair.rate[k] = q * pair.rate[k];
        });
        Some(difference(rule(pair)?.map(|rate| q * rate), rule(&turned)?))
    }),
    ("a Galilean shift of place and velocity", |rule, pair| {
        let moved = changed(pair, |pair, k| {
            pair.x[k] += Vector3::new(1.0, -2.0, 0.5);
            pair.u[k] += Vector3::new(-0.7, 0.2, 1.1);
        });
        Some(difference(rule(pair)?, rule(&moved)?))
    }),
    ("lengths in another unit", |rule, pair| {
        let scaled = changed(pair, |pair, k| {
            pair.x[k] *= 8.0;
            pair.u[k] *= 8.0;
        });
        Some(difference(rule(pair)?, rule(&scaled)?))
    }),
    ("applied twice = once", |rule, pair| {
        let once = rule(pair)?;
        Some(difference(once, rule(&Pair { rate: once, ..*pair })?))
    }),
    ("rods in the shear plane unaffected", |rule, pair| {
        // Both directions projected into the plane of axes 1 and 2, with rates in it; the flow is along axis 2.
        let flat = changed(pair, |pair, k| {
            let (phi, _) = orientation::angles(&pair.p[k]);
            pair.p[k] = orientation::from_angles(phi, FRAC_PI_2);
            pair.p[k].as_mut_unchecked().z = 0.0;
            pair.rate[k] = Vector3::new(-phi.sin(), phi.cos(), 0.0) * pair.rate[k].norm();
            pair.u[k] = Vector3::new(0.0, pair.x[k].x, 0.0);
        });
        if flat.p[0].cross(&flat.p[1]).norm() < 0.1 {
            return Some(0.0);
        }
        Some(difference(rule(&flat)?, flat.rate))
    }),
];
