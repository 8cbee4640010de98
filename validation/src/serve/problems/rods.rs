//! Problems of given free rods.

use super::asked::{Asked, direction};
use super::flows::{extension, mirrored, spiral, turned, turning};
use super::{Built, Kind, Problem, ProblemDef, tolerance};
use crate::oracle::reference::big::{Bits, digits};
use crate::oracle::reference::motion::{Motion, Unit, image};
use crate::oracle::reference::rod::{self, Direction};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};

/// Significant digits of a certified number: eight more than a double holds.
const DIGITS: usize = 25;

pub(super) fn problems() -> Vec<ProblemDef> {
    type Row = (&'static str, &'static str, fn() -> Asked);
    const PROBLEMS: &[Row] = &[
        ("mid-flip-2", "A short rod, r_e = 2, seen during three flips", || mid_flip(2.0)),
        ("mid-flip-11.6", "The paper's rod, r_e = 11.6, seen during three flips", || mid_flip(11.6)),
        ("mid-flip-100", "A long rod, r_e = 100, seen during three flips", || mid_flip(100.0)),
        ("mid-flip-10000", "A fibre, r_e = 10⁴, seen during three flips", || mid_flip(1e4)),
        ("disc-0.1", "A disc, r_e = 0.1, seen in three of its turns", || mid_flip(0.1)),
        ("sphere", "A sphere, r_e = 1, turns at G/2", || mid_flip(1.0)),
        ("log-rolling", "A rod along the vorticity axis stays there", log_rolling),
        ("shear-plane", "Rods in the shear plane stay in it", shear_plane),
        ("poles", "Rods at and beside both poles of (φ, θ)", poles),
        ("ten-thousand-periods", "A rod after 1 to 10⁴ periods", long),
        ("planar-extension", "Rods in planar extension turn to the stretched axis", || {
            extension([1.0, -1.0, 0.0], "planar extension, u_1 = x_1, u_2 = -x_2")
        }),
        ("uniaxial-extension", "Rods in uniaxial extension turn to the stretched axis", || {
            extension([-0.5, -0.5, 1.0], "uniaxial extension along axis 3")
        }),
        ("couette-turned", "Plane Couette flow turned in space", turned),
        ("couette-mirrored", "Plane Couette flow with gradient and flow exchanged", mirrored),
        ("spiral", "A general gradient: rods spiral into an axis", spiral),
        ("turning-axes-5", "Plane Couette flow seen from axes that turn: L changes in time", turning),
    ];
    PROBLEMS.iter().map(|(name, title, asked)| ProblemDef::new(name, title, |def| built(def, asked()))).collect()
}

fn built(def: &ProblemDef, asked: Asked) -> Built {
    let motion = Motion { gradient_per_s: asked.gradient_per_s, aspect_ratio: asked.aspect_ratio };
    let end_s = asked.times_s.last().copied().unwrap_or_default();
    let rotation = Vector3::from(asked.rotation_rad_per_s.unwrap_or_default());
    // W = S and D = 0: its motion is Q.
    let turn = Motion { gradient_per_s: rows(rotation.cross_matrix()), aspect_ratio: 1.0 };
    let (tolerance, because, equations) = match motion.couette().filter(|_| asked.rotation_rad_per_s.is_none()) {
        Some(rate) => (
            tolerance::couette(asked.aspect_ratio, rate * end_s),
            tolerance::because_couette(asked.aspect_ratio),
            COUETTE_EQUATIONS,
        ),
        None => {
            let tolerance = tolerance::general(&motion, rotation.norm(), &asked.start, end_s);
            let equations = if rotation == Vector3::zeros() { &ANY_FLOW[..1] } else { ANY_FLOW };
            (tolerance, tolerance::BECAUSE_GENERAL.to_owned(), equations)
        }
    };
    let all = asked.times_s.iter().flat_map(|time| (0..).zip(&asked.start).map(move |rod| (*time, rod)));
    let certified = all.map(|(time, (rod, start))| certified(&motion, &turn, time, rod, *start)).collect();
    let problem = Problem {
        summary: asked.summary,
        gradient_per_s: asked.gradient_per_s,
        rotation_rad_per_s: asked.rotation_rad_per_s,
        aspect_ratio: asked.aspect_ratio,
        times_s: asked.times_s,
        tolerance,
        because,
        equations: equations.iter().map(|text| (*text).to_owned()).collect(),
        ..Problem::new(def, Kind::Rods, &["p1", "p2", "p3"])
    };
    Built { start: asked.start, ..Built::new(problem, certified) }
}

fn rows(matrix: Matrix3<f64>) -> [[f64; 3]; 3] {
    matrix.transpose().into()
}

fn certified(motion: &Motion, turn: &Motion, time_s: f64, rod: usize, start: [f64; 3]) -> Vec<String> {
    let time = Bits(64).of(time_s);
    let at = rod::at(motion, Direction::Vector(start), &time, Unit::Second);
    let turned = turn.map(&time, Unit::Second, turn.bits(time_s, Unit::Second, 128));
    let (at, turned) = at.zip(turned).expect("seconds have a meaning in every flow");
    let mut row = vec![format!("{time_s:?}"), rod.to_string()];
    row.extend(image(&turned, &at.p).iter().map(|x| digits(x, DIGITS)));
    row
}

const COUETTE_EQUATIONS: &[&str] = &[
    "the solution of Jeffery's equation in plane Couette flow, tan φ = r_e tan(2πt/T + const) and tan θ = C r_e/(r_e² \
     cos² φ + sin² φ)^(1/2) (A.4 and A.5 of Lee & Springer 1982)",
    "its period T = 2π(r_e + 1/r_e)/G (eq. 15 of Lee & Springer 1982)",
];

/// The equations behind a rod in any flow.
const ANY_FLOW: &[&str] = &[
    "Jeffery's equation (A.1 of Lee & Springer 1982), solved by p = q/|q|, q = exp((W + ΛD)t) p(0) with W and D the \
     antisymmetric and symmetric parts of the velocity gradient and Λ = (r_e² - 1)/(r_e² + 1)",
    "A.1 of Lee & Springer 1982 in a flow that turns by ω = rotation_rad_per_s: the velocity gradient is \
     L(t) = Q L Qᵀ + S with L = gradient_per_s, S p = ω × p and Q = exp(St) (Q̇Qᵀ = S), the rotation about ω by \
     |ω|t, right-handed. So the flow turns by ω as seen from the axes, and the axes turn by -ω; p(t) = Q \
     times the p of the steady flow L",
];

fn mid_flip(aspect_ratio: f64) -> Asked {
    // The next time at which φ = 1: there both rods and discs turn at more than a quarter of their fastest rate.
    let phase = |phi: f64| (phi.sin() / aspect_ratio).atan2(phi.cos()) / TAU;
    let first = phase(1.0) - phase(0.2);
    let summary = format!(
        "One free rod of r_e = {aspect_ratio} in plane Couette flow, from φ = 0.2, θ = 1 rad. It is asked for in the \
         flip in which it starts, half a period later in the next, and a period later in the one after: near φ = 1 \
         each time, where rods and discs alike turn at more than a quarter of their fastest rate. An error of the \
         phase, or a flip that is stepped over, shows here and not while a long rod lies along the flow, which it does \
         nearly always."
    );
    Asked::couette(aspect_ratio, vec![direction(0.2, 1.0)], &[first, first + 0.5, first + 1.0], &summary)
}

fn log_rolling() -> Asked {
    Asked::couette(
        11.6,
        vec![[0.0, 0.0, 1.0]],
        &[0.25, 0.5, 1.0],
        "One free rod of r_e = 11.6 along the vorticity axis of plane Couette flow. It turns about itself and points \
         where it did. In angles this is the pole θ = 0, where φ has no value and 1/sin θ is infinite.",
    )
}

fn shear_plane() -> Asked {
    Asked::couette(
        11.6,
        vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.8, 0.0], [0.6, -0.8, 0.0]],
        &[0.02, 0.25, 0.51, 1.02],
        "Four free rods of r_e = 11.6 in the shear plane of plane Couette flow: across the flow, along it, and on both \
         sides of it. p_3 stays exactly 0 and the orbit constant is infinite. Between flips the rods lie along the \
         flow; the times are chosen so that each rod is seen in a flip.",
    )
}

fn poles() -> Asked {
    let near = 1e-6;
    let mut start = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    start.extend([0.3, 2.0, 4.4].map(|phi| direction(phi, near)));
    start.extend([0.3, 2.0, 4.4].map(|phi| direction(phi, PI - near)));
    Asked::couette(
        11.6,
        start,
        // After whole periods every rod is back, as would be a rod that never moved; a program that runs is asked at
        // the last time.
        &[0.1, 0.25, 0.6, 1.1],
        "Eight free rods of r_e = 11.6 in plane Couette flow: one at each pole θ = 0 and θ = π of the angles, and \
         three 10⁻⁶ rad beside each. Those at a pole stay, the others go round it on small ellipses. A code in φ and θ \
         divides by sin θ here; nothing is singular in p.",
    )
}

fn long() -> Asked {
    Asked::couette(
        2.0,
        vec![direction(0.2, 1.0)],
        &[1.1, 10.1, 100.1, 1000.1, 10000.1],
        "One free rod of r_e = 2 in plane Couette flow after 1.1, 10.1, 100.1, 1000.1 and 10000.1 periods: how the \
         phase and the orbit drift. The strain is 1.6·10⁵, and RK4 in p needs 60 to 110 steps per unit of strain for \
         the tolerance.",
    )
}
