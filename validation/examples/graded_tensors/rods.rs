//! Codes for single rods, right or wrong in one part.

use super::{Row, Rows, graded};
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use shearbed_validation::methods::integrators::rk4;
use shearbed_validation::methods::textbook::{jeffery_rate, rk4_in_p};
use shearbed_validation::serve::grade::Verdict;
use shearbed_validation::serve::problems::{self, LoadedProblem};
use std::array::from_fn;
use std::f64::consts::PI;

type V = [f64; 3];
type M = [V; 3];

/// The parts of a code; [`RIGHT`] has the right ones.
#[derive(Clone)]
struct Code {
    gradient: fn(&M) -> M,
    /// Λ from r_e.
    shape: fn(f64) -> f64,
    /// Before W and before ΛD.
    parts: [f64; 2],
    /// The factor on θ̇, from p_3.
    tilt: Option<fn(f64) -> f64>,
    /// The time for a time, from r_e.
    time: fn(f64) -> f64,
    start: fn(V) -> V,
    end: fn(V) -> V,
    /// Which of `n` rods is written as rod k.
    order: fn(usize, usize) -> usize,
}

const RIGHT: Code = Code {
    gradient: |l| *l,
    shape: |r| (r * r - 1.0) / (r * r + 1.0),
    parts: [1.0, 1.0],
    tilt: None,
    time: |_| 1.0,
    start: |p| p,
    end: |p| p,
    order: |k, _| k,
};

fn of_ratio(r: f64) -> f64 {
    (RIGHT.shape)(r)
}

fn front([x, y, z]: V) -> V {
    if x < 0.0 { [-x, -y, z] } else { [x, y, z] }
}

fn axes(l: &M, [a, b, c]: [usize; 3]) -> M {
    [a, b, c].map(|i| [l[i][a], l[i][b], l[i][c]])
}

/// A wrong code: its name, what must be said of it, and the mistake.
type Wrong = (&'static str, &'static str, fn(&mut Code));

#[rustfmt::skip]
const WRONG: &[Wrong] = &[
    ("L transposed", "a transposed gradient", |c| c.gradient = |l| from_fn(|i| from_fn(|j| l[j][i]))),
    ("L reversed", "the flow reversed", |c| c.gradient = |l| l.map(|row| row.map(|x| -x))),
    ("L halved", "half the shear rate", |c| c.gradient = |l| l.map(|row| row.map(|x| 0.5 * x))),
    ("flow along 1", "one of them in flow,gradient,vorticity", |c| c.gradient = |l| axes(l, [1, 0, 2])),
    ("vorticity along 1", "one of them in vorticity,flow,gradient", |c| c.gradient = |l| axes(l, [2, 1, 0])),
    ("vorticity along 2", "one of them in gradient,vorticity,flow", |c| c.gradient = |l| axes(l, [0, 2, 1])),
    ("cyclic", "one of them in flow,vorticity,gradient", |c| c.gradient = |l| axes(l, [1, 2, 0])),
    ("cyclic the other way", "one of them in vorticity,gradient,flow", |c| c.gradient = |l| axes(l, [2, 0, 1])),
    ("no W", "W left out", |c| c.parts[0] = 0.0),
    ("W without ½", "W without its ½", |c| c.parts[0] = 2.0),
    ("W halved", "W halved twice", |c| c.parts[0] = 0.5),
    ("D without ½", "D without its ½", |c| c.parts[1] = 2.0),
    ("D halved", "D halved twice", |c| c.parts[1] = 0.5),
    ("Λ = 0", "Λ = 0", |c| c.shape = |_| 0.0),
    ("Λ = 1", "no 1/r_e", |c| c.shape = |_| 1.0),
    ("Λ's sign", "Λ with the wrong sign", |c| c.shape = |r| -of_ratio(r)),
    ("|Λ|", "Λ without its sign", |c| c.shape = |r| of_ratio(r).abs()),
    ("Cox", "r_e taken as r_p of Cox 1971", |c| {
        c.shape = |r| of_ratio(if r > 1.0 { 1.24 * r / r.ln().sqrt() } else { r });
    }),
    ("(r − 1)/(r + 1)", "(r_e − 1)/(r_e + 1) for Λ", |c| c.shape = |r| (r - 1.0) / (r + 1.0)),
    ("1/Λ", "1/Λ for Λ", |c| c.shape = |r| if r == 1.0 { 0.0 } else { 1.0 / of_ratio(r) }),
    ("eccentricity", "the eccentricity", |c| c.shape = |r| (1.0 - 1.0 / (r * r)).sqrt()),
    ("twice r_e", "twice the r_e", |c| c.shape = |r| of_ratio(2.0 * r)),
    ("half lengths", "half the r_e", |c| c.shape = |r| of_ratio(0.5 * r)),
    ("r_e²", "r_e² for r_e", |c| c.shape = |r| of_ratio(r * r)),
    ("1.13 r_e", "your r_e is 1.130 times what is asked", |c| c.shape = |r| of_ratio(1.13 * r)),
    ("r_e of one rod", "your r_e is 10.000 in every problem", |c| c.shape = |_| of_ratio(10.0)),
    ("r_e^0.7", "your r_e is the power 0.700 of what is asked", |c| c.shape = |r| of_ratio(r.powf(0.7))),
    ("0.95 Λ", "your Λ is 0.950 times", |c| c.shape = |r| 0.95 * of_ratio(r)),
    ("a slow clock", "your time runs at 0.970 of the true one", |c| c.time = |_| 0.97),
    ("π of six digits", "(π taken as 3.14159?)", |c| c.time = |_| PI / ((1e5 * PI).trunc() / 1e5)),
    ("2 θ̇", "twice the θ̇", |c| c.tilt = Some(|_| 2.0)),
    ("θ̇/2", "half the θ̇", |c| c.tilt = Some(|_| 0.5)),
    ("−θ̇", "θ̇ with the wrong sign", |c| c.tilt = Some(|_| -1.0)),
    ("sin θ", "sin θ for sin 2θ in θ̇", |c| c.tilt = Some(|z| 0.5 / z)),
    ("atan", "atan for atan2", |c| c.end = front),
    ("atan at the start", "atan for atan2", |c| c.start = front),
    ("rods reversed", "the rods in another order", |c| c.order = |k, n| n - 1 - k),
    ("rods shifted", "the rods in another order", |c| c.order = |k, n| (k + 1) % n),
    ("p_1 and p_2", "p_1 and p_2 exchanged", |c| c.end = |[x, y, z]| [y, x, z]),
    ("cyclic p", "components in the order p_2, p_3, p_1", |c| c.end = |[x, y, z]| [y, z, x]),
    ("left-handed", "axis 3 reversed", |c| c.end = |[x, y, z]| [x, y, -z]),
    ("length", "only the directions' length is wrong", |c| c.end = |p| p.map(|x| 1.01 * x)),
];

/// ṗ with another factor on θ̇, from p_3.
fn tilted(a: &Matrix3<f64>, p: Vector3<f64>, tilt: fn(f64) -> f64) -> Vector3<f64> {
    let (free, plane) = (jeffery_rate(a, p), p.x.hypot(p.y));
    if plane == 0.0 {
        return free;
    }
    let across = Vector3::new(p.x * p.z / plane, p.y * p.z / plane, -plane);
    free + across * across.dot(&free) * (tilt(p.z) - 1.0)
}

impl Code {
    /// The rows of an answer, by RK4 in steps of `strain`.
    fn answer(&self, loaded: &LoadedProblem, strain: f64) -> Rows {
        let (problem, r) = (&loaded.problem, loaded.problem.aspect_ratio);
        let l = Matrix3::from((self.gradient)(&problem.gradient_per_s)).transpose();
        let [turning, stretching] = [0.5 * self.parts[0], 0.5 * self.parts[1] * (self.shape)(r)];
        let a = turning * (l - l.transpose()) + stretching * (l + l.transpose());
        let step = |p: Vector3<f64>, h: f64| match self.tilt {
            None => rk4_in_p(&a, p, h, 1),
            Some(tilt) => rk4(|p| tilted(&a, p, tilt), p, h),
        };
        let mut rods: Vec<_> = loaded.start.iter().map(|p| Vector3::from((self.start)(*p))).collect();
        let (mut rows, mut now) = (Vec::new(), 0.0);
        for time in problem.times_s.iter().map(|time| time * (self.time)(r)) {
            let steps = ((time - now) * l.norm() / strain).ceil();
            let h = (time - now) / steps;
            for p in &mut rods {
                *p = (0..steps as usize).fold(*p, |p, _| step(p, h).normalize());
            }
            now = time;
            rows.extend((0..rods.len()).map(|k| (self.end)(rods[(self.order)(k, rods.len())].into()).to_vec()));
        }
        rows
    }

    fn answers(&self, problems: &[LoadedProblem], strain: f64) -> Vec<Rows> {
        problems.iter().map(|loaded| self.answer(loaded, strain)).collect()
    }
}

/// Problems with steps of a strain in moments.
fn problems() -> Vec<LoadedProblem> {
    let long = ["mid-flip-100", "mid-flip-10000", "ten-thousand-periods"];
    let names = problems::free_rods().into_iter().filter(|name| !long.contains(name));
    names.map(|name| problems::named(name).expect("a problem").loaded(name.into())).collect()
}

/// What is said of a wrong code: as one answer, named right if nothing else is said anywhere.
fn judged(problems: &[LoadedProblem], (name, expected, spoil): &Wrong) -> Row {
    let mut code = RIGHT;
    spoil(&mut code);
    let (graded, mut said) = graded(problems, &code.answers(problems, 0.01));
    let caught = graded.iter().any(|graded| graded.verdict == Verdict::Fail);
    said.extend(graded.iter().filter_map(|graded| Some(format!("{}: {}", graded.name, graded.diagnosis.as_ref()?))));
    let own = |said: &&String| said.contains(expected) || said.contains("nothing has moved");
    let named = usize::from(said.iter().any(|said| said.contains(expected)) && said.iter().all(|said| own(&said)));
    said.retain(|said| !own(&said));
    said.extend((!caught).then(|| format!("{name} passes")));
    Row { name, on: "rods", wrong: 1, named, said }
}

pub fn all(only: &str) -> Vec<Row> {
    let problems = problems();
    WRONG.par_iter().filter(|(name, ..)| name.contains(only)).map(|wrong| judged(&problems, wrong)).collect()
}

#[test]
fn right_rods_pass_and_wrong_ones_are_caught_and_named() {
    let problems = problems();
    let (graded, overall) = graded(&problems, &RIGHT.answers(&problems, 0.002));
    assert!(graded.iter().all(|graded| graded.verdict == Verdict::Pass), "{graded:#?}");
    assert_eq!(overall, [""; 0]);
    for Row { name, named, said, .. } in all("") {
        assert!(named == 1 && said.is_empty(), "{name}: {said:#?}");
    }
}
