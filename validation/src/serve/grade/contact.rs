//! Diagnosis of answers about two rods in contact: known mistakes in A.7 to A.14.

use super::answer::Answer;
use super::nearness::Near;
use crate::serve::problems::LoadedProblem;
use crate::serve::problems::contact::{Variant, answers};

const RIGHT: Variant = Variant { kick: 1.0, printed: false, arms: Some };

const MISTAKES: [(&str, Variant); 9] = [
    ("a kick with the wrong sign", kicked(-1.0)),
    ("no kick", kicked(0.0)),
    ("a kick to the other rod's velocity, not to the mean", kicked(2.0)),
    ("A.13 as in the text", Variant { printed: true, ..RIGHT }),
    ("arms clipped at the rods' ends, ±a/2", armed(|arms| Some(arms.map(|arm| arm.clamp(-0.5, 0.5))))),
    ("arms clipped at ±a", armed(|arms| Some(arms.map(|arm| arm.clamp(-1.0, 1.0))))),
    (
        "contact lines cut at the rods' ends: no contact beyond",
        armed(|arms| arms.iter().all(|arm| arm.abs() <= 0.5).then_some(arms)),
    ),
    ("|r| for the signed arm r", armed(|arms| Some(arms.map(f64::abs)))),
    ("the arms of both rods exchanged", armed(|[a, b]| Some([b, a]))),
];

const fn kicked(kick: f64) -> Variant {
    Variant { kick, ..RIGHT }
}

const fn armed(arms: fn([f64; 2]) -> Option<[f64; 2]>) -> Variant {
    Variant { arms, ..RIGHT }
}

/// The mistakes whose answers are nearer than `nearer_than`, each with its distance.
pub(super) fn near(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> Vec<Near> {
    let Some(inputs) = &loaded.inputs else {
        return Vec::new();
    };
    let (gradient, step_s) = (loaded.problem.gradient(), loaded.problem.time_step_s);
    let of_mistake = |(name, variant): &(&str, Variant)| {
        let mut largest: f64 = 0.0;
        for (values, pair) in answer.rows.iter().zip(&inputs.rows) {
            let half = values.len() / 2;
            for (k, expected) in answers(&gradient, &pair[1..], step_s, *variant).iter().enumerate() {
                let found = values.get(k * half..(k + 1) * half)?;
                let square = |of: &dyn Fn(usize) -> f64| (0..half).map(|i| of(i).powi(2)).sum::<f64>();
                let off = square(&|i| found[i] - expected[i]) / square(&|i| expected[i]);
                largest = largest.max(if off.is_nan() { f64::INFINITY } else { off.sqrt() });
            }
        }
        Some(Near::new(largest, name))
    };
    // A.13 concerns the angles only, not ṗ′.
    let applies = |(_, variant): &&(&str, Variant)| !variant.printed || step_s.is_some();
    let near = MISTAKES.iter().filter(applies).filter_map(of_mistake);
    near.filter(|near| near.distance <= nearer_than).collect()
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
            for (mistake, variant) in MISTAKES {
                // Without Δt there are no angles.
                if !variant.printed || step_s.is_some() {
                    assert_eq!(named(variant), [mistake], "{name}");
                }
            }
            assert_eq!(named(RIGHT), [""; 0], "{name}");
            assert!(compare(&loaded, &answer(RIGHT)).error <= loaded.problem.tolerance, "{name}");
        }
    }
}
