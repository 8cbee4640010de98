//! Rods in random flows that aim at difficult cases: eigenvalues that nearly meet, are tiny, huge or equal; planar,
//! spiral and real; rotated in space; rods from 10⁻¹⁰⁰ to 10¹⁰⁰ and near 1; strains from 10⁻¹³ to 10⁶; starts on axes
//! and in planes.

use super::*;
use crate::oracle::exponential::Span;
use rand::Rng;
use rand_pcg::Pcg64;

#[derive(Clone, Copy, Debug)]
pub struct FlowProblem {
    pub rod: Rod,
    pub strain: f64,
    pub truth: [f64; 3],
}

impl FlowProblem {
    pub fn new(rod: Rod, strain: f64) -> Option<Self> {
        let truth = rod.settled(Span::Strain(strain))?;
        Some(Self { rod, strain, truth })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Any,
    /// Long ones that start at or beside the direction that the flow rotates most: there a bound counts.
    Hard,
}

pub fn random(kind: Kind, seed: u64, count: u64) -> Vec<FlowProblem> {
    let one = |index| {
        let mut rng = Pcg64::seed_from_u64(seed.wrapping_add(index));
        std::iter::repeat_with(|| drawn(kind, &mut rng)).flatten().next()
    };
    (0..count).into_par_iter().filter_map(one).collect()
}

/// A random problem; `None` if the oracle has no answer, about once in 10⁵.
fn drawn(kind: Kind, rng: &mut impl Rng) -> Option<FlowProblem> {
    let gradient = loop {
        let gradient = gradient(rng);
        // Without a strain rate, time cannot be measured as strain.
        if (gradient + gradient.transpose()).amax() > 1e-30 * gradient.amax() {
            break gradient;
        }
    };
    let mut rod = Rod {
        gradient_per_s: std::array::from_fn(|i| std::array::from_fn(|j| gradient[(i, j)])),
        aspect_ratio: aspect_ratio(rng),
        p: start(rng),
    };
    let strain = match kind {
        Kind::Any => size(rng, -13.0, 6.0),
        Kind::Hard => size(rng, 0.0, 6.0),
    };
    if kind == Kind::Hard || rng.random_range(0..3) == 0 {
        // From the end backwards: the start that the flow rotates most, where the condition number is largest; and
        // starts at any distance from it, for the condition numbers between.
        let back = Rod { gradient_per_s: rod.gradient_per_s.map(|row| row.map(|x| -x)), ..rod };
        let most = Vector3::from(back.settled(Span::Strain(strain))?);
        let beside = Vector3::from_fn(|_, _| signed(rng)) * size(rng, -17.0, 0.0);
        rod.p = match rng.random_range(0..4) {
            0 => most,
            _ => (most + beside).normalize(),
        }
        .into();
    }
    FlowProblem::new(rod, strain)
}

/// 10 to a power between `least` and `most`.
fn size(rng: &mut impl Rng, least: f64, most: f64) -> f64 {
    10f64.powf(least + (most - least) * rng.random::<f64>())
}

fn signed(rng: &mut impl Rng) -> f64 {
    2.0 * rng.random::<f64>() - 1.0
}

fn full(rng: &mut impl Rng) -> Matrix3<f64> {
    Matrix3::from_fn(|_, _| signed(rng))
}

fn aspect_ratio(rng: &mut impl Rng) -> f64 {
    match rng.random_range(0..5) {
        0 => size(rng, -100.0, 100.0),
        1 => size(rng, -8.0, 8.0),
        2 => 1.0 + signed(rng).signum() * size(rng, -15.9, -1.0),
        3 => [1.0, 2.0, 0.5, 11.6, 3.0, 1e-100, 1e100][rng.random_range(0..7)],
        _ => size(rng, 0.0, 3.0),
    }
}

fn start(rng: &mut impl Rng) -> [f64; 3] {
    let mut p = [(); 3].map(|()| signed(rng));
    match rng.random_range(0..8) {
        0 => p[rng.random_range(0..3)] = 0.0,
        1 => {
            let axis = rng.random_range(0..3);
            p = std::array::from_fn(|k| f64::from(u8::from(k == axis)));
        }
        2 => p[rng.random_range(0..3)] *= size(rng, -20.0, 0.0),
        _ => {}
    }
    Vector3::from(p).normalize().into()
}

fn gradient(rng: &mut impl Rng) -> Matrix3<f64> {
    let mut l = match rng.random_range(0..9) {
        0 => full(rng),
        1 => Matrix3::from_fn(|_, _| f64::from(rng.random_range(-3i32..=3))),
        2 => spiral(rng),
        3 => real(rng),
        4 => planar(rng),
        5 => {
            // Near-parabolic.
            let e = size(rng, -17.0, 0.0);
            couette() + full(rng) * e
        }
        6 => couette(),
        7 => Matrix3::from_fn(|_, _| signed(rng).signum() * size(rng, -20.0, 20.0)),
        _ => {
            let mut l = full(rng);
            for _ in 0..rng.random_range(1..7) {
                l[(rng.random_range(0..3), rng.random_range(0..3))] = 0.0;
            }
            l
        }
    };
    if rng.random_range(0..2) == 0 {
        l = turned(rng, l);
    }
    if rng.random_range(0..8) == 0 {
        l += Matrix3::identity() * signed(rng);
    }
    if rng.random_range(0..6) == 0 {
        l *= size(rng, -250.0, 250.0);
    }
    l
}

fn couette() -> Matrix3<f64> {
    Matrix3::new(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
}

/// A flow rotated in space: at random with rounding, by exchanged axes, or by 45°, where Couette flow's halves are
/// exact in binary.
fn turned(rng: &mut impl Rng, l: Matrix3<f64>) -> Matrix3<f64> {
    let any = Rotation3::new(Vector3::from_fn(|_, _| 3.0 * signed(rng))).into_inner();
    let turn = match rng.random_range(0..4) {
        0 => Matrix3::new(0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0),
        1 => {
            // √2 times a rotation by 45°, applied from both sides: exact.
            let doubled = Matrix3::new(1.0, -1.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0);
            let back = Matrix3::new(0.5, 0.5, 0.0, -0.5, 0.5, 0.0, 0.0, 0.0, 1.0);
            return doubled * l * back;
        }
        _ => any,
    };
    turn * l * turn.transpose()
}

/// A swirl and an extension along its axis, with a ratio of 10⁻¹⁶ to 10¹⁶.
fn spiral(rng: &mut impl Rng) -> Matrix3<f64> {
    let ratio = size(rng, -16.0, 16.0);
    let (swirl, e) = if ratio > 1.0 { (1.0, 1.0 / ratio) } else { (ratio, 1.0) };
    let e = e * signed(rng).signum();
    Matrix3::new(-0.5 * e, -swirl, 0.0, swirl, -0.5 * e, 0.0, 0.0, 0.0, e)
}

/// Three real rates, two of which nearly meet.
fn real(rng: &mut impl Rng) -> Matrix3<f64> {
    let (a, gap) = (signed(rng), size(rng, -17.0, 0.0));
    let coupled = if rng.random_range(0..2) == 0 { 0.0 } else { signed(rng) };
    Matrix3::new(a + gap, coupled, 0.0, 0.0, a, 0.0, 0.0, 0.0, -2.0 * a)
}

/// Planar flows from rotation through shear to extension.
fn planar(rng: &mut impl Rng) -> Matrix3<f64> {
    let back = signed(rng).signum() * size(rng, -17.0, 0.0);
    Matrix3::new(0.0, if rng.random_range(0..2) == 0 { back } else { back - 1.0 }, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
}
