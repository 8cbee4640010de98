//! Diagnosis of answers about two rods in contact: known mistakes in A.7 to A.14.

use super::answer::Answer;
use super::compare::distance;
use super::nearness::Near;
use crate::serve::problems::LoadedProblem;
use crate::serve::problems::contact::{
    ASPECT_RATIO, AngleRate, Both, LENGTH_MM, RIGHT, Step, Variant, answers, within,
};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Mistakes in ṗ′.
const MISTAKES: &[(&str, Variant)] = &[
    ("a kick with the wrong sign", kicked([-1.0; 2])),
    ("no kick", kicked([0.0; 2])),
    ("a kick to the other rod's velocity, not to the mean", kicked([2.0; 2])),
    ("half the kick", kicked([0.5; 2])),
    ("a kick of rod a alone", kicked([1.0, 0.0])),
    ("a kick of rod b alone", kicked([0.0, 1.0])),
    ("a takes the velocity of b, and b stays", kicked([2.0, 0.0])),
    ("b takes the velocity of a, and a stays", kicked([0.0, 2.0])),
    ("the kick of rod a with the wrong sign", kicked([-1.0, 1.0])),
    ("the kick of rod b with the wrong sign", kicked([1.0, -1.0])),
    ("arms clipped at the rods' ends, ±a/2", armed(|arms| Some(arms.map(|arm| arm.clamp(-0.5, 0.5))))),
    ("arms clipped at ±a", armed(|arms| Some(arms.map(|arm| arm.clamp(-1.0, 1.0))))),
    (
        "contact lines cut at the rods' ends: no contact beyond",
        armed(|arms| arms.iter().all(|arm| arm.abs() <= 0.5).then_some(arms)),
    ),
    (
        "contact lines cut at ±a: no contact beyond",
        armed(|arms| arms.iter().all(|arm| arm.abs() <= 1.0).then_some(arms)),
    ),
    ("|r| for the signed arm r", armed(|arms| Some(arms.map(f64::abs)))),
    ("arms with the wrong sign", armed(|arms| Some(arms.map(|arm| -arm)))),
    ("the arm of rod a with the wrong sign", armed(|[a, b]| Some([-a, b]))),
    ("the arm of rod b with the wrong sign", armed(|[a, b]| Some([a, -b]))),
    ("the arms of both rods exchanged", armed(|[a, b]| Some([b, a]))),
    ("the arm of rod a for both", armed(|[a, _]| Some([a, a]))),
    ("the arm of rod b for both", armed(|[_, b]| Some([b, b]))),
    ("arms of half a rod for r", armed(|_| Some([0.5; 2]))),
    ("arms counted from an end of the rod", armed(|arms| Some(arms.map(|arm| arm + 0.5)))),
    ("arms counted from the other end of the rod", armed(|arms| Some(arms.map(|arm| arm - 0.5)))),
    ("arms of half the length", armed(|arms| Some(arms.map(|arm| 0.5 * arm)))),
    ("arms of twice the length", armed(|arms| Some(arms.map(|arm| 2.0 * arm)))),
    ("arms in rod lengths, not in mm", armed(|arms| Some(arms.map(|arm| arm / LENGTH_MM)))),
    ("arms in cm, not in mm", armed(|arms| Some(arms.map(|arm| 0.1 * arm)))),
    ("the change of velocity times r, not divided by r", divided(|arms| arms.map(f64::recip))),
    ("the change of velocity not divided by r", divided(|_| [1.0; 2])),
    ("the change of velocity divided by |r|", divided(|arms| arms.map(f64::abs))),
    ("the change of velocity divided by the other rod's arm", divided(|[a, b]| [b, a])),
    ("the change of velocity divided by r²", divided(|arms| arms.map(|arm| arm * arm))),
    ("the change of velocity divided by half a rod, not by r", divided(|_| [0.5 * LENGTH_MM; 2])),
    ("the change of velocity divided by a rod's length, not by r", divided(|_| [LENGTH_MM; 2])),
    ("a transposed gradient", flowing(|l| l.transpose())),
    ("the flow reversed (L with the wrong sign, or time backwards)", flowing(|l| -l)),
    ("half the shear rate", flowing(|l| 0.5 * l)),
    ("twice the shear rate", flowing(|l| 2.0 * l)),
    ("W with the wrong sign", Variant { parts: [-1.0, 1.0, 1.0], ..RIGHT }),
    ("no W", Variant { parts: [0.0, 1.0, 1.0], ..RIGHT }),
    ("W without ½", Variant { parts: [2.0, 1.0, 1.0], ..RIGHT }),
    ("D without ½", Variant { parts: [1.0, 2.0, 2.0], ..RIGHT }),
    ("ṗ without the part along p, −Λ p (p·D p)", Variant { parts: [1.0, 1.0, 0.0], ..RIGHT }),
    ("L x of the transposed gradient, ṗ of the right one", Variant { carrying: |l| l.transpose(), ..RIGHT }),
    ("V′_r, not divided by r", Variant { undivided: true, ..RIGHT }),
    ("Λ with the wrong sign (1/r_e for r_e)", shaped(|r| (RIGHT.shapes)(r).map(|shape| -shape))),
    ("no 1/r_e (Λ = 1, an infinitely slender rod)", shaped(|_| [1.0; 2])),
    ("(r_e − 1)/(r_e + 1) for Λ", shaped(|r| r.map(|r| (r - 1.0) / (r + 1.0)))),
    ("half the r_e (a half-length for a length?)", shaped(|r| (RIGHT.shapes)(r.map(|r| 0.5 * r)))),
    ("twice the r_e (a radius for a diameter?)", shaped(|r| (RIGHT.shapes)(r.map(|r| 2.0 * r)))),
    ("r_e² for r_e", shaped(|r| (RIGHT.shapes)(r.map(|r| r * r)))),
    ("the r_e of rod a for both", shaped(|[a, _]| (RIGHT.shapes)([a, a]))),
    ("the r_e of rod b for both", shaped(|[_, b]| (RIGHT.shapes)([b, b]))),
    ("the r_e of both rods exchanged", shaped(|[a, b]| (RIGHT.shapes)([b, a]))),
    ("V_c without L x of the centre", placed(|[_, arm]| 0.0 * arm)),
    ("V_c with L x of the contact point, which ṗ r contains already", placed(|[centre, arm]| centre + arm)),
    ("the line between the centres for the contact line", lined(|[_, _, apart]| apart.normalize())),
    ("a contact line that is not a unit vector", lined(|[a, b, _]| a.cross(&b))),
    (
        "a contact line p_a × p_b whose second component has the wrong sign",
        lined(|[a, b, _]| {
            let line = a.cross(&b).normalize();
            Vector3::new(line.x, -line.y, line.z)
        }),
    ),
    ("the whole velocity becomes the mean, not its part along the contact line", shared([1.0, 1.0])),
    ("the velocity across the contact line becomes the mean, not along it", shared([0.0, 1.0])),
    ("v̄ = 0: both rods stop along the contact line", meant([0.0, 0.0])),
    ("v̄ = v_a + v_b, not halved", meant([1.0, 1.0])),
    ("v̄ = (v_a − v_b)/2", meant([0.5, -0.5])),
    ("v̄ = (v_b − v_a)/2", meant([-0.5, 0.5])),
    ("L x of the centre not taken off: V′_c/r for V′_r/r", taken(|_, _, _| Vector3::zeros())),
    ("L x of the other rod taken off", taken(|rod, _, centres| centres[1 - rod])),
    (
        "V_c without L x of the centre, which is taken off all the same",
        Variant { place: |[_, arm]| 0.0 * arm, ..taken(|rod, _, centres| centres[rod]) },
    ),
    (
        "V_c with L (x + r p) for L x, of which L x is taken off",
        Variant { place: |[centre, arm]| centre + arm, ..taken(|rod, _, centres| centres[rod]) },
    ),
    (
        "V_c = L (x + r p): the contact point moves with the liquid, of which L x is taken off",
        Variant {
            place: |[centre, arm]| centre + arm,
            turning: 0.0,
            free: 0.0,
            ..taken(|rod, _, centres| centres[rod])
        },
    ),
    ("V_c = L x, without ṗ r, also in V′_r", Variant { turning: 0.0, free: 0.0, ..RIGHT }),
    (
        "V′_c has no part but that along the contact line",
        Variant { mean_across: 0.0, shared: [1.0, 1.0], ..taken(|rod, _, centres| centres[rod]) },
    ),
    ("the change of ṗ alone, without ṗ", Variant { free: 0.0, ..RIGHT }),
    ("V_c without ṗ r", Variant { turning: 0.0, ..RIGHT }),
    (
        "V_c = L (x + r p): the contact point moves with the liquid",
        Variant { turning: 0.0, ..placed(|[centre, arm]| centre + arm) },
    ),
    ("the arm of a rod to where the other's centre is nearest, d·p", footed(|[a, b, _]| [a, -b])),
    (
        "sin for sin² of the angle between the rods in the arms",
        footed(|[a, b, cosine]| (RIGHT.feet)([a, b, cosine]).map(|arm| arm * (1.0 - cosine * cosine).sqrt())),
    ),
    ("arms without 1/sin² of the angle between the rods", footed(|[a, b, cosine]| [a - cosine * b, cosine * a - b])),
    (
        "the arm of rod a with p_a·p_b of the wrong sign",
        footed(|[a, b, cosine]| [(RIGHT.feet)([a, b, -cosine])[0], (RIGHT.feet)([a, b, cosine])[1]]),
    ),
    (
        "the arm of rod b with p_a·p_b of the wrong sign",
        footed(|[a, b, cosine]| [(RIGHT.feet)([a, b, cosine])[0], (RIGHT.feet)([a, b, -cosine])[1]]),
    ),
    ("arms with p_a·p_b of the wrong sign", footed(|[a, b, cosine]| (RIGHT.feet)([a, b, -cosine]))),
    ("one rod after the other: b shares what a has after its own change", kicked([1.0, 0.5])),
    ("one rod after the other: a shares what b has after its own change", kicked([0.5, 1.0])),
    ("r_e = 11.6 for all rods, not each rod's own", shaped(|_| (RIGHT.shapes)([ASPECT_RATIO; 2]))),
];

/// φ from the second axis, in the rates.
const MIRRORED: Variant = Variant {
    phi_rate: |at, rate| (RIGHT.phi_rate)(mirrored(at), rate),
    theta_rate: |at, rate| (RIGHT.theta_rate)(mirrored(at), rate),
    ..RIGHT
};

/// Mistakes in the angles and their rates.
const OF_ANGLES: &[(&str, Variant)] = &[
    (
        "A.13 as in the text",
        Variant {
            phi_rate: |at, rate| within(at, rate)[0],
            theta_rate: |at, rate| within(at, rate)[1] * at[1].sin() - rate.z * at[1].cos(),
            ..RIGHT
        },
    ),
    ("φ̇′ without 1/sin θ", going_round(|at, rate| within(at, rate)[0])),
    ("φ̇′ times sin θ, not divided", going_round(|at, rate| within(at, rate)[0] * at[1].sin())),
    ("φ̇′ divided by cos θ, not by sin θ", going_round(|at, rate| within(at, rate)[0] / at[1].cos())),
    ("φ̇′ with the wrong sign", going_round(|at, rate| -(RIGHT.phi_rate)(at, rate))),
    ("θ̇′ with the wrong sign", tilting(|at, rate| -(RIGHT.theta_rate)(at, rate))),
    ("θ̇′ without v_3", tilting(|at, rate| within(at, rate)[1] * at[1].cos())),
    ("θ̇′ of −v_3/sin θ alone", tilting(|at, rate| -rate.z * at[1].sin())),
    ("θ̇′ with + v_3 sin θ", tilting(|at, rate| within(at, rate)[1] * at[1].cos() + rate.z * at[1].sin())),
    ("sin φ and cos φ exchanged in the rates", MIRRORED),
    ("atan2(p_1, p_2) for φ", stepped(from_the_second_axis)),
    ("atan2(p_1, p_2) for φ, and in the rates", Variant { stepped: from_the_second_axis, ..MIRRORED }),
    (
        "θ before φ",
        Variant {
            phi_rate: RIGHT.theta_rate,
            theta_rate: RIGHT.phi_rate,
            ..stepped(|step| {
                let [phi, theta] = step.angles;
                (RIGHT.stepped)(&Step { angles: [theta, phi], ..*step })
            })
        },
    ),
    (
        "angles and their rates in degrees",
        Variant {
            phi_rate: |at, rate| (RIGHT.phi_rate)(at, rate).to_degrees(),
            theta_rate: |at, rate| (RIGHT.theta_rate)(at, rate).to_degrees(),
            ..stepped(|step| (RIGHT.stepped)(&Step { angles: step.angles.map(f64::to_degrees), ..*step }))
        },
    ),
    ("half a time step", Variant { step: 0.5, ..RIGHT }),
    ("two time steps", Variant { step: 2.0, ..RIGHT }),
    ("no step: the angles before it", Variant { step: 0.0, ..RIGHT }),
    ("a step backwards", Variant { step: -1.0, ..RIGHT }),
    ("Δt = 1 s", stepped(|step| (RIGHT.stepped)(&Step { step_s: 1.0, ..*step }))),
    ("angles in degrees", stepped(|step| (RIGHT.stepped)(step).map(f64::to_degrees))),
    (
        "φ from 0 to π, not from −π to π",
        stepped(|step| {
            let [phi, theta] = (RIGHT.stepped)(step);
            [phi.rem_euclid(PI), theta]
        }),
    ),
    ("atan for atan2 in φ", stepped(by_atan)),
    (
        "atan for atan2 in φ, and in its rates",
        Variant {
            phi_rate: |at, rate| (RIGHT.phi_rate)(folded(at), rate),
            theta_rate: |at, rate| (RIGHT.theta_rate)(folded(at), rate),
            ..stepped(by_atan)
        },
    ),
    (
        "θ from the shear plane, not from the vorticity axis",
        stepped(|step| {
            let [phi, theta] = (RIGHT.stepped)(step);
            [phi, FRAC_PI_2 - theta]
        }),
    ),
    (
        "a step of p, not of its angles",
        stepped(|step| {
            let p = step.p + step.rate * step.step_s;
            [p.y.atan2(p.x), p.x.hypot(p.y).atan2(p.z)]
        }),
    ),
];

const fn kicked(kick: [f64; 2]) -> Variant {
    Variant { kick, ..RIGHT }
}

const fn armed(arms: fn([f64; 2]) -> Option<[f64; 2]>) -> Variant {
    Variant { arms, ..RIGHT }
}

const fn divided(divisors: fn([f64; 2]) -> [f64; 2]) -> Variant {
    Variant { divisors, ..RIGHT }
}

const fn shaped(shapes: fn([f64; 2]) -> [f64; 2]) -> Variant {
    Variant { shapes, ..RIGHT }
}

const fn placed(place: fn([Vector3<f64>; 2]) -> Vector3<f64>) -> Variant {
    Variant { place, ..RIGHT }
}

const fn lined(line: fn([Vector3<f64>; 3]) -> Vector3<f64>) -> Variant {
    Variant { line, ..RIGHT }
}

const fn footed(feet: fn([f64; 3]) -> [f64; 2]) -> Variant {
    Variant { feet, ..RIGHT }
}

const fn taken(taken: fn(usize, Both, Both) -> Vector3<f64>) -> Variant {
    Variant { taken, ..RIGHT }
}

const fn meant(mean: [f64; 2]) -> Variant {
    Variant { mean, ..RIGHT }
}

const fn shared(shared: [f64; 2]) -> Variant {
    Variant { shared, ..RIGHT }
}

const fn going_round(phi_rate: AngleRate) -> Variant {
    Variant { phi_rate, ..RIGHT }
}

const fn tilting(theta_rate: AngleRate) -> Variant {
    Variant { theta_rate, ..RIGHT }
}

const fn stepped(stepped: fn(&Step) -> [f64; 2]) -> Variant {
    Variant { stepped, ..RIGHT }
}

const fn flowing(gradient: fn(&Matrix3<f64>) -> Matrix3<f64>) -> Variant {
    Variant { gradient, ..RIGHT }
}

/// φ from the second axis.
fn mirrored([phi, theta]: [f64; 2]) -> [f64; 2] {
    [FRAC_PI_2 - phi, theta]
}

/// φ as atan gives it.
fn folded([phi, theta]: [f64; 2]) -> [f64; 2] {
    [phi - PI * (phi / PI).round(), theta]
}

fn by_atan(step: &Step) -> [f64; 2] {
    (RIGHT.stepped)(&Step { angles: folded(step.angles), ..*step })
}

fn from_the_second_axis(step: &Step) -> [f64; 2] {
    (RIGHT.stepped)(&Step { angles: mirrored(step.angles), ..*step })
}

/// The mistakes in what is asked for: angles with a step, ṗ′ without one.
fn mistakes(step_s: Option<f64>) -> impl Iterator<Item = &'static (&'static str, Variant)> {
    MISTAKES.iter().chain(OF_ANGLES.iter().filter(move |_| step_s.is_some()))
}

/// The largest distance at which values are those of a mistake, which rounding explains whatever the error is.
const SAME: f64 = 1e-6;

/// The mistakes whose answers are nearer than `nearer_than`, each with its distance: as they are, or with ṗ′ made
/// normal to p.
pub(super) fn near(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> Vec<Near> {
    let Some(inputs) = &loaded.inputs else {
        return Vec::new();
    };
    let (gradient, step_s) = (loaded.problem.gradient(), loaded.problem.time_step_s);
    let off = |variant: &Variant, order: [usize; 2]| {
        let mut largest: f64 = 0.0;
        for (values, pair) in answer.rows.iter().zip(&inputs.rows) {
            let own = answers(&gradient, &pair[1..], step_s, *variant);
            let off = distance(loaded, values, &order.map(|rod| own[rod].as_slice()).concat());
            largest = largest.max(if off.is_nan() { f64::INFINITY } else { off });
            // Saves time: most are far already in the first row.
            if largest > nearer_than.min(SAME) {
                return None;
            }
        }
        Some(largest)
    };
    let near = mistakes(step_s).filter_map(|(name, variant)| {
        let normal = || off(&Variant { normal: true, ..*variant }, [0, 1]);
        Some(Near::new(off(variant, [0, 1]).or_else(normal)?, name))
    });
    let exchanged = off(&RIGHT, [1, 0]).map(|distance| Near::new(distance, "the rods a and b exchanged in the answer"));
    near.chain(exchanged).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::serve::grade::compare::compare;
    use crate::serve::problems::contact::SNAPSHOTS;
    use crate::serve::problems::loaded;
    use std::collections::BTreeSet;

    /// Codes that keep φ in another turn are right; those that lose its half are not.
    #[test]
    fn an_angle_is_the_same_a_turn_later() {
        let loaded = loaded("contact-angles");
        let error = |by: f64| {
            let mut answer = Answer::certified(&loaded);
            let phi = answer.rows[7].len() / 2 + 2;
            answer.rows[7][phi] += by;
            compare(&loaded, &answer).error
        };
        let tolerance = loaded.problem.tolerance;
        assert!([2.0 * PI, -2.0 * PI].into_iter().all(|turn| error(turn) < tolerance));
        assert!([PI, 0.5 * PI, 2.0 * PI + 1e-6].into_iter().all(|off| error(off) > tolerance));
    }

    /// Each mistake is recognised from its own answers, and no other but one that is the same.
    #[test]
    fn each_mistake_is_named_by_its_own_answers() {
        for name in ["contact-rule", "contact-angles"] {
            let loaded = loaded(name);
            let (gradient, step_s) = (loaded.problem.gradient(), loaded.problem.time_step_s);
            let answer = |variant: Variant| {
                let row = |pair: &Vec<f64>| answers(&gradient, &pair[1..], step_s, variant).concat();
                let rows = loaded.inputs.as_ref().unwrap().rows.iter().map(row).collect();
                Answer { path: name.into(), rows, lines: vec![0; SNAPSHOTS] }
            };
            let named = |variant: Variant| {
                let near = near(&loaded, &answer(variant), 1e-5);
                assert!(near.iter().all(|near| near.distance < 1e-11), "{near:?}");
                near.into_iter().map(|near| near.name).collect::<Vec<_>>()
            };
            let mut alike = BTreeSet::new();
            for (mistake, variant) in mistakes(step_s) {
                for normal in [false, true] {
                    let named = named(Variant { normal, ..*variant });
                    assert!(named.iter().any(|name| name == mistake), "{name}: {mistake}: {named:?}");
                    alike.extend(named.into_iter().filter(|name| name != mistake));
                }
            }
            // Normal to p, ṗ + L p is the rate of an infinitely slender rod.
            let moves_with = "V_c = L (x + r p): the contact point moves with the liquid, of which L x is taken off";
            assert_eq!(
                alike.into_iter().collect::<Vec<_>>(),
                [moves_with, "no 1/r_e (Λ = 1, an infinitely slender rod)"]
            );
            // The part of ṗ along p has no effect on the contact.
            assert_eq!(named(RIGHT), ["ṗ without the part along p, −Λ p (p·D p)"], "{name}");
            assert!(compare(&loaded, &answer(RIGHT)).error <= loaded.problem.tolerance, "{name}");
        }
    }
}
