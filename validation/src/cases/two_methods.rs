//! What is called certified, exact or closed: each number by a second method that shares nothing with the first but
//! what is said.
//!
//! The first values are those that are shipped, or that the program prints. `bash docs/numbers.sh` writes the table of
//! the verification guide from the evidence of this case.

use super::*;
use crate::methods::tensors;
use crate::oracle::isotropic::mean_projections_polydisperse;
use crate::oracle::reference::big::{Big, Bits, decimal, double, length};
use crate::oracle::reference::isotropic::Covariance;
use crate::oracle::reference::motion::{Motion, Unit};
use crate::oracle::reference::second;
use crate::oracle::spheroid::stress_coefficients;
use crate::oracle::{angle_grid, diffusion};
use crate::serve::problems::{self, Built};
use std::sync::LazyLock;

const BITS: Bits = Bits(160);

struct Compared {
    what: &'static str,
    /// The largest difference: one unit of the last digit that is claimed, or the accuracy of the second method.
    most: f64,
    /// The reason for it, and what the methods share.
    because: &'static str,
    pairs: Vec<(Big, Big)>,
}

/// A quantity whose certified numbers are off, and by how much: a control.
type Wrong = Option<(&'static str, f64)>;

const ROD: &str = "p of a rod: exponential of At, and Taylor's series of ṗ itself";
const ISOTROPIC: &str = "means of isotropic rods: an integral over ln x, and a sum over their starts";
const UNEQUAL: &str = "means of unequal rods: trapezoid rule, and Carlson's integrals in panels";
const FINE: &str = "means of unequal rods in many digits: trapezoid rule, and double-exponential rule";
const DIFFUSING: &str = "a_ij of diffusing rods in time: harmonics, and a grid of angles";
const FOURTH: &str = "a_ijkl of diffusing rods in time: harmonics, and a grid of angles";
const STEADY: &str = "steady a_ij of diffusing rods: elimination by degree, and a grid of angles";
const CLOSED: &str = "closed equations: Runge–Kutta in the laboratory's axes, and Gragg's rule in those of a";
const CONTACT: &str = "ṗ′ in contact: A.7 to A.12, and the rule's two demands solved for the changes";
const STRESS: &str = "coefficients of the stress: integrals over u, and over ln λ";

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Oracle, "two-methods")
            .claim(
                "Every number that is called certified is found by two methods that share nothing but what is said, \
                 to its last digit.",
            )
            .source("eqs 4, 11, 12, A.1–A.12; Jeffery 1922; Folgar & Tucker 1984")
            .under_test(None)
            .mistakes([
                ("the 23rd digit of a rod", Some((ROD, 3e-23))),
                ("the 21st digit of isotropic rods", Some((ISOTROPIC, 3e-21))),
                ("the 11th digit of unequal rods", Some((UNEQUAL, 1e-11))),
                ("the 10th digit of rods that diffuse", Some((DIFFUSING, 1e-10))),
                ("the 10th digit of their a_ijkl", Some((FOURTH, 1e-10))),
                ("the 10th digit of steady ones", Some((STEADY, 1e-10))),
                ("the 11th digit of closed equations", Some((CLOSED, 1e-11))),
                ("the 22nd digit of a contact", Some((CONTACT, 1e-21))),
                ("the 12th digit of a coefficient", Some((STRESS, 1e-11))),
            ])
            .check(check),
    ]
}

fn check(wrong: &Wrong, effort: &Effort) -> Vec<Evidence> {
    static QUICK: LazyLock<Vec<Compared>> = LazyLock::new(|| compared(false));
    static FULL: LazyLock<Vec<Compared>> = LazyLock::new(|| compared(true));
    let all = effort.pick(&QUICK, &FULL);
    let evidence = |one: &Compared| {
        let off = |(first, second): &(Big, Big)| match wrong {
            Some((what, by)) if *what == one.what => double(&(first + BITS.of(*by) - second)).abs(),
            _ => double(&(first - second)).abs(),
        };
        Evidence::on(one.what, if one.what == CONTACT { "1/s" } else { "–" })
            .within(worst(one.pairs.iter().map(off)), one.most)
            .because(one.because)
    };
    all.iter().map(evidence).collect()
}

fn compared(full: bool) -> Vec<Compared> {
    type Part = (&'static str, f64, &'static str, fn(bool) -> Vec<(Big, Big)>);
    let parts: [Part; 10] = [
        (ROD, 1e-24, "25 digits; arithmetic is shared", rods),
        (ISOTROPIC, 1e-21, "22 digits; F and arithmetic are shared", isotropic),
        (UNEQUAL, 4e-12, "eleven decimals; the Gaussian is shared", |_| unequal()),
        (DIFFUSING, 5e-12, "eleven decimals; nothing shared", |full| diffusing(full, 6)),
        (FOURTH, 5e-12, "eleven decimals; nothing shared", |full| diffusing(full, 15)),
        (STEADY, 5e-12, "eleven decimals; nothing shared", steady),
        (CLOSED, 1e-12, "twelve decimals; coefficients of fits are shared", closed),
        (CONTACT, 1e-22, "22 digits; arithmetic is shared", contacts),
        (STRESS, 1e-12, "rounding; Jeffery's integrals are shared", |_| stress()),
        (FINE, 1e-21, "22 digits; means at one r_e are shared", |_| fine()),
    ];
    let asked = parts.into_par_iter().filter(|(what, ..)| full || *what != FINE);
    asked.map(|(what, most, because, pairs)| Compared { what, most, because, pairs: pairs(full) }).collect()
}

fn named(name: &str) -> &'static Built {
    problems::named(name).expect("a problem of this program")
}

/// The certified values of the row `at`, keys left out.
fn row(built: &Built, at: usize) -> Vec<Big> {
    let keys = built.problem.kind.keys().len();
    built.certified[at][keys..].iter().map(|text| decimal(text).expect("a certified number")).collect()
}

fn rods(full: bool) -> Vec<(Big, Big)> {
    let names: &[_] = if !full {
        &["mid-flip-2", "spiral", "turning-axes-5"]
    } else {
        &[
            "mid-flip-2",
            "mid-flip-11.6",
            "disc-0.1",
            "sphere",
            "planar-extension",
            "couette-turned",
            "spiral",
            "turning-axes-5",
        ]
    };
    let of = |name: &&str| {
        let (built, mut pairs) = (named(name), Vec::new());
        let problem = &built.problem;
        for (at, start) in built.start.iter().enumerate().take(if full { 2 } else { 1 }) {
            let start = start.map(|x| BITS.of(x));
            let size = length(&start);
            let start = start.map(|x| x / &size);
            let (l, rotation) = (&problem.gradient_per_s, problem.rotation_rad_per_s.unwrap_or_default());
            let found = second::directions(l, rotation, problem.aspect_ratio, &start, &problem.times_s);
            for (time, p) in found.into_iter().enumerate() {
                pairs.extend(row(built, time * built.start.len() + at).into_iter().zip(p));
            }
        }
        pairs
    };
    names.par_iter().flat_map(of).collect()
}

fn isotropic(full: bool) -> Vec<(Big, Big)> {
    let mut pairs = Vec::new();
    for (name, rows, around, per_unit) in [("isotropic-3", 2, 120, 32), ("isotropic-extension", 2, 160, 40)] {
        let (built, rows) = (named(name), if full { rows } else { 1 });
        let problem = &built.problem;
        let motion = Motion { gradient_per_s: problem.gradient_per_s, aspect_ratio: problem.aspect_ratio };
        for (at, time_s) in problem.times_s.iter().enumerate().take(rows) {
            let time = BITS.of(*time_s);
            let map = motion.map(&time, Unit::Second, BITS).expect("seconds have a meaning in every flow");
            let first = Covariance::at(&motion, &time, Unit::Second).expect("the same");
            let (modulus, moments) = second::isotropic(&map, 1, around, per_unit);
            pairs.push((first.projections()[1].clone(), modulus));
            pairs.extend(first.fourth().into_iter().zip(moments[6..].iter().cloned()));
            pairs.extend(row(built, at).into_iter().zip(moments));
        }
    }
    pairs
}

fn unequal() -> Vec<(Big, Big)> {
    let built = named("unequal-rods");
    let (r, sd) = (built.problem.aspect_ratio, built.problem.aspect_ratio_sd_percent);
    let turns = |time_s: &f64| time_s * built.problem.gradient_per_s[1][0] / (std::f64::consts::TAU * (r + 1.0 / r));
    let means = built.problem.times_s.iter().map(|time_s| mean_projections_polydisperse(r, sd, turns(time_s)));
    let pairs = means.enumerate().flat_map(|(at, means)| row(built, at).into_iter().zip(means.map(|x| BITS.of(x))));
    pairs.collect()
}

fn fine() -> Vec<(Big, Big)> {
    let problem = &named("unequal-rods").problem;
    let rate = problem.gradient_per_s[1][0];
    let means = second::unequal(rate, problem.aspect_ratio, problem.aspect_ratio_sd_percent, problem.times_s[0], 96);
    row(named("unequal-rods"), 0).into_iter().zip(means).collect()
}

/// a_ij and a_ijkl on the grid for a problem, at a time.
fn on_grid(built: &Built, rings: usize, time_s: f64) -> ([f64; 6], [f64; 15]) {
    let (l, r) = (built.problem.gradient_per_s, built.problem.aspect_ratio);
    let strain = |i: usize, j: usize| 0.5 * (l[i][j] + l[j][i]);
    let rate = (0..9).map(|k| 2.0 * strain(k / 3, k % 3).powi(2)).sum::<f64>().sqrt();
    let shape = 1.0 - 2.0 / (1.0 + r * r);
    let diffusivity = built.problem.d_r_per_s.unwrap_or(built.problem.c_i.unwrap_or_default() * rate);
    if built.problem.planar_start {
        return angle_grid::planar_moments(l, shape, diffusivity, rings, time_s);
    }
    if let Some(period_s) = built.problem.oscillation_period_s {
        // Short enough for the polar rings, whose rate is about D_r N⁴/8.
        let step_s = 20.0 / (diffusivity * (rings as f64).powi(4));
        let means = angle_grid::oscillating(l, shape, diffusivity, rings, [period_s, time_s, step_s]);
        return (means.second, means.fourth);
    }
    let means = angle_grid::means(l, shape, diffusivity, rings, time_s).expect("diffusion makes it unique");
    (means.second, means.fourth)
}

/// The problems' names, rings of the grid, and how many of their times.
fn diffusing(full: bool, columns: usize) -> Vec<(Big, Big)> {
    let asked: &[(&str, usize, usize)] = match (columns, full) {
        (6, false) => &[
            ("folgar-tucker-shear-0.1", 32, 2),
            ("folgar-tucker-planar-extension", 48, 3),
            ("brownian-relaxation", 8, 5),
            ("brownian-startup-pe-1", 24, 2),
            ("brownian-disc", 24, 1),
            ("brownian-oscillation", 20, 1),
        ],
        (6, true) => &[
            ("folgar-tucker-shear-0.1", 40, 5),
            ("folgar-tucker-shear-0.0311", 48, 3),
            ("folgar-tucker-planar-extension", 64, 5),
            ("folgar-tucker-uniaxial-extension", 48, 5),
            ("folgar-tucker-discs", 48, 2),
            ("folgar-tucker-mixed", 40, 2),
            ("brownian-relaxation", 8, 5),
            ("brownian-startup-pe-1", 32, 5),
            ("brownian-startup-pe-10", 40, 5),
            ("brownian-startup-pe-100", 56, 2),
            ("brownian-disc", 32, 5),
            ("brownian-oscillation", 24, 3),
        ],
        (_, false) => &[("folgar-tucker-fourth-mixed", 32, 1)],
        (_, true) => &[("folgar-tucker-fourth-mixed", 40, 2)],
    };
    let mut pairs = Vec::new();
    for (name, rings, times) in asked {
        let built = named(name);
        let times_s = &built.problem.times_s[..*times];
        // What is shipped, and what the program computes today.
        let now = built
            .problem
            .distribution(&motion(built), *times, built.problem.oscillation())
            .expect("as when it was shipped");
        for (at, (time_s, now)) in times_s.iter().zip(now).enumerate() {
            let grid = on_grid(built, *rings, *time_s);
            let of = |second: &[f64], fourth: &[f64]| bigs(if columns == 6 { second } else { fourth });
            let due = of(&grid.0, &grid.1);
            pairs.extend(
                row(built, at).into_iter().chain(of(&now.second, &now.fourth)).zip(due.iter().chain(&due).cloned()),
            );
        }
    }
    pairs
}

fn motion(built: &Built) -> diffusion::Motion {
    built.problem.diffusing().expect("a problem of rods that diffuse")
}

fn bigs(values: &[f64]) -> Vec<Big> {
    values.iter().map(|x| BITS.of(*x)).collect()
}

fn steady(full: bool) -> Vec<(Big, Big)> {
    let asked: &[_] = if !full {
        &[("folgar-tucker-steady-mixed", 40)]
    } else {
        &[("folgar-tucker-steady-mixed", 48), ("folgar-tucker-steady-shear-0.01", 64)]
    };
    let pairs = asked.iter().flat_map(|(name, rings)| {
        let due = bigs(&on_grid(named(name), *rings, f64::INFINITY).0);
        let now = diffusion::steady(&motion(named(name))).expect("as when it was shipped").second;
        row(named(name), 0).into_iter().chain(bigs(&now)).zip([due.clone(), due].concat()).collect::<Vec<_>>()
    });
    pairs.collect()
}

fn closed(full: bool) -> Vec<(Big, Big)> {
    let all = problems::all().iter().filter(|def| def.name.starts_with("closed-"));
    let mut pairs = Vec::new();
    for built in all.step_by(if full { 1 } else { 6 }).map(|def| def.built()) {
        let problem = &built.problem;
        let Some(closed) = &problem.closed else { continue };
        let equation = closed.equation(&problem.gradient_per_s, problem.aspect_ratio);
        let solution = tensors::second::at(&equation, &closed.start(), &problem.times_s);
        for (at, a) in solution.iter().enumerate() {
            let values = tensors::fourth::PAIRS.map(|place| BITS.of(a[place]));
            pairs.extend(row(built, at).into_iter().zip(values));
        }
    }
    pairs
}

fn contacts(full: bool) -> Vec<(Big, Big)> {
    let built = named("contact-rule");
    let pairs = built.inputs.iter().enumerate().take(if full { 1000 } else { 50 }).flat_map(|(at, input)| {
        let pair = std::array::from_fn(|k| input[k]);
        let rates = second::contact(built.problem.gradient_per_s[1][0], &pair);
        row(built, at).into_iter().zip(rates.into_iter().flatten())
    });
    pairs.collect()
}

/// Jeffery's integrals over λ itself, by the trapezoid rule in ln λ.
fn stress() -> Vec<(Big, Big)> {
    let mut pairs = Vec::new();
    for r in [0.05, 0.5, 1.0, 2.0, 11.6, 100.0] {
        let over = |f: &dyn Fn(f64) -> f64| {
            const STEP: f64 = 0.05;
            let node = |k: i32| (f64::from(k) * STEP).exp();
            (-800..=800).map(|k| STEP * node(k) * f(node(k))).sum::<f64>()
        };
        let square = r * r;
        let stretched = over(&|x| x / ((1.0 + x).powi(2) * (square + x).powf(1.5)));
        let across = over(&|x| 1.0 / ((1.0 + x).powi(2) * (square + x).powf(1.5)));
        let normal = over(&|x| 1.0 / ((1.0 + x).powi(3) * (square + x).sqrt()));
        let (k_x, k_y, k_z) = (2.0 / (3.0 * r * stretched), 2.0 / (r * (square + 1.0) * across), 1.0 / (r * normal));
        let due = [1.5 * k_x - 2.0 * k_y + 0.5 * k_z, k_y - k_z, k_z];
        let scale = worst(due.map(f64::abs));
        let scaled = |x: f64| BITS.of(x / scale);
        pairs
            .extend(stress_coefficients(r).into_iter().zip(due).map(|(first, second)| (scaled(first), scaled(second))));
    }
    pairs
}
