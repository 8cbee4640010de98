//! The motion of free rods to each output of a scene, except in plane Couette flow by periods: computed once for all
//! replicas. A scene whose directions are not known accurately is refused.

use crate::model::flow::VelocityGradient;
use crate::model::orientation::from_degrees;
use crate::motion::{Propagator, Span};
use crate::scene::{Invalid, Scene, TimeUnit};
use nalgebra::{Matrix3, UnitVector3};
use rayon::prelude::*;

/// The largest error of a direction in rad; a scene with a larger one is refused. It is far below the resolution of any
/// mean over rods, and far above round-off.
pub const MAX_ERROR_RAD: f64 = 1e-6;
/// A bound on the relative error of a component of a direction given in degrees: from sine, cosine, product and length.
const ROUNDING_OF_START: f64 = 4.0 * f64::EPSILON;

/// The motion of a scene's free rods.
#[derive(Clone, Debug)]
pub(crate) struct FreeMotion {
    pub way: Way,
    /// The bound on the error of a direction in rad; for random directions, and each rod's own, that of the map
    /// relative to its size.
    pub error_rad: f64,
}

#[derive(Clone, Debug)]
pub(crate) enum Way {
    /// All rods have the same start and shape: their direction at each output, repeated periodically.
    Alike(Vec<[f64; 3]>),
    /// All rods have the same shape: the map to each output, repeated periodically.
    Maps(Vec<Matrix3<f64>>),
    /// A propagator per rod, or one if the shapes are equal: `spans` to each output, `mean` with the periods, and
    /// whether the starts are `rounded` from other numbers. Random starts are not: they are the doubles that were
    /// drawn.
    Each { mean: Box<Propagator>, spans: Vec<Span>, rounded: bool },
}

impl FreeMotion {
    /// The motion of the scene's rods in `flow`; an error names the scene's duration.
    pub fn new(scene: &Scene, flow: &VelocityGradient) -> Result<Self, Invalid> {
        let particles = &scene.particles;
        let r = particles.aspect_ratio;
        let general = |r: f64| stepped(scene, r).unwrap_or_else(|| Propagator::general(flow, r));
        let mean = general(r);
        let mut spans = spans(scene);
        let whole = scene.output.times.is_empty() && scene.time.unit == TimeUnit::Period;
        if whole && mean.drift_per_period() == Some(0.0) {
            // A periodic motion is computed for one period.
            spans.truncate(scene.outputs_per_unit() as usize);
        }
        // The starts in a file have errors of their own, which a map does not show.
        let each = particles.own().is_some_and(|own| own.p.is_some());
        let start = particles.common_start_deg();
        let start = start.map(|[phi_deg, theta_deg]| from_degrees(phi_deg, theta_deg));
        if each || particles.of_several_shapes() {
            let mut error_rad = 0.0f64;
            for r in particles.extreme_aspect_ratios() {
                let propagator = general(r);
                let errors = at_each(scene, &self::spans(scene), |span| {
                    let error = match start {
                        Some(start) => directed(&propagator, &mean, &start, span)?.1,
                        None => ErrorBound::of_motion(propagator.map_beside(&mean, span)?.1),
                    };
                    Some(((), error))
                })?;
                error_rad = error_rad.max(errors.1);
            }
            let mean = Box::new(propagator(scene, flow, r));
            let spans = self::spans(scene);
            let rounded = each || start.is_some();
            return Ok(Self { way: Way::Each { mean, spans, rounded }, error_rad });
        }
        let (way, error_rad) = match start {
            Some(start) => {
                let (ends, error) = at_each(scene, &spans, |span| directed(&mean, &mean, &start, span))?;
                (Way::Alike(ends), error)
            }
            None => {
                let (maps, error) = at_each(scene, &spans, |span| {
                    let (map, error) = mean.map(span)?;
                    Some((map, ErrorBound::of_motion(error)))
                })?;
                (Way::Maps(maps), error)
            }
        };
        Ok(Self { way, error_rad })
    }
}

/// The motion of the scene's free rods of aspect ratio `r`.
pub(crate) fn propagator(scene: &Scene, flow: &VelocityGradient, r: f64) -> Propagator {
    stepped(scene, r).unwrap_or_else(|| Propagator::new(flow, r))
}

/// Like `propagator`, for a sequence of flows; `None` for a single flow.
fn stepped(scene: &Scene, r: f64) -> Option<Propagator> {
    let steps = scene.flow.steps()?.iter();
    let flows: Option<Vec<_>> = steps.map(|step| Some((step.gradient()?, step.strain))).collect();
    Some(Propagator::of_steps(&flows?, r))
}

/// The bound on the error of a direction.
#[derive(Clone, Copy, Default)]
pub(crate) struct ErrorBound {
    pub rad: f64,
    /// The part that comes from rounding the start, in rad.
    of_start: f64,
}

impl ErrorBound {
    /// The bound for a start without an error.
    pub fn of_motion(rad: f64) -> Self {
        Self { rad, of_start: 0.0 }
    }

    /// Why the error is too large: the rounding of the start, or that of the rates.
    fn cause(self) -> &'static str {
        if self.of_start > 0.5 * self.rad {
            "this flow amplifies the rounding of the start beyond 1e-6 rad"
        } else {
            "the flow's rates cancel, or differ, by more than the 32 digits of the computation"
        }
    }
}

/// The direction of a rod that started along `start`; periods in `span` are those of `mean`.
pub(crate) fn directed(
    propagator: &Propagator,
    mean: &Propagator,
    start: &UnitVector3<f64>,
    span: Span,
) -> Option<([f64; 3], ErrorBound)> {
    let moved = propagator.moved_beside(mean, start, span)?;
    let of_start = ROUNDING_OF_START * moved.condition;
    Some((moved.p.into_inner().into(), ErrorBound { rad: moved.error + of_start, of_start }))
}

/// `motion` at each span, with the largest error in rad.
fn at_each<T: Send>(
    scene: &Scene,
    spans: &[Span],
    motion: impl Fn(Span) -> Option<(T, ErrorBound)> + Sync,
) -> Result<(Vec<T>, f64), Invalid> {
    // Not collected into an option directly: that would hold everything twice.
    let all: Vec<_> = spans.par_iter().map(|&span| motion(span)).collect();
    let all: Option<Vec<_>> = all.into_iter().collect();
    // A scene in periods has been checked to have a period.
    let all = all.unwrap_or_default();
    let larger = |a: ErrorBound, b: ErrorBound| if b.rad > a.rad || b.rad.is_nan() { b } else { a };
    let worst = all.iter().map(|(_, error)| *error).fold(ErrorBound::default(), larger);
    // An error of NaN counts as large.
    if worst.rad.is_nan() || worst.rad > MAX_ERROR_RAD {
        return Err(unknown(scene, worst));
    }
    let mut values: Vec<_> = all.into_iter().map(|(value, ..)| value).collect();
    // The vector reuses the larger allocation of the errors, and would keep it.
    values.shrink_to_fit();
    Ok((values, worst.rad))
}

fn unknown(scene: &Scene, error: ErrorBound) -> Invalid {
    Invalid::new(
        scene.time.unit.duration_key(),
        scene.time.duration,
        format!(
            "a time after which directions are known to {MAX_ERROR_RAD:e} rad: of rods of r_e = {} in this flow they \
             are known to {:.1e} rad only, as {}; give a shorter time, another start or other rods",
            scene.particles.aspect_ratio,
            error.rad,
            error.cause()
        ),
    )
}

/// The message for a rod of aspect ratio `r` whose direction has too large an error.
pub(crate) fn refused_direction(r: f64, error: ErrorBound) -> String {
    let bound = if error.rad.is_finite() { format!("{:.2e} rad", error.rad) } else { "infinite".into() };
    format!(
        "the bound on the error of its direction is {bound}, more than the {MAX_ERROR_RAD:e} rad allowed, at r_e = \
         {r}: {}; give a shorter time, another start or other rods",
        error.cause()
    )
}

/// The spans from the start to each output.
fn spans(scene: &Scene) -> Vec<Span> {
    let each = scene.outputs_each() as f64;
    scene.output_times().map(|time| scene.time.unit.span(time, each)).collect()
}
