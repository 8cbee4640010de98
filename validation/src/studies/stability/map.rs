//! The fate of a rod over wide ranges: aspect ratio by step, by start, by duration.

use super::orbit::Place;
use super::*;
use crate::methods::integrators::Failure;
use crate::studies::work_precision::order::round_off;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// The angle to the closed form is at most [`Run::round_off`], and accurate.
    RoundOff,
    /// The angle is at most [`ACCURATE_RAD`].
    Accurate,
    /// The angle is larger, but |p| is 1 to [`LENGTH_KEPT`].
    Wrong,
    /// |p| differs from 1 by more than that.
    LengthLost,
    /// A component is infinite or NaN.
    NotFinite,
    Refused,
    /// The run would take more steps than the budget allows.
    NotRun,
}

/// The largest angle to the closed form, in rad, that counts as accurate.
pub const ACCURATE_RAD: f64 = 1e-2;

/// The largest ||p| − 1| that counts as unchanged.
pub const LENGTH_KEPT: f64 = 1e-2;

impl Fate {
    /// A one-character code, and a description in words.
    pub fn names(self) -> [&'static str; 2] {
        match self {
            Self::RoundOff => ["=", "round-off"],
            Self::Accurate => ["+", "accurate"],
            Self::Wrong => ["w", "stable but wrong"],
            Self::LengthLost => ["L", "length lost"],
            Self::NotFinite => ["N", "not finite"],
            Self::Refused => ["R", "refused"],
            Self::NotRun => ["·", "not run"],
        }
    }

    pub fn sign(self) -> &'static str {
        self.names()[0]
    }

    /// True if the end is within [`ACCURATE_RAD`] of the closed form.
    pub fn is_right(self) -> bool {
        self <= Self::Accurate
    }
}

/// One run: a rod that must end at a place after some periods.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    pub aspect_ratio: f64,
    pub turns: f64,
    pub end: Place,
    pub setting: Setting,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cell {
    pub found: Fate,
    /// The angle to the closed form in rad, if the end is finite.
    pub error_rad: Option<f64>,
    /// ||p| − 1|, if the end is finite.
    pub length: Option<f64>,
    /// The change of C_b, if the end is finite.
    pub orbit: Option<f64>,
    /// The integrator's error, or the reason why it was not run.
    pub reason: Option<String>,
}

/// The largest error of a direction by rounding alone after `turns` periods at once: the phase without whole periods is
/// rounded to ε, and φ moves by max(r_e, 1/r_e) times that; some sixteen roundings: 16 ε(1 + 2π max(r_e, 1/r_e)|rest|).
pub fn round_off_at_once(aspect_ratio: f64, turns: f64) -> f64 {
    let stretch = aspect_ratio.max(1.0 / aspect_ratio);
    16.0 * f64::EPSILON * (1.0 + TAU * stretch * (turns - turns.round()).abs())
}

impl Run {
    /// The largest error of a direction by rounding alone.
    pub fn round_off(&self) -> f64 {
        match self.setting {
            Setting::Once => round_off_at_once(self.aspect_ratio, self.turns),
            _ => round_off(self.aspect_ratio, self.turns),
        }
    }

    pub fn of(&self, integrator: &Integrator) -> Cell {
        let start = self.end.before(self.turns).direction(self.aspect_ratio);
        let problem = RodProblem::new(self.aspect_ratio, self.turns);
        match integrator.advance(&problem, &start, self.setting) {
            Ok(end) if end.iter().all(|component| component.is_finite()) => self.judged(&end),
            Ok(_) | Err(Failure::NotFinite) => Cell::without(Fate::NotFinite, None),
            Err(failure) => Cell::without(Fate::Refused, Some(failure.to_string())),
        }
    }

    fn judged(&self, end: &Vector3<f64>) -> Cell {
        let error = apart_rad(end, &self.end.direction(self.aspect_ratio));
        let length = (end.norm() - 1.0).abs();
        let fate = if length.is_nan() || length > LENGTH_KEPT {
            Fate::LengthLost
        } else if error.is_nan() || error > ACCURATE_RAD {
            Fate::Wrong
        } else if error <= self.round_off() {
            Fate::RoundOff
        } else {
            Fate::Accurate
        };
        Cell {
            found: fate,
            error_rad: Some(error),
            length: Some(length),
            orbit: Some(self.end.orbit_error(end, self.aspect_ratio)),
            reason: None,
        }
    }
}

impl Cell {
    fn without(found: Fate, reason: Option<String>) -> Self {
        Self { found, error_rad: None, length: None, orbit: None, reason }
    }

    pub fn not_run(reason: String) -> Self {
        Self::without(Fate::NotRun, Some(reason))
    }
}

/// The aspect ratios of the map: nearly a sphere, rods up to 10⁸, discs down to 10⁻⁸.
pub const ASPECT_RATIOS: [f64; 11] = [1e-8, 1e-4, 0.1, 1.0 + 1e-12, 1.01, 2.0, 11.6, 100.0, 1e4, 1e6, 1e8];

pub const STEPS: [f64; 13] = [1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e3];

pub const TOLERANCES: [f64; 7] = [1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

pub const PERIODS: [f64; 6] = [1.0, 10.0, 1e2, 1e4, 1e6, 1e8];

/// The time from φ = 0.2 to φ = 1 in periods, which is added to whole periods so that a run covers a flip.
fn flip(aspect_ratio: f64) -> f64 {
    let phase = |phi: f64| (phi.sin() / aspect_ratio).atan2(phi.cos());
    (phase(1.0) - phase(0.2)) / TAU
}

/// A run into a flip by steps of `step` periods, at most about `most_steps` of them, or at once. At least twenty
/// steps are taken, so that long steps cover many periods; with short steps the run ends within the first period.
pub fn by_step(theory: Theory, aspect_ratio: f64, step: f64, most_steps: u64) -> Run {
    let (turns, setting) = match theory {
        Theory::Exact => (step, Setting::Once),
        _ => {
            let wanted = (1.0 / step).clamp(20.0, most_steps as f64).round();
            let whole = (wanted * step).round();
            let turns = if whole >= 1.0 { whole + flip(aspect_ratio) } else { wanted * step };
            (turns, Setting::Steps((turns / step).round().max(1.0) as u64))
        }
    };
    let end = Place::mid_flip(aspect_ratio);
    Run { aspect_ratio, turns, end, setting }
}

/// A run of `periods` periods and a flip, to the place `end`; `Err` with the reason if it takes too many steps.
pub fn by_duration(
    theory: Theory,
    aspect_ratio: f64,
    periods: f64,
    end: Place,
    most_steps: u64,
) -> Result<Run, String> {
    let turns = periods + flip(aspect_ratio);
    let setting = match theory {
        Theory::Exact => Setting::Once,
        Theory::Adaptive => Setting::Tolerance(TOLERANCE),
        Theory::Order(_) => {
            let steps = RodProblem::new(aspect_ratio, turns).strain() / STRAIN_PER_STEP;
            if steps > most_steps as f64 {
                return Err(format!("{steps:.0e} steps"));
            }
            Setting::Steps(steps.ceil() as u64)
        }
    };
    Ok(Run { aspect_ratio, turns, end, setting })
}

/// GΔt of the runs by start and by duration: a tenth of explicit Euler's limit, and below the limit of every other
/// method.
pub const STRAIN_PER_STEP: f64 = 0.1;

/// The tolerance of the runs by start and by duration.
pub const TOLERANCE: f64 = 1e-9;

/// The ends of the runs by start, with their names: both poles, the flip with both signs, along the flow, and
/// C = 0, 10⁻³⁰⁰, 10³⁰⁰, ∞.
pub fn places(aspect_ratio: f64) -> Vec<(&'static str, Place)> {
    let at = |c, z, xy| Place::new(c, z, xy, aspect_ratio);
    vec![
        ("θ = 0, C = 0", at(0.0, 1.0, [1.0, 0.0])),
        ("θ = π", at(0.0, -1.0, [1.0, 0.0])),
        ("flip", at(1.0, 1.0, [1.0, 0.0])),
        ("flip, −p", at(1.0, -1.0, [-1.0, 0.0])),
        ("φ = π/2", at(1.0, 1.0, [0.0, 1.0])),
        ("C = 1e-300", at(1e-300, 1.0, [1.0, 1.0])),
        ("C = 1e300", at(1.0, 1e-300, [1.0, 1.0])),
        ("C = ∞", at(1.0, 0.0, [1.0, 1.0])),
    ]
}
