use super::*;
use crate::serve::grade::compare::compare;
use crate::serve::grade::live::last_time;
use crate::serve::problems::loaded;
use nalgebra::Matrix3;

/// The answer to a problem by these stages.
fn answered(loaded: &LoadedProblem, form: Form, stages: &Stages, steps: u64) -> Answer {
    let times = Times::new(&loaded.problem.times_s, steps);
    let rows: Vec<Vec<f64>> = match loaded.problem.kind {
        Kind::Rods => {
            let a = Setting::from(&loaded.problem).rates_per_s();
            let of_rod = |p: &[f64; 3]| {
                let found = directions(form, &a, stages, &times, (*p).into());
                found.into_iter().map(|q| if form == Form::Raw { q } else { q.normalize() }).collect::<Vec<_>>()
            };
            let rods: Vec<_> = loaded.start.iter().map(of_rod).collect();
            let at = |k: usize| rods.iter().map(move |rod| rod[k].as_slice().to_vec());
            (0..times.at.len()).flat_map(at).collect()
        }
        _ => tensors::by_equation(&loaded.problem, |rate, start| times.tensors(stages, start, rate)).unwrap(),
    };
    Answer { lines: vec![0; rows.len()], rows, path: "a test".into() }
}

/// Each slip is found in its own steps and is none of the others, and in right ones there is none; of a linear
/// equation several have the same steps.
#[test]
fn each_slip_is_found_by_its_own_steps() {
    let mut all = 0;
    for (name, form, steps) in [
        ("mid-flip-2", Form::Raw, 256),
        ("mid-flip-2", Form::Linear, 256),
        ("spiral", Form::Normalised, 128),
        ("spiral", Form::Angles, 64),
        ("closed-ft-ibof-mixed", Form::Raw, 60),
    ] {
        let whole = loaded(name);
        let loaded = if whole.problem.kind == Kind::Rods { last_time(&whole) } else { whole };
        let found = |stages: &Stages| {
            let answer = answered(&loaded, form, stages, steps);
            let error = compare(&loaded, &answer).error;
            (error, diagnose(&loaded, [(steps, error, &answer)].into_iter()))
        };
        for (slip, stages) in &SLIPS {
            let (error, found) = found(stages);
            // With so few steps some miss the motion.
            let missed = error.is_nan() || error > MISSED;
            match &found.suspects[..] {
                [] => assert!(missed, "{name} {slip}: {error}"),
                [own] => assert_eq!(own, slip),
                several => assert!(form == Form::Linear && several.iter().any(|own| own == slip), "{several:?}"),
            }
            all += usize::from(!missed);
        }
        assert_eq!(found(&RIGHT).1, Diagnosis::default());
    }
    assert_eq!(all, 138);
}

/// A slip is named where its order refutes the claim, or where none is made; a right method of low order is not,
/// nor is anything where there is another diagnosis.
#[test]
fn a_slip_is_named_where_its_order_is_low() {
    let loaded = last_time(&loaded("spiral"));
    let named = |stages: &Stages, order: Option<f64>, diagnosis: Option<String>| {
        let answers = [128, 256, 512, 1024].map(|steps| (steps, answered(&loaded, Form::Raw, stages, steps)));
        let errors = answers.each_ref().map(|(steps, answer)| (*steps, compare(&loaded, answer).error));
        let mut graded = Graded { diagnosis, ..Graded::without_answer(&loaded) };
        graded.set_orders(errors.into(), &loaded, order);
        let ladder = answers.iter().zip(errors).map(|((steps, answer), (_, error))| (*steps, error, answer));
        name(&mut graded, &loaded, order, ladder);
        graded.diagnosis
    };
    let slip = &SLIPS.iter().find(|(name, _)| name.ends_with("k3 from k1, not k2")).unwrap().1;
    let midpoint = weighted([0.0, 1.0, 0.0, 0.0]);
    let said = "this is the curve of RK4 with k3 from k1, not k2, to 2e-16 by 128 steps";
    assert_eq!(named(slip, Some(4.0), None).as_deref(), Some(said));
    assert_eq!(named(slip, None, None).as_deref(), Some(said));
    assert!(named(&midpoint, Some(4.0), None).unwrap().contains("the midpoint method"));
    for (stages, order) in [(&midpoint, None), (&midpoint, Some(2.0)), (slip, Some(2.0)), (&RIGHT, Some(4.0))] {
        assert_eq!(named(stages, order, None), None);
    }
    assert_eq!(named(slip, Some(4.0), Some("another".into())).as_deref(), Some("another"));
}

type Rate = dyn Fn(Vector3<f64>) -> Vector3<f64>;
type Step = fn(&Rate, Vector3<f64>, f64) -> Vector3<f64>;

/// RK4's step from its stages.
fn sum(p: Vector3<f64>, h: f64, [k1, k2, k3, k4]: [Vector3<f64>; 4]) -> Vector3<f64> {
    p + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0)
}

/// RK4's stages with other weights.
fn weighted_by(f: &Rate, p: Vector3<f64>, h: f64, weights: [f64; 4]) -> Vector3<f64> {
    let k1 = f(p);
    let k2 = f(p + k1 * (h / 2.0));
    let k3 = f(p + k2 * (h / 2.0));
    let k4 = f(p + k3 * h);
    p + (k1 * weights[0] + k2 * weights[1] + k3 * weights[2] + k4 * weights[3]) * (h / weights.iter().sum::<f64>())
}

/// The steps as codes write them, apart from the table above.
#[rustfmt::skip]
const WRITTEN_OUT: [(&str, Step); 29] = [
    ("RK4 with k2 a whole step ahead, not half", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * h); let k3 = f(p + k2 * (h / 2.0)); let k4 = f(p + k3 * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k2 = k1", |f, p, h| {
        let k1 = f(p); let k2 = f(p); let k3 = f(p + k2 * (h / 2.0)); let k4 = f(p + k3 * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k3 a whole step ahead, not half", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 2.0)); let k3 = f(p + k2 * h); let k4 = f(p + k3 * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k3 from k1, not k2", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 2.0)); let k3 = f(p + k1 * (h / 2.0)); let k4 = f(p + k3 * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k3 = k1", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 2.0)); let k3 = f(p); let k4 = f(p + k3 * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k4 half a step ahead, not a whole one", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 2.0)); let k3 = f(p + k2 * (h / 2.0)); let k4 = f(p + k3 * (h / 2.0));
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k4 from k2, not k3", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 2.0)); let k3 = f(p + k2 * (h / 2.0)); let k4 = f(p + k2 * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k4 from k1, not k3", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 2.0)); let k3 = f(p + k2 * (h / 2.0)); let k4 = f(p + k1 * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k4 = k1, or with k1 twice and no k4", |f, p, h| weighted_by(f, p, h, [2.0, 2.0, 2.0, 0.0])),
    ("RK4 with k2 and k3 a whole step ahead", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * h); let k3 = f(p + k2 * h); let k4 = f(p + k3 * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with the weights 1, 1, 1, 1", |f, p, h| weighted_by(f, p, h, [1.0, 1.0, 1.0, 1.0])),
    ("RK4 with the weights 1, 2, 1, 2", |f, p, h| weighted_by(f, p, h, [1.0, 2.0, 1.0, 2.0])),
    ("RK4 with the weights 2, 1, 1, 2", |f, p, h| weighted_by(f, p, h, [2.0, 1.0, 1.0, 2.0])),
    ("RK4 with the weights 2, 1, 2, 1", |f, p, h| weighted_by(f, p, h, [2.0, 1.0, 2.0, 1.0])),
    ("RK4 with the weights 1, 3, 3, 1", |f, p, h| weighted_by(f, p, h, [1.0, 3.0, 3.0, 1.0])),
    ("RK4 with the weights 1, 1, 2, 2", |f, p, h| weighted_by(f, p, h, [1.0, 1.0, 2.0, 2.0])),
    ("RK4 with the weights 1, 0, 4, 1", |f, p, h| weighted_by(f, p, h, [1.0, 0.0, 4.0, 1.0])),
    ("RK4 with k3 for k4 in the sum", |f, p, h| weighted_by(f, p, h, [1.0, 2.0, 3.0, 0.0])),
    ("RK4 with k4 alone in the sum", |f, p, h| weighted_by(f, p, h, [0.0, 0.0, 0.0, 1.0])),
    ("RK4 with each stage from the one before", |f, p, h| {
        let (k1, mut at) = (f(p), p);
        at += k1 * (h / 2.0); let k2 = f(at); at += k2 * (h / 2.0); let k3 = f(at); at += k3 * h; let k4 = f(at);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k2 a third of a step ahead", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 3.0)); let k3 = f(p + k2 * (h / 2.0)); let k4 = f(p + k3 * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with the stages of the 3/8 rule", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 3.0));
        let k3 = f(p + (k2 - k1 / 3.0) * h); let k4 = f(p + (k1 - k2 + k3) * h);
        sum(p, h, [k1, k2, k3, k4])
    }),
    ("RK4 with k2 twice and k3 not at all", |f, p, h| weighted_by(f, p, h, [1.0, 4.0, 0.0, 1.0])),
    ("Kutta's method of order 3", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 2.0)); let k3 = f(p + (k2 * 2.0 - k1) * h);
        p + (k1 + k2 * 4.0 + k3) * (h / 6.0)
    }),
    ("Heun's method of order 3", |f, p, h| {
        let k1 = f(p); let k2 = f(p + k1 * (h / 3.0)); let k3 = f(p + k2 * (2.0 * h / 3.0));
        p + (k1 + k3 * 3.0) * (h / 4.0)
    }),
    ("SSPRK3", |f, p, h| {
        let first = p + f(p) * h; let second = p * 0.75 + (first + f(first) * h) * 0.25;
        p / 3.0 + (second + f(second) * h) * (2.0 / 3.0)
    }),
    ("Euler's method", |f, p, h| p + f(p) * h),
    ("the midpoint method", |f, p, h| p + f(p + f(p) * (h / 2.0)) * h),
    ("Heun's method of order 2", |f, p, h| { let k1 = f(p); p + (k1 + f(p + k1 * h)) * (h / 2.0) }),
];

/// The table has the steps that its names say.
#[test]
fn a_slip_is_what_its_name_says() {
    let a = Matrix3::new(0.1, -0.02, 0.03, 0.48, -0.25, 0.2, -0.1, 0.3, 0.15);
    let rate = move |p: Vector3<f64>| a * p - p * p.dot(&(a * p));
    let start = Vector3::new(0.36, 0.48, 0.8);
    let times = Times::new(&[0.8], 4);
    for ((name, stages), (written, step)) in SLIPS.iter().zip(&WRITTEN_OUT) {
        let due = (0..4).fold(start, |p, _| step(&rate, p, 0.2));
        let found = times.states(stages, start, &rate, &|p| p)[0];
        assert_eq!(name, written);
        assert!((found - due).norm() < 1e-14, "{name}: {found} {due}");
    }
}
