//! Laws that any solution obeys, over random flows of every class. They need no second solution.
//!
//! `PROPTEST_CASES=10000 cargo test -p shearbed-oracle --release laws` tries as many flows.

use super::*;
use crate::diffusion::frame::Frame;
use crate::diffusion::march::{Accuracy, Read};
use crate::diffusion::solution;
use nalgebra::{Rotation3, SymmetricEigen, Unit, Vector3};
use proptest::prelude::*;

/// Rods in a flow of some class, and a time.
#[derive(Clone, Copy, Debug)]
struct Rods {
    l: Matrix3<f64>,
    aspect_ratio: f64,
    c_i: f64,
    time: f64,
    /// The axis about which every turn leaves the flow unchanged.
    axis: Option<Vector3<f64>>,
}

/// What a solution is taken to be: each law must be broken by some change of it.
type Solve = fn(&Rods) -> Option<Means>;

fn right(rods: &Rods) -> Option<Means> {
    solved(&motion(rods), rods.time)
}

fn solved(motion: &Motion, time: f64) -> Option<Means> {
    at(motion, Start::Isotropic, &[time]).ok().map(|means| means[0])
}

fn motion(rods: &Rods) -> Motion {
    Motion::new(std::array::from_fn(|i| std::array::from_fn(|j| rods.l[(i, j)])), rods.aspect_ratio, rods.c_i)
}

fn turn() -> impl Strategy<Value = Matrix3<f64>> {
    let axis = (-1.0..1.0, -1.0..1.0, 0.1..1.0);
    (axis, 0.0..6.0).prop_map(|((x, y, z), angle)| {
        Rotation3::from_axis_angle(&Unit::new_normalize(Vector3::new(x, y, z)), angle).into_inner()
    })
}

fn flow() -> impl Strategy<Value = (Matrix3<f64>, Option<Vector3<f64>>)> {
    let stretch = |x: f64, y: f64, z: f64| Matrix3::from_diagonal(&Vector3::new(x, y, z));
    let third = Some(Vector3::z());
    let own = prop_oneof![
        Just((Matrix3::new(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0), None)),
        Just((stretch(-0.5, 0.5, 0.0), None)),
        Just((stretch(-0.25, -0.25, 0.5), third)),
        Just((stretch(0.25, 0.25, -0.5), third)),
        (0.0..0.5f64).prop_map(move |x| (stretch(x, 0.5, -0.5 - x), None)),
        (-1.0..1.0f64).prop_map(|x| (Matrix3::new(0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0), None)),
        (0.0..1.0f64).prop_map(move |w| (Matrix3::new(-0.25, -w, 0.0, w, -0.25, 0.0, 0.0, 0.0, 0.5), third)),
        (1e-9..1e-3f64).prop_map(move |x| (
            stretch(-0.5, 0.5, 0.0) + Matrix3::new(0.0, 0.0, 0.0, x, 0.0, 0.0, 0.0, 0.0, 0.0),
            None
        )),
        prop::array::uniform9(-0.5..0.5f64).prop_map(|l| (Matrix3::from_row_slice(&l), None)),
        Just((Matrix3::new(0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0), third)),
        Just((Matrix3::zeros(), third)),
    ];
    // Along each axis of the laboratory as often as along any other.
    let axes = prop_oneof![
        Just(Matrix3::identity()),
        Just(Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0)),
        Just(Matrix3::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0)),
        turn(),
    ];
    (own, axes).prop_map(|((l, axis), axes)| (axes * l * axes.transpose(), axis.map(|axis| axes * axis)))
}

fn rods() -> impl Strategy<Value = Rods> {
    let aspect_ratio = prop_oneof![4 => (-4.6..4.6f64).prop_map(f64::exp), 1 => Just(f64::INFINITY), 1 => Just(1.0)];
    let c_i = (-11.5..2.3f64).prop_map(f64::exp);
    (flow(), aspect_ratio, c_i, 0.3..6.0).prop_map(|((l, axis), aspect_ratio, c_i, time)| {
        // Weak diffusion makes peaks as narrow as the strain, and long to resolve.
        let time = if c_i < 1e-2 { 0.5 * time } else { time };
        Rods { l, aspect_ratio, c_i, time, axis }
    })
}

fn turned(means: &Means, axes: &Matrix3<f64>) -> (Matrix3<f64>, [f64; 15]) {
    let whole: Vec<f64> = (0..81).map(|n| entry(&means.fourth, [n / 27, n / 9 % 3, n / 3 % 3, n % 3])).collect();
    let fourth = QUADRUPLES.map(|q| {
        let weight = |n: usize| {
            axes[(q[0] - 1, n / 27)]
                * axes[(q[1] - 1, n / 9 % 3)]
                * axes[(q[2] - 1, n / 3 % 3)]
                * axes[(q[3] - 1, n % 3)]
        };
        (0..81).map(|n| weight(n) * whole[n]).sum()
    });
    (axes * matrix(means.second) * axes.transpose(), fourth)
}

fn apart(a: &(Matrix3<f64>, [f64; 15]), b: &(Matrix3<f64>, [f64; 15])) -> f64 {
    (a.0 - b.0).amax().max(crate::apart(&a.1, &b.1))
}

fn plain(means: &Means) -> (Matrix3<f64>, [f64; 15]) {
    (matrix(means.second), means.fourth)
}

/// By how much an answer breaks each law, over what its stated error allows: 1 is the most.
fn broken(rods: &Rods, axes: &Matrix3<f64>, solve: Solve) -> Option<Vec<(&'static str, f64)>> {
    let found = solve(rods)?;
    let with = |l: Matrix3<f64>| Rods { l, ..*rods };
    // Two answers differ by the errors of both, and by the rounding of what is done with them.
    let beside = |other: &Means, by: f64| by / (found.error + other.error + 1e-12);
    let mut laws = Vec::new();

    let other = solve(&with(axes * rods.l * axes.transpose()))?;
    laws.push(("turned axes turn the answer", beside(&other, apart(&turned(&found, axes), &plain(&other)))));
    if let Some(axis) = rods.axis {
        let about = Rotation3::from_axis_angle(&Unit::new_normalize(axis), 0.9).into_inner();
        let by = apart(&turned(&found, &about), &plain(&found));
        laws.push(("a flow alike about an axis has an answer alike about it", beside(&found, by)));
    }
    for (law, factor) in [
        ("8 G at t/8 is G at t", 8.0),
        ("2⁻³²⁰ G at 2³²⁰ t is G at t", (-320f64).exp2()),
        ("2³²⁰ G at 2⁻³²⁰ t is G at t", 320f64.exp2()),
    ] {
        let other = solve(&Rods { time: rods.time / factor, ..with(rods.l * factor) })?;
        laws.push((law, beside(&other, apart(&plain(&found), &plain(&other)))));
    }
    // D and Λ both with the other sign.
    let mirrored = Rods { aspect_ratio: rods.aspect_ratio.recip(), ..with(-rods.l.transpose()) };
    if rods.aspect_ratio.is_finite() {
        let other = solve(&mirrored)?;
        laws.push(("discs are rods in −Lᵀ", beside(&other, apart(&plain(&found), &plain(&other)))));
    }
    // ∂⟨f⟩/∂ṗ is ∫ ⟨∇u·δṗ⟩ ds with u = f carried back by s: |∇u| ≤ e^(λs), λ the rate at which directions part at the
    // most; ∂⟨f⟩/∂D_r is ∫ ⟨∇²u⟩ ds, |∇²u| ≤ 8(1 + |ΛD|s)e^(2λs).
    let rates = SymmetricEigen::new((rods.l + rods.l.transpose()) * 0.5).eigenvalues;
    let parting = ((rates.max() - rates.min()) * rods.time).exp();
    let nudge = Matrix3::new(0.3, -0.2, 0.5, 0.1, 0.4, 0.2, -0.6, 0.1, -0.7) * (1e-9 * rods.l.norm());
    let before = motion(rods);
    let nudged = [
        ("a small change of L changes the answer little", with(rods.l + nudge)),
        (
            "a small change of r_e changes the answer little",
            Rods { aspect_ratio: rods.aspect_ratio * (1.0 + 1e-9), ..*rods },
        ),
        ("a small change of C_I changes the answer little", Rods { c_i: rods.c_i * (1.0 + 1e-9), ..*rods }),
    ];
    for (law, nudged) in nudged {
        let (other, after) = (solve(&nudged)?, motion(&nudged));
        let moved = (after.strain - before.strain).norm() + (after.spin - before.spin).norm();
        let spread = (after.diffusivity - before.diffusivity).abs();
        let curved = 8.0 * (1.0 + before.strain.norm() * rods.time) * parting;
        let due = 2.0 * rods.time * parting * (moved + curved * spread);
        laws.push((law, beside(&other, (apart(&plain(&found), &plain(&other)) - due).max(0.0))));
    }
    let other = at(&motion(rods), Start::Isotropic, &[0.4 * rods.time, rods.time]).ok()?[1];
    laws.push(("a stop on the way changes nothing", beside(&other, apart(&plain(&found), &plain(&other)))));

    let second = matrix(found.second);
    let traced = Matrix3::from_fn(|i, j| (0..3).map(|k| entry(&found.fourth, [i, j, k, k])).sum());
    laws.push((
        "the trace is 1, and Σ_k a_ijkk = a_ij",
        beside(&found, (second.trace() - 1.0).abs().max((second - traced).amax())),
    ));
    let least = SymmetricEigen::new(second).eigenvalues.min();
    let squares = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| entry(&found.fourth, [i, i, j, j]));
    laws.push((
        "a is positive, and so is ⟨p_i²p_j²⟩",
        beside(&found, squares.into_iter().fold(-least, |worst, square| worst.max(-square))),
    ));
    // d|a − δ/3|/dt ≤ −6D_r |a − δ/3| + |ΛD|, by the equation of a: turns keep the norm, and |Λ(D·pp + pp·D − 2
    // D:pppp)| ≤ |ΛD|.
    let strain = before.strain.norm();
    let by = (second - Matrix3::identity() / 3.0).norm() - strain / (6.0 * before.diffusivity);
    laws.push(("diffusion keeps a near δ/3", if before.diffusivity > 0.0 { beside(&found, by.max(0.0)) } else { 0.0 }));
    Some(laws)
}

/// Number of flows: some 5 CPU seconds if PROPTEST_CASES is not set.
fn cases() -> u32 {
    std::env::var("PROPTEST_CASES").map_or(48, |count| count.parse().unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn every_answer_obeys_the_laws(rods in rods(), axes in turn()) {
        for (law, by) in broken(&rods, &axes, right).into_iter().flatten() {
            prop_assert!(by <= 1.0, "{law}: {by:e} of what is allowed");
        }
    }
}

#[test]
fn every_law_is_broken_by_a_mistake() {
    let extension = Matrix3::from_diagonal(&Vector3::new(0.5, -0.25, -0.25));
    let discs = Rods { l: extension, aspect_ratio: 0.3, c_i: 0.03, time: 8.0, axis: Some(Vector3::x()) };
    let askew = Rods { l: Matrix3::from_fn(|i, j| ASKEW[i][j]), aspect_ratio: 3.0, c_i: 0.1, time: 2.0, axis: None };
    let diffuse = Rods { c_i: 5.0, ..discs };
    let axes = Rotation3::from_euler_angles(0.4, 1.0, -0.3).into_inner();
    let mistakes: [(&str, Rods, &str, Solve); 11] = [
        ("odd orders alone beyond a size", discs, "a flow alike about an axis has an answer alike about it", |rods| {
            added(rods, [0.0, 1e-9, -1e-9, 0.0, 0.0, 0.0])
        }),
        (
            "an error in flows without spin",
            Rods { time: 2.0, ..discs },
            "a small change of L changes the answer little",
            |rods| added(rods, [if motion(rods).spin.norm() == 0.0 { 1e-6 } else { 0.0 }; 6]),
        ),
        (
            "an error that comes and goes with r",
            Rods { time: 2.0, ..discs },
            "a small change of r_e changes the answer little",
            |rods| added(rods, [if rods.aspect_ratio == 0.3 { 1e-6 } else { 0.0 }; 6]),
        ),
        (
            "an error that comes and goes with C_I",
            Rods { time: 2.0, ..discs },
            "a small change of C_I changes the answer little",
            |rods| added(rods, [if rods.c_i == 0.03 { 1e-6 } else { 0.0 }; 6]),
        ),
        ("the harmonics' axes", askew, "turned axes turn the answer", |rods| {
            let frame = Frame { axes: Matrix3::identity(), ..Frame::of(&motion(rods)) };
            let accuracy = Accuracy { tail: 1e-12, step: 4.0, most: usize::MAX };
            let found = solution(&[(frame, 0.0)], Start::Isotropic, &[rods.time], &Read::Means, accuracy);
            found.ok().map(|means| Means::new(&means[0], 1e-12))
        }),
        ("D_r = C_I", askew, "8 G at t/8 is G at t", |rods| {
            solved(&Motion { diffusivity: rods.c_i, ..motion(rods) }, rods.time)
        }),
        ("Λ = 1 − 1/r", askew, "discs are rods in −Lᵀ", |rods| {
            let needle = motion(&Rods { aspect_ratio: f64::INFINITY, ..*rods });
            solved(&Motion { strain: needle.strain * (1.0 - rods.aspect_ratio.recip()), ..needle }, rods.time)
        }),
        ("a hundredth of the time left out", askew, "a stop on the way changes nothing", |rods| {
            solved(&motion(rods), 0.99 * rods.time)
        }),
        ("a density that is not normalised", askew, "the trace is 1, and Σ_k a_ijkk = a_ij", |rods| {
            added(rods, [1e-10, 0.0, 0.0, 0.0, 0.0, 0.0])
        }),
        ("a mean of another density", discs, "a is positive, and so is ⟨p_i²p_j²⟩", |rods| {
            added(rods, [-0.1, 0.0, 0.0, 0.0, 0.0, 0.0])
        }),
        ("a thirtieth of D_r", diffuse, "diffusion keeps a near δ/3", |rods| {
            let motion = motion(rods);
            solved(&Motion { diffusivity: motion.diffusivity / 30.0, ..motion }, rods.time)
        }),
    ];
    for (name, rods, law, solve) in mistakes {
        let by = |solve| broken(&rods, &axes, solve).unwrap().into_iter().find(|(of, _)| *of == law).unwrap().1;
        assert!(by(right) <= 1.0, "{law}: {}", by(right));
        assert!(by(solve) > 1.0, "{name}: {law}: {}", by(solve));
    }
}

/// The right answer with these errors in a_ij.
fn added(rods: &Rods, errors: [f64; 6]) -> Option<Means> {
    let means = right(rods)?;
    Some(Means { second: std::array::from_fn(|k| means.second[k] + errors[k]), ..means })
}
