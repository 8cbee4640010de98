//! Diagnosis of answers about two rods in contact: known mistakes in A.7 to A.14.

use super::answer::Answer;
use super::compare::distance;
use super::mistakes::angles_of;
use super::nearness::{Near, largest_within};
use crate::serve::problems::LoadedProblem;
use crate::serve::problems::contact::{ASPECT_RATIO, LENGTH_MM, RIGHT, Step, Variant, answers, within};
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// What is wrong in a code that is right otherwise.
type Spoil = fn(&mut Variant);

/// Mistakes in ṗ′.
const MISTAKES: &[(&str, Spoil)] = &[
    ("a kick with the wrong sign", |v| v.kick = [-1.0; 2]),
    ("no kick", |v| v.kick = [0.0; 2]),
    ("a kick to the other rod's velocity, not to the mean", |v| v.kick = [2.0; 2]),
    ("half the kick", |v| v.kick = [0.5; 2]),
    ("a kick of rod a alone", |v| v.kick = [1.0, 0.0]),
    ("a kick of rod b alone", |v| v.kick = [0.0, 1.0]),
    ("a takes the velocity of b, and b stays", |v| v.kick = [2.0, 0.0]),
    ("b takes the velocity of a, and a stays", |v| v.kick = [0.0, 2.0]),
    ("the kick of rod a with the wrong sign", |v| v.kick = [-1.0, 1.0]),
    ("the kick of rod b with the wrong sign", |v| v.kick = [1.0, -1.0]),
    ("arms clipped at the rods' ends, ±a/2", |v| v.arms = |arms| Some(arms.map(|arm| arm.clamp(-0.5, 0.5)))),
    ("arms clipped at ±a", |v| v.arms = |arms| Some(arms.map(|arm| arm.clamp(-1.0, 1.0)))),
    ("contact lines cut at the rods' ends: no contact beyond", |v| {
        v.arms = |arms| arms.iter().all(|arm| arm.abs() <= 0.5).then_some(arms)
    }),
    ("contact lines cut at ±a: no contact beyond", |v| {
        v.arms = |arms| arms.iter().all(|arm| arm.abs() <= 1.0).then_some(arms)
    }),
    ("|r| for the signed arm r", |v| v.arms = |arms| Some(arms.map(f64::abs))),
    ("arms with the wrong sign", |v| v.arms = |arms| Some(arms.map(|arm| -arm))),
    ("the arm of rod a with the wrong sign", |v| v.arms = |[a, b]| Some([-a, b])),
    ("the arm of rod b with the wrong sign", |v| v.arms = |[a, b]| Some([a, -b])),
    ("the arms of both rods exchanged", |v| v.arms = |[a, b]| Some([b, a])),
    ("the arm of rod a for both", |v| v.arms = |[a, _]| Some([a, a])),
    ("the arm of rod b for both", |v| v.arms = |[_, b]| Some([b, b])),
    ("arms of half a rod for r", |v| v.arms = |_| Some([0.5; 2])),
    ("arms counted from an end of the rod", |v| v.arms = |arms| Some(arms.map(|arm| arm + 0.5))),
    ("arms counted from the other end of the rod", |v| v.arms = |arms| Some(arms.map(|arm| arm - 0.5))),
    ("arms of half the length", |v| v.arms = |arms| Some(arms.map(|arm| 0.5 * arm))),
    ("arms of twice the length", |v| v.arms = |arms| Some(arms.map(|arm| 2.0 * arm))),
    ("arms in rod lengths, not in mm", |v| v.arms = |arms| Some(arms.map(|arm| arm / LENGTH_MM))),
    ("arms in cm, not in mm", |v| v.arms = |arms| Some(arms.map(|arm| 0.1 * arm))),
    ("the change of velocity times r, not divided by r", |v| v.divisors = |arms| arms.map(f64::recip)),
    ("the change of velocity not divided by r", |v| v.divisors = |_| [1.0; 2]),
    ("the change of velocity divided by |r|", |v| v.divisors = |arms| arms.map(f64::abs)),
    ("the change of velocity divided by the other rod's arm", |v| v.divisors = |[a, b]| [b, a]),
    ("the change of velocity divided by r²", |v| v.divisors = |arms| arms.map(|arm| arm * arm)),
    ("the change of velocity divided by half a rod, not by r", |v| v.divisors = |_| [0.5 * LENGTH_MM; 2]),
    ("the change of velocity divided by a rod's length, not by r", |v| v.divisors = |_| [LENGTH_MM; 2]),
    ("a transposed gradient", |v| v.gradient = |l| l.transpose()),
    ("the flow reversed (L with the wrong sign, or time backwards)", |v| v.gradient = |l| -l),
    ("half the shear rate", |v| v.gradient = |l| 0.5 * l),
    ("twice the shear rate", |v| v.gradient = |l| 2.0 * l),
    ("W with the wrong sign", |v| v.parts = [-1.0, 1.0, 1.0]),
    ("no W", |v| v.parts = [0.0, 1.0, 1.0]),
    ("W without ½", |v| v.parts = [2.0, 1.0, 1.0]),
    ("D without ½", |v| v.parts = [1.0, 2.0, 2.0]),
    ("ṗ without the part along p, −Λ p (p·D p)", |v| v.parts = [1.0, 1.0, 0.0]),
    ("L x of the transposed gradient, ṗ of the right one", |v| v.carrying = |l| l.transpose()),
    ("V′_r, not divided by r", |v| v.undivided = true),
    ("Λ with the wrong sign (1/r_e for r_e)", |v| v.shapes = |r| (RIGHT.shapes)(r).map(|shape| -shape)),
    ("no 1/r_e (Λ = 1, an infinitely slender rod)", |v| v.shapes = |_| [1.0; 2]),
    ("(r_e − 1)/(r_e + 1) for Λ", |v| v.shapes = |r| r.map(|r| (r - 1.0) / (r + 1.0))),
    ("half the r_e (a half-length for a length?)", |v| v.shapes = |r| (RIGHT.shapes)(r.map(|r| 0.5 * r))),
    ("twice the r_e (a radius for a diameter?)", |v| v.shapes = |r| (RIGHT.shapes)(r.map(|r| 2.0 * r))),
    ("r_e² for r_e", |v| v.shapes = |r| (RIGHT.shapes)(r.map(|r| r * r))),
    ("the r_e of rod a for both", |v| v.shapes = |[a, _]| (RIGHT.shapes)([a, a])),
    ("the r_e of rod b for both", |v| v.shapes = |[_, b]| (RIGHT.shapes)([b, b])),
    ("the r_e of both rods exchanged", |v| v.shapes = |[a, b]| (RIGHT.shapes)([b, a])),
    ("V_c without L x of the centre", |v| v.place = |[_, arm]| 0.0 * arm),
    ("V_c with L x of the contact point, which ṗ r contains already", |v| v.place = |[centre, arm]| centre + arm),
    ("the line between the centres for the contact line", |v| v.line = |[_, _, apart]| apart.normalize()),
    ("a contact line that is not a unit vector", |v| v.line = |[a, b, _]| a.cross(&b)),
    ("a contact line p_a × p_b whose second component has the wrong sign", |v| {
        v.line = |[a, b, _]| {
            let line = a.cross(&b).normalize();
            Vector3::new(line.x, -line.y, line.z)
        }
    }),
    ("the whole velocity becomes the mean, not its part along the contact line", |v| v.shared = [1.0, 1.0]),
    ("the velocity across the contact line becomes the mean, not along it", |v| v.shared = [0.0, 1.0]),
    ("v̄ = 0: both rods stop along the contact line", |v| v.mean = [0.0, 0.0]),
    ("v̄ = v_a + v_b, not halved", |v| v.mean = [1.0, 1.0]),
    ("v̄ = (v_a − v_b)/2", |v| v.mean = [0.5, -0.5]),
    ("v̄ = (v_b − v_a)/2", |v| v.mean = [-0.5, 0.5]),
    ("L x of the centre not taken off: V′_c/r for V′_r/r", |v| v.taken = |_, _, _| Vector3::zeros()),
    ("L x of the other rod taken off", |v| v.taken = |rod, _, centres| centres[1 - rod]),
    ("V_c without L x of the centre, which is taken off all the same", |v| {
        v.place = |[_, arm]| 0.0 * arm;
        v.taken = |rod, _, centres| centres[rod];
    }),
    ("V_c with L (x + r p) for L x, of which L x is taken off", |v| {
        v.place = |[centre, arm]| centre + arm;
        v.taken = |rod, _, centres| centres[rod];
    }),
    ("V_c = L (x + r p): the contact point moves with the liquid, of which L x is taken off", |v| {
        v.place = |[centre, arm]| centre + arm;
        (v.turning, v.free) = (0.0, 0.0);
        v.taken = |rod, _, centres| centres[rod];
    }),
    ("V_c = L x, without ṗ r, also in V′_r", |v| (v.turning, v.free) = (0.0, 0.0)),
    ("V′_c has no part but that along the contact line", |v| {
        (v.mean_across, v.shared) = (0.0, [1.0, 1.0]);
        v.taken = |rod, _, centres| centres[rod];
    }),
    ("the change of ṗ alone, without ṗ", |v| v.free = 0.0),
    ("V_c without ṗ r", |v| v.turning = 0.0),
    ("V_c = L (x + r p): the contact point moves with the liquid", |v| {
        v.turning = 0.0;
        v.place = |[centre, arm]| centre + arm;
    }),
    ("the arm of a rod to where the other's centre is nearest, d·p", |v| v.feet = |[a, b, _]| [a, -b]),
    ("sin for sin² of the angle between the rods in the arms", |v| {
        v.feet = |[a, b, cosine]| (RIGHT.feet)([a, b, cosine]).map(|arm| arm * (1.0 - cosine * cosine).sqrt())
    }),
    ("arms without 1/sin² of the angle between the rods", |v| {
        v.feet = |[a, b, cosine]| [a - cosine * b, cosine * a - b]
    }),
    ("the arm of rod a with p_a·p_b of the wrong sign", |v| {
        v.feet = |[a, b, cosine]| [(RIGHT.feet)([a, b, -cosine])[0], (RIGHT.feet)([a, b, cosine])[1]]
    }),
    ("the arm of rod b with p_a·p_b of the wrong sign", |v| {
        v.feet = |[a, b, cosine]| [(RIGHT.feet)([a, b, cosine])[0], (RIGHT.feet)([a, b, -cosine])[1]]
    }),
    ("arms with p_a·p_b of the wrong sign", |v| v.feet = |[a, b, cosine]| (RIGHT.feet)([a, b, -cosine])),
    ("one rod after the other: b shares what a has after its own change", |v| v.kick = [1.0, 0.5]),
    ("one rod after the other: a shares what b has after its own change", |v| v.kick = [0.5, 1.0]),
    ("r_e = 11.6 for all rods, not each rod's own", |v| v.shapes = |_| (RIGHT.shapes)([ASPECT_RATIO; 2])),
];

/// φ from the second axis, in the rates.
fn mirror(v: &mut Variant) {
    v.phi_rate = |at, rate| (RIGHT.phi_rate)(mirrored(at), rate);
    v.theta_rate = |at, rate| (RIGHT.theta_rate)(mirrored(at), rate);
}

/// Mistakes in the angles and their rates.
const OF_ANGLES: &[(&str, Spoil)] = &[
    ("A.13 as in the text", |v| {
        v.phi_rate = |at, rate| within(at, rate)[0];
        v.theta_rate = |at, rate| within(at, rate)[1] * at[1].sin() - rate.z * at[1].cos();
    }),
    ("φ̇′ without 1/sin θ", |v| v.phi_rate = |at, rate| within(at, rate)[0]),
    ("φ̇′ times sin θ, not divided", |v| v.phi_rate = |at, rate| within(at, rate)[0] * at[1].sin()),
    ("φ̇′ divided by cos θ, not by sin θ", |v| v.phi_rate = |at, rate| within(at, rate)[0] / at[1].cos()),
    ("φ̇′ with the wrong sign", |v| v.phi_rate = |at, rate| -(RIGHT.phi_rate)(at, rate)),
    ("θ̇′ with the wrong sign", |v| v.theta_rate = |at, rate| -(RIGHT.theta_rate)(at, rate)),
    ("θ̇′ without v_3", |v| v.theta_rate = |at, rate| within(at, rate)[1] * at[1].cos()),
    ("θ̇′ of −v_3/sin θ alone", |v| v.theta_rate = |at, rate| -rate.z * at[1].sin()),
    ("θ̇′ with + v_3 sin θ", |v| {
        v.theta_rate = |at, rate| within(at, rate)[1] * at[1].cos() + rate.z * at[1].sin()
    }),
    ("sin φ and cos φ exchanged in the rates", mirror),
    ("atan2(p_1, p_2) for φ", |v| v.stepped = from_the_second_axis),
    ("atan2(p_1, p_2) for φ, and in the rates", |v| {
        mirror(v);
        v.stepped = from_the_second_axis;
    }),
    ("θ before φ", |v| {
        (v.phi_rate, v.theta_rate) = (RIGHT.theta_rate, RIGHT.phi_rate);
        v.stepped = |step| {
            let [phi, theta] = step.angles;
            (RIGHT.stepped)(&Step { angles: [theta, phi], ..*step })
        };
    }),
    ("angles and their rates in degrees", |v| {
        v.phi_rate = |at, rate| (RIGHT.phi_rate)(at, rate).to_degrees();
        v.theta_rate = |at, rate| (RIGHT.theta_rate)(at, rate).to_degrees();
        v.stepped = |step| (RIGHT.stepped)(&Step { angles: step.angles.map(f64::to_degrees), ..*step });
    }),
    ("half a time step", |v| v.step = 0.5),
    ("two time steps", |v| v.step = 2.0),
    ("no step: the angles before it", |v| v.step = 0.0),
    ("a step backwards", |v| v.step = -1.0),
    ("Δt = 1 s", |v| v.stepped = |step| (RIGHT.stepped)(&Step { step_s: 1.0, ..*step })),
    ("angles in degrees", |v| v.stepped = |step| (RIGHT.stepped)(step).map(f64::to_degrees)),
    ("φ from 0 to π, not from −π to π", |v| {
        v.stepped = |step| {
            let [phi, theta] = (RIGHT.stepped)(step);
            [phi.rem_euclid(PI), theta]
        };
    }),
    ("atan for atan2 in φ", |v| v.stepped = by_atan),
    ("atan for atan2 in φ, and in its rates", |v| {
        v.phi_rate = |at, rate| (RIGHT.phi_rate)(folded(at), rate);
        v.theta_rate = |at, rate| (RIGHT.theta_rate)(folded(at), rate);
        v.stepped = by_atan;
    }),
    ("θ from the shear plane, not from the vorticity axis", |v| {
        v.stepped = |step| {
            let [phi, theta] = (RIGHT.stepped)(step);
            [phi, FRAC_PI_2 - theta]
        };
    }),
    ("a step of p, not of its angles", |v| {
        v.stepped = |step| {
            let p = step.p + step.rate * step.step_s;
            angles_of(&p)
        };
    }),
];

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
fn mistakes(step_s: Option<f64>) -> impl Iterator<Item = (&'static str, Variant)> {
    MISTAKES.iter().chain(OF_ANGLES.iter().filter(move |_| step_s.is_some())).map(|(name, spoil)| {
        let mut variant = RIGHT;
        spoil(&mut variant);
        (*name, variant)
    })
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
    let off = |variant: Variant, order: [usize; 2]| {
        let off = |(values, pair): (&Vec<f64>, &Vec<f64>)| {
            let own = answers(&gradient, &pair[1..], step_s, variant);
            Some(distance(loaded, values, &order.map(|rod| own[rod].as_slice()).concat()))
        };
        largest_within(nearer_than.min(SAME), answer.rows.iter().zip(&inputs.rows).map(off))
    };
    let near = mistakes(step_s).filter_map(|(name, variant)| {
        let normal = || off(Variant { normal: true, ..variant }, [0, 1]);
        Some(Near::new(off(variant, [0, 1]).or_else(normal)?, name))
    });
    let exchanged = off(RIGHT, [1, 0]).map(|distance| Near::new(distance, "the rods a and b exchanged in the answer"));
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
                    let named = named(Variant { normal, ..variant });
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
