//! Problems of given free rods.

use super::asked::{AXES, Asked, COUETTE, direction, period_s};
use super::flows::{extension, mirrored, spiral, turned};
use super::{Built, FORMAT, Kind, Metric, Problem, ProblemDef, tolerance};
use crate::oracle::reference::big::{Bits, digits};
use crate::oracle::reference::motion::{Motion, Unit};
use crate::oracle::reference::rod::{self, Direction};
use std::f64::consts::{PI, TAU};

/// Significant digits of a certified number: eight more than a double holds.
const DIGITS: usize = 25;

pub(super) fn problems() -> Vec<ProblemDef> {
    let mid_flip = |name: &'static str, title: &'static str, aspect_ratio: f64| {
        ProblemDef::new(name, title, move |def| built(def, mid_flip(aspect_ratio)))
    };
    vec![
        mid_flip("mid-flip-2", "A short rod, r_e = 2, seen during three flips", 2.0),
        mid_flip("mid-flip-11.6", "The paper's rod, r_e = 11.6, seen during three flips", 11.6),
        mid_flip("mid-flip-100", "A long rod, r_e = 100, seen during three flips", 100.0),
        mid_flip("mid-flip-10000", "A fibre, r_e = 10⁴, seen during three flips", 1e4),
        mid_flip("disc-0.1", "A disc, r_e = 0.1, seen in three of its turns", 0.1),
        mid_flip("sphere", "A sphere, r_e = 1, turns at G/2", 1.0),
        ProblemDef::new("log-rolling", "A rod along the vorticity axis stays there", |def| built(def, log_rolling())),
        ProblemDef::new("shear-plane", "Rods in the shear plane stay in it", |def| built(def, shear_plane())),
        ProblemDef::new("poles", "Rods at and beside both poles of (φ, θ)", |def| built(def, poles())),
        ProblemDef::new("ten-thousand-periods", "A rod after 1 to 10⁴ periods", |def| built(def, long())),
        ProblemDef::new("planar-extension", "Rods in planar extension turn to the stretched axis", |def| {
            built(def, extension([1.0, -1.0, 0.0], "planar extension, u_1 = x_1, u_2 = -x_2"))
        }),
        ProblemDef::new("uniaxial-extension", "Rods in uniaxial extension turn to the stretched axis", |def| {
            built(def, extension([-0.5, -0.5, 1.0], "uniaxial extension along axis 3"))
        }),
        ProblemDef::new("couette-turned", "Plane Couette flow turned in space", |def| built(def, turned())),
        ProblemDef::new("couette-mirrored", "Plane Couette flow with gradient and flow exchanged", |def| {
            built(def, mirrored())
        }),
        ProblemDef::new("spiral", "A general gradient: rods spiral into an axis", |def| built(def, spiral())),
    ]
}

fn built(def: &ProblemDef, asked: Asked) -> Built {
    let motion = Motion { gradient_per_s: asked.gradient_per_s, aspect_ratio: asked.aspect_ratio };
    let end_s = asked.times_s.last().copied().unwrap_or_default();
    let (tolerance, because) = match motion.couette() {
        Some(rate) => {
            (tolerance::couette(asked.aspect_ratio, rate * end_s), tolerance::because_couette(asked.aspect_ratio))
        }
        None => (tolerance::general(&motion, &asked.start, end_s), tolerance::BECAUSE_GENERAL.to_owned()),
    };
    let rows = asked.times_s.iter().flat_map(|time| (0..).zip(&asked.start).map(move |rod| (*time, rod)));
    let certified = rows.map(|(time, (rod, start))| certified(&motion, time, rod, *start)).collect();
    Built {
        problem: Problem {
            format: FORMAT,
            version: super::version(def.name),
            name: def.name.into(),
            title: def.title.into(),
            summary: asked.summary,
            kind: Kind::Rods,
            gradient_per_s: asked.gradient_per_s,
            aspect_ratio: asked.aspect_ratio,
            aspect_ratio_sd_percent: 0.0,
            times_s: asked.times_s,
            c_i: None,
            d_r_per_s: None,
            planar_start: false,
            closed: None,
            formula: None,
            time_step_s: None,
            columns: ["time_s", "rod", "p1", "p2", "p3"].map(String::from).into(),
            metric: Metric::Angle,
            tolerance,
            because,
            equations: asked.equations.iter().map(|text| (*text).to_owned()).collect(),
            axes: AXES.into(),
            ensemble: None,
        },
        start: asked.start,
        inputs: Vec::new(),
        certified,
    }
}

fn certified(motion: &Motion, time_s: f64, rod: usize, start: [f64; 3]) -> Vec<String> {
    let at = rod::at(motion, Direction::Vector(start), &Bits(64).of(time_s), Unit::Second);
    let at = at.expect("seconds have a meaning in every flow");
    let mut row = vec![format!("{time_s:?}"), rod.to_string()];
    row.extend(at.p.iter().map(|x| digits(x, DIGITS)));
    row
}

const COUETTE_EQUATIONS: &[&str] = &[
    "the solution of Jeffery's equation in plane Couette flow, tan φ = r_e tan(2πt/T + const) and tan θ = C r_e/(r_e² \
     cos² φ + sin² φ)^(1/2) (A.4 and A.5 of Lee & Springer 1982)",
    "its period T = 2π(r_e + 1/r_e)/G (eq. 15 of Lee & Springer 1982)",
];

fn mid_flip(aspect_ratio: f64) -> Asked {
    // The next time at which φ = 1: there both rods and discs turn at more than a quarter of their fastest rate.
    let phase = |phi: f64| (phi.sin() / aspect_ratio).atan2(phi.cos()) / TAU;
    let first = phase(1.0) - phase(0.2);
    let times = [first, first + 0.5, first + 1.0];
    Asked {
        gradient_per_s: COUETTE,
        aspect_ratio,
        start: vec![direction(0.2, 1.0)],
        times_s: times.map(|turns| turns * period_s(aspect_ratio)).into(),
        summary: format!(
            "One free rod of r_e = {aspect_ratio} in plane Couette flow, from φ = 0.2, θ = 1 rad. It is asked for in \
             the flip in which it starts, half a period later in the next, and a period later in the one after: near φ \
             = 1 each time, where rods and discs alike turn at more than a quarter of their fastest rate. An error of \
             the phase, or a flip that is stepped over, shows here and not while a long rod lies along the flow, which \
             it does nearly always."
        ),
        equations: COUETTE_EQUATIONS,
    }
}

fn log_rolling() -> Asked {
    let aspect_ratio = 11.6;
    let t = period_s(aspect_ratio);
    Asked {
        gradient_per_s: COUETTE,
        aspect_ratio,
        start: vec![[0.0, 0.0, 1.0]],
        times_s: vec![0.25 * t, 0.5 * t, t],
        summary:
            "One free rod of r_e = 11.6 along the vorticity axis of plane Couette flow. It turns about itself and \
            points where it did. In angles this is the pole θ = 0, where φ has no value and 1/sin θ is infinite."
                .into(),
        equations: COUETTE_EQUATIONS,
    }
}

fn shear_plane() -> Asked {
    let aspect_ratio = 11.6;
    let t = period_s(aspect_ratio);
    Asked {
        gradient_per_s: COUETTE,
        aspect_ratio,
        start: vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.8, 0.0], [0.6, -0.8, 0.0]],
        times_s: vec![0.02 * t, 0.25 * t, 0.51 * t, 1.02 * t],
        summary: "Four free rods of r_e = 11.6 in the shear plane of plane Couette flow: across the flow, along it, \
            and on both sides of it. p_3 stays exactly 0 and the orbit constant is infinite. Between flips the rods \
            lie along the flow; the times are chosen so that each rod is seen in a flip."
            .into(),
        equations: COUETTE_EQUATIONS,
    }
}

fn poles() -> Asked {
    let aspect_ratio = 11.6;
    let t = period_s(aspect_ratio);
    let near = 1e-6;
    let mut start = vec![[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
    start.extend([0.3, 2.0, 4.4].map(|phi| direction(phi, near)));
    start.extend([0.3, 2.0, 4.4].map(|phi| direction(phi, PI - near)));
    Asked {
        gradient_per_s: COUETTE,
        aspect_ratio,
        start,
        // After whole periods every rod is back, as would be a rod that never moved; a program that runs is asked at
        // the last time.
        times_s: vec![0.1 * t, 0.25 * t, 0.6 * t, 1.1 * t],
        summary:
            "Eight free rods of r_e = 11.6 in plane Couette flow: one at each pole θ = 0 and θ = π of the angles, \
            and three 10⁻⁶ rad beside each. Those at a pole stay, the others go round it on small ellipses. A code in \
            φ and θ divides by sin θ here; nothing is singular in p."
                .into(),
        equations: COUETTE_EQUATIONS,
    }
}

fn long() -> Asked {
    let aspect_ratio = 2.0;
    Asked {
        gradient_per_s: COUETTE,
        aspect_ratio,
        start: vec![direction(0.2, 1.0)],
        times_s: [1.1, 10.1, 100.1, 1000.1, 10000.1].map(|turns| turns * period_s(aspect_ratio)).into(),
        summary: "One free rod of r_e = 2 in plane Couette flow after 1.1, 10.1, 100.1, 1000.1 and 10000.1 periods: \
            how the phase and the orbit drift. The strain is 1.6·10⁵, and RK4 in p needs 60 to 110 steps per unit of \
            strain for the tolerance."
            .into(),
        equations: COUETTE_EQUATIONS,
    }
}
