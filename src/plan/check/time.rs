//! Checks a scene's duration and its numbers of steps and outputs.

use super::*;
use crate::scene::{Time, TimeUnit, nearest};

pub(super) fn check_time(scene: &Scene, flow: &VelocityGradient) -> Result<(), Invalid> {
    let Time { unit, duration, .. } = scene.time;
    let outputs = scene.outputs_per_unit();
    let outputs_fit = || check_outputs(scene, outputs);
    match unit {
        TimeUnit::Period => {
            let period_s = check_period(scene, flow)?;
            outputs_fit()?;
            check_seconds(scene, duration * period_s)?;
            check_counted_steps(scene, outputs)
        }
        TimeUnit::Strain if flow.magnitude_per_s() == 0.0 => {
            Err(Invalid::new("time.strain", duration, "this flow has no strain rate: give seconds"))
        }
        TimeUnit::Strain => {
            outputs_fit()?;
            check_counted_steps(scene, outputs)?;
            // If the rate overflows, the unit would take 0 s.
            let unit_s = 1.0 / flow.magnitude_per_s();
            check_seconds(scene, if unit_s > 0.0 { duration * unit_s } else { f64::INFINITY })
        }
        TimeUnit::Second => {
            outputs_fit()?;
            check_counted_steps(scene, outputs)
        }
    }
}

/// The period in s; fails if the flow is not periodic over the whole duration.
fn check_period(scene: &Scene, flow: &VelocityGradient) -> Result<f64, Invalid> {
    let periods = scene.time.duration;
    let propagator = Propagator::new(flow, scene.particles.aspect_ratio);
    let refused = |allowed: String| Err(Invalid::new("time.periods", periods, allowed));
    let (Some(period_s), Some(drift)) = (propagator.period_s(), propagator.drift_per_period()) else {
        let other = if flow.magnitude_per_s() == 0.0 { "seconds" } else { "strain" };
        return refused(format!("rods of this aspect ratio have no period in this flow: give {other}"));
    };
    let drift = drift * periods;
    if drift.is_nan() || drift > MAX_DRIFT {
        return refused(format!(
            "rods of this aspect ratio have no exact period in this flow: over this time the rotating part grows by \
             e^{drift:.1e} relative to the rest, more than e^{MAX_DRIFT:e}: give strain"
        ));
    }
    Ok(period_s)
}

/// Checks that interacting rods take a feasible number of steps, an integer for each output.
fn check_counted_steps(scene: &Scene, outputs: u64) -> Result<(), Invalid> {
    if !scene.steps() {
        return Ok(());
    }
    let (time, steps) = (&scene.time, scene.steps_per_unit());
    let steps_name = time.unit.steps_key().trim_start_matches("time.");
    check_default_steps(scene, steps)?;
    bounded(time.unit.duration_key(), time.duration, steps, "steps", MAX_STEPS).map_err(|mut refused| {
        if time.steps_per_unit.is_none() {
            refused.allowed += &format!(": {steps} a {} by default, which {steps_name} sets", time.unit);
        }
        refused
    })?;
    if !scene.output.times.is_empty() {
        return check_steps_of_times(scene);
    }
    if !steps.is_multiple_of(outputs) {
        let rods = if scene.diffuses() { "rods that diffuse" } else { "interacting rods" };
        let allowed = format!("{rods} need a divisor of {steps_name} = {steps}");
        return Err(Invalid::new(time.unit.outputs_key(), outputs, allowed));
    }
    Ok(())
}

/// Checks the number of outputs, or their times.
fn check_outputs(scene: &Scene, outputs: u64) -> Result<(), Invalid> {
    let (Time { unit, duration, .. }, times) = (&scene.time, &scene.output.times);
    let Some(last) = times.last() else {
        return bounded(unit.duration_key(), *duration, outputs, "outputs", MAX_OUTPUTS);
    };
    if let Some(outputs) = scene.time.outputs_per_unit {
        return Err(Invalid::new(unit.outputs_key(), outputs, "either it or output.times, not both"));
    }
    // An end that differs by rounding is the end.
    let (within, few) = (*last <= duration * (1.0 + 1e-12), times.len() as f64 <= MAX_OUTPUTS);
    if within && few {
        return Ok(());
    }
    let allowed =
        format!("up to {MAX_OUTPUTS:e} times within the run, which ends at {} = {duration}", unit.duration_key());
    Err(Invalid::new("output.times", shown(times), allowed))
}

/// Checks that the given times of outputs of interacting rods are on different steps.
fn check_steps_of_times(scene: &Scene) -> Result<(), Invalid> {
    let (times, steps) = (&scene.output.times, scene.output_steps());
    let on: Vec<_> = (0..times.len()).map(|output| nearest(steps(output))).collect();
    let Some(wrong) = (0..on.len()).find(|&k| on[k].is_none() || k > 0 && on[k] == on[k - 1]) else {
        return Ok(());
    };
    let steps = scene.steps_per_unit();
    let allowed = format!(
        "interacting rods need different times on their steps, k/{steps}; {} is not one of them: set {}",
        times[wrong],
        scene.time.unit.steps_key().trim_start_matches("time.")
    );
    Err(Invalid::new("output.times", shown(times), allowed))
}

/// Times as an error shows them: some thousand would fill the screen.
fn shown(times: &[f64]) -> String {
    if times.len() <= 20 { format!("{times:?}") } else { format!("[{:?}, {:?}, …]", times[0], times[1]) }
}

/// Checks that steps of interacting rods are short enough for double precision; not for plane Couette flow by periods.
pub(super) fn check_steps(scene: &Scene, flow: &VelocityGradient) -> Result<(), Invalid> {
    let steps = scene.steps_per_unit();
    let refused = |allowed: String| Err(Invalid::new(scene.time.unit.steps_key(), steps, allowed));
    let longest = flow.per_s().amax();
    if longest == 0.0 {
        return Ok(());
    }
    let (gradient, duration) = (flow.per_s() / longest, longest * scene.seconds_per_unit(flow));
    let needed = gradient.norm() * duration / MAX_STEP;
    if needed.is_nan() || needed > steps as f64 {
        return refused(format!("at least {:.0}, to resolve the velocity gradient", needed.ceil()));
    }
    let other_flow = flow.shear_rate_per_s().is_none();
    let crossings = scene.volume().map_or(0.0, |volume| volume.crossings(&gradient)) * duration;
    if other_flow && (crossings.is_nan() || crossings > MAX_CROSSINGS * steps as f64) {
        return refused(format!(
            "at least {:.0}: in a step the liquid may cross the control volume {MAX_CROSSINGS} times at most; or a \
             box_mm whose sides differ less",
            (crossings / MAX_CROSSINGS).ceil()
        ));
    }
    let error = step_maps(scene, flow, &scene.particles.extreme_aspect_ratios()).fold(0.0, |worst: f64, map| {
        map.map_or(f64::INFINITY, |(_, error)| if error > worst || error.is_nan() { error } else { worst })
    });
    let all = error * steps as f64 * scene.time.duration;
    if all <= MAX_ERROR_RAD {
        return Ok(());
    }
    refused(format!(
        "the error of a step's map, {error:.1e}, adds up to {all:.1e} rad at the end, more than {MAX_ERROR_RAD:e}: \
         give a shorter time or other rods"
    ))
}

/// Fails if the default number of steps is too large: then the scene must give a smaller one.
fn check_default_steps(scene: &Scene, steps: u64) -> Result<(), Invalid> {
    if scene.time.steps_per_unit.is_some() || steps <= MAX_PER_UNIT {
        return Ok(());
    }
    let r = scene.particles.aspect_ratio;
    let resolved = scene.resolved_motion();
    let needed = scene.motion_per_unit() / resolved;
    let (unit, key) = (scene.time.unit, scene.time.unit.steps_key());
    let allowed = format!(
        "at aspect_ratio = {r} some {needed:.1e} steps a {unit} resolve the motion (GΔt ≤ {resolved}), and at most \
         {MAX_PER_UNIT} are allowed; set {} to take fewer, which do not resolve it, or a smaller aspect_ratio",
        key.trim_start_matches("time.")
    );
    Err(Invalid::missing(key, &allowed))
}

/// Checks that the duration in s is finite: without periods, phases are computed from seconds.
fn check_seconds(scene: &Scene, duration_s: f64) -> Result<(), Invalid> {
    if duration_s.is_finite() {
        return Ok(());
    }
    let allowed = "such that the run lasts a finite number of seconds > 0";
    Err(match scene.flow.shear_rate_per_s() {
        Some(g) => Invalid::new("flow.shear_rate_per_s", g, allowed),
        None => refused_gradient(scene, allowed),
    })
}

fn bounded(key: &'static str, duration: f64, per_unit: u64, what: &str, most: f64) -> Result<(), Invalid> {
    let all = duration * per_unit as f64;
    if all <= most {
        Ok(())
    } else {
        let allowed = format!("at most {most:e} {what} in all, not {all:e}");
        Err(Invalid::new(key, duration, allowed))
    }
}
