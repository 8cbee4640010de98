//! Diagnosis of answers about two rods in contact: known mistakes in A.7 to A.14.

use super::answer::Answer;
use super::nearness::Near;
use crate::serve::problems::LoadedProblem;
use crate::serve::problems::contact::{LENGTH_MM, RIGHT, Variant, answers, within};
use nalgebra::{Matrix3, Vector3};

/// Mistakes in ṗ′.
const MISTAKES: [(&str, Variant); 26] = [
    ("a kick with the wrong sign", kicked([-1.0; 2])),
    ("no kick", kicked([0.0; 2])),
    ("a kick to the other rod's velocity, not to the mean", kicked([2.0; 2])),
    ("half the kick", kicked([0.5; 2])),
    ("a kick of rod a alone", kicked([1.0, 0.0])),
    ("a kick of rod b alone", kicked([0.0, 1.0])),
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
    ("the arms of both rods exchanged", armed(|[a, b]| Some([b, a]))),
    ("arms counted from an end of the rod", armed(|arms| Some(arms.map(|arm| arm + 0.5)))),
    ("arms of half the length", armed(|arms| Some(arms.map(|arm| 0.5 * arm)))),
    ("arms of twice the length", armed(|arms| Some(arms.map(|arm| 2.0 * arm)))),
    ("arms in rod lengths, not in mm", armed(|arms| Some(arms.map(|arm| arm / LENGTH_MM)))),
    ("a transposed gradient", flowing(|l| l.transpose())),
    ("the flow reversed (L with the wrong sign, or time backwards)", flowing(|l| -l)),
    ("half the shear rate", flowing(|l| 0.5 * l)),
    ("twice the shear rate", flowing(|l| 2.0 * l)),
    ("Λ with the wrong sign (1/r_e for r_e)", Variant { shape: |r| -(RIGHT.shape)(r), ..RIGHT }),
    ("no 1/r_e (Λ = 1, an infinitely slender rod)", Variant { shape: |_| 1.0, ..RIGHT }),
    ("(r_e − 1)/(r_e + 1) for Λ", Variant { shape: |r| (r - 1.0) / (r + 1.0), ..RIGHT }),
    ("V_c without L x of the centre", Variant { centre: 0.0, ..RIGHT }),
    ("the line between the centres for the contact line", Variant { line: |[_, _, apart]| apart, ..RIGHT }),
];

/// Mistakes in the rates of the angles.
const OF_ANGLES: [(&str, Variant); 2] = [
    ("A.13 as in the text", Variant { turned: printed, ..RIGHT }),
    ("φ̇′ without 1/sin θ", Variant { turned: |at, rate| [within(at, rate)[0], (RIGHT.turned)(at, rate)[1]], ..RIGHT }),
];

const fn kicked(kick: [f64; 2]) -> Variant {
    Variant { kick, ..RIGHT }
}

const fn armed(arms: fn([f64; 2]) -> Option<[f64; 2]>) -> Variant {
    Variant { arms, ..RIGHT }
}

const fn flowing(gradient: fn(&Matrix3<f64>) -> Matrix3<f64>) -> Variant {
    Variant { gradient, ..RIGHT }
}

fn printed(at: [f64; 2], rate: &Vector3<f64>) -> [f64; 2] {
    let ([around, across], theta) = (within(at, rate), at[1]);
    [around, across * theta.sin() - rate.z * theta.cos()]
}

/// The mistakes in what is asked for: angles with a step, ṗ′ without one.
fn mistakes(step_s: Option<f64>) -> impl Iterator<Item = &'static (&'static str, Variant)> {
    MISTAKES.iter().chain(OF_ANGLES.iter().filter(move |_| step_s.is_some()))
}

/// The mistakes whose answers are nearer than `nearer_than`, each with its distance.
pub(super) fn near(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> Vec<Near> {
    let Some(inputs) = &loaded.inputs else {
        return Vec::new();
    };
    let (gradient, step_s) = (loaded.problem.gradient(), loaded.problem.time_step_s);
    let off = |variant: &Variant, order: [usize; 2]| {
        let mut largest: f64 = 0.0;
        for (values, pair) in answer.rows.iter().zip(&inputs.rows) {
            let half = values.len() / 2;
            for (k, expected) in order.into_iter().zip(answers(&gradient, &pair[1..], step_s, *variant)) {
                let found = values.get(k * half..(k + 1) * half)?;
                let square = |of: &dyn Fn(usize) -> f64| (0..half).map(|i| of(i).powi(2)).sum::<f64>();
                let off = square(&|i| found[i] - expected[i]) / square(&|i| expected[i]);
                largest = largest.max(if off.is_nan() { f64::INFINITY } else { off.sqrt() });
            }
            // Saves time: most are far already in the first row.
            if largest > nearer_than {
                return None;
            }
        }
        Some(largest)
    };
    let near = mistakes(step_s).filter_map(|(name, variant)| Some(Near::new(off(variant, [0, 1])?, name)));
    let exchanged = off(&RIGHT, [1, 0]).map(|distance| Near::new(distance, "the rods a and b exchanged in the answer"));
    near.chain(exchanged).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::serve::grade::compare::compare;
    use crate::serve::problems::contact::SNAPSHOTS;
    use crate::serve::problems::loaded;

    /// Each mistake is recognised from its own answers and from no others; correct answers have none.
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
                let near = near(&loaded, &answer(variant), 1e-3);
                assert!(near.iter().all(|near| near.distance < 1e-14), "{near:?}");
                near.into_iter().map(|near| near.name).collect::<Vec<_>>()
            };
            for (mistake, variant) in mistakes(step_s) {
                assert_eq!(named(*variant), [*mistake], "{name}");
            }
            assert_eq!(named(RIGHT), [""; 0], "{name}");
            assert!(compare(&loaded, &answer(RIGHT)).error <= loaded.problem.tolerance, "{name}");
        }
    }
}
