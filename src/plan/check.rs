//! Checks that the values of a scene are consistent.

pub(super) mod rods;
#[cfg(test)]
mod tests;
mod time;

use crate::model::flow::VelocityGradient;
use crate::model::volume::MAX_STEP;
use crate::motion::Propagator;
use crate::plan::free_motion::MAX_ERROR_RAD;
use crate::plan::no_interaction;
use crate::scene::{FlowStep, Interaction, Invalid, MAX_PER_UNIT, Scene, TimeUnit, refused, step_maps};

/// The largest number of steps, and of outputs, of one scene.
const MAX_STEPS: f64 = 1e9;
/// The limit follows from memory: 52 channels of 10⁶ outputs are 2.5 GB of sums.
const MAX_OUTPUTS: f64 = 1e6;
/// Largest relative deviation of a concentration from that of count and box, for sides given to about five digits; the
/// box is used.
const AGREE: f64 = 1e-3;
/// Largest ratio of trace to largest component for which a gradient counts as traceless: rounded decimals leave about
/// this much.
const INCOMPRESSIBLE: f64 = 1e-6;
/// Largest number of times that the liquid may cross the control volume in a step: places are drawn for a rod until one
/// is inside.
const MAX_CROSSINGS: f64 = 30.0;
/// Largest growth of the rotating part over the whole time for which a flow counts as periodic: a rod misses its start
/// by as many rad.
const MAX_DRIFT: f64 = 1e-6;

/// The mistakes in a scene: all values that their keys do not allow, or else inconsistent values: of the particles, and
/// the first of the rest, whose checks depend on one another. Only [`super::Plan::new`] checks whether the rods' motion
/// is within reach of double precision.
pub(super) fn invalid(scene: &Scene) -> Vec<Invalid> {
    let wrong = scene.out_of_range();
    if !wrong.is_empty() {
        return wrong;
    }
    if let Err(refused) = rods::check_shape(scene).and_then(|()| rods::check_own_rods(scene)) {
        return vec![refused];
    }
    [rods::check_particles(scene), check_motion(scene)].into_iter().filter_map(Result::err).collect()
}

pub(super) fn gradient(scene: &Scene) -> Result<VelocityGradient, Invalid> {
    scene.flow.gradient().ok_or_else(|| match scene.flow.shear_rate_per_s() {
        Some(g) => refused("flow.shear_rate_per_s", g),
        None => refused_gradient(scene, "three rows of three finite numbers"),
    })
}

/// True if free rods move by the closed form of plane Couette flow.
pub(super) fn closed_form(scene: &Scene, flow: &VelocityGradient) -> bool {
    flow.shear_rate_per_s().is_some() && scene.time.unit == TimeUnit::Period
}

/// Stresses in Pa need a viscosity and a concentration; orbit constants (eq. 13) and all stresses need plane Couette
/// flow along the axes.
fn check_observed(scene: &Scene, flow: &VelocityGradient) -> Result<(), Invalid> {
    let observables = &scene.output.observables;
    if let Some(asked) = observables.iter().find(|o| o.needs_viscosity()) {
        let needs = format!("give it, for {} is in Pa", asked.name());
        if scene.liquid.viscosity_pa_s.is_none() {
            return Err(Invalid::missing("liquid.viscosity_pa_s", &needs));
        }
        if scene.interaction.is_none() {
            let needs = format!("{needs} (with alpha = 0 for rods that do not collide)");
            return Err(Invalid::missing("interaction.concentration_per_cm3", &needs));
        }
        let unit = scene.stress_pa().unwrap_or(1.0);
        if !(1e-290..=1e290).contains(&unit.abs()) {
            let viscosity = scene.liquid.viscosity_pa_s.unwrap_or_default();
            let allowed = format!(
                "expected one with which the stresses' unit μ G n⟨a³⟩, here {unit:e} Pa, is from 1e-290 to 1e290 Pa"
            );
            return Err(Invalid::new("liquid.viscosity_pa_s", format!("{viscosity:e}"), allowed));
        }
    }
    let asked = observables.iter().find(|o| o.needs_couette());
    let other_flow = flow.shear_rate_per_s().is_none() || scene.flow.steps().is_some();
    let Some(asked) = asked.filter(|_| other_flow) else {
        return Ok(());
    };
    let names: Vec<_> = observables.iter().map(|o| o.name()).collect();
    let allowed =
        format!("{} needs plane Couette flow: only ∂u_2/∂x_1 other than 0, and always the same", asked.name());
    Err(Invalid::new("output.observables", format!("{names:?}"), allowed))
}

fn check_motion(scene: &Scene) -> Result<(), Invalid> {
    let flow = gradient(scene)?;
    if let Some(steps) = scene.flow.steps() {
        check_flow_steps(scene, steps)?;
    }
    check_observed(scene, &flow)?;
    let other = [
        (scene.interaction.is_some(), "0, as rods with an [interaction] table do not diffuse"),
        (scene.flow.steps().is_some(), "0, as rods in flow.steps do not diffuse"),
    ];
    if let Some((_, allowed)) = other.into_iter().find(|(is, _)| *is && scene.diffuses()) {
        let d_r = scene.particles.rotary_diffusion_per_s;
        return Err(Invalid::new("particles.rotary_diffusion_per_s", d_r, allowed));
    }
    match (&scene.interaction, scene.particles.volume_fraction) {
        (Some(interaction), _) => check_interaction(scene, interaction, &flow)?,
        (None, Some(fraction)) => {
            let allowed = "free rods fill no volume: give [interaction], with alpha = 0 for rods that do not collide";
            return Err(Invalid::new("particles.volume_fraction", fraction, allowed));
        }
        (None, None) => (),
    }
    time::check_time(scene, &flow)?;
    check_rods_outputs(scene)?;
    let by_steps = scene.diffuses() || !closed_form(scene, &flow) && no_interaction(scene).is_none();
    if by_steps { time::check_steps(scene, &flow) } else { Ok(()) }
}

/// Checks a sequence of flows: rods must be free, time must be a strain, and the run must end within the last flow.
fn check_flow_steps(scene: &Scene, steps: &[FlowStep]) -> Result<(), Invalid> {
    let refused = |allowed: String| Err(Invalid::new("flow.steps", format!("{} steps", steps.len()), allowed));
    if scene.interaction.is_some() {
        return refused("free rods: leave [interaction] out, or give one gradient".to_owned());
    }
    let duration = scene.time.duration;
    if scene.time.unit != TimeUnit::Strain {
        let key = scene.time.unit.duration_key();
        let allowed = format!("no {} where one flow follows another: give strain", key.trim_start_matches("time."));
        return Err(Invalid::new(key, duration, allowed));
    }
    let all: f64 = steps.iter().map(|step| step.strain).sum();
    // The slack allows for the rounding of the sum.
    if duration > all * (1.0 + 4.0 * f64::EPSILON * steps.len() as f64) {
        return Err(Invalid::new(
            "time.strain",
            duration,
            format!("at most {all}, the strain of all flow.steps together"),
        ));
    }
    let seconds = || steps.iter().map(|step| step.strain / step.rate_per_s());
    if seconds().all(|seconds| seconds > 0.0) && seconds().sum::<f64>().is_finite() {
        Ok(())
    } else {
        refused("rates at which each lasts a finite number of seconds > 0".to_owned())
    }
}

fn check_rods_outputs(scene: &Scene) -> Result<(), Invalid> {
    let last = scene.outputs().saturating_sub(1).max(1) as u64;
    if let Some(every) = scene.output.rods_every.filter(|every| *every > last) {
        let allowed = format!("expected a whole number from 1 to {last}, the number of outputs after the start");
        return Err(Invalid::new("output.rods_every", every, allowed));
    }
    let outputs: Vec<_> = scene.output.rods_at.iter().map(|time| scene.output_at(*time)).collect();
    let wrong = (0..outputs.len()).find(|&k| outputs[k].is_none() || k > 0 && outputs[k] == outputs[k - 1]);
    let Some(wrong) = wrong else {
        return Ok(());
    };
    let each = scene.outputs_per_unit();
    let times = if scene.output.times.is_empty() {
        format!("k/{each} up to {}", (scene.outputs() - 1) as f64 / each as f64)
    } else {
        "of output.times".to_owned()
    };
    let allowed = format!("different output times, {times}; {} is not one of them", scene.output.rods_at[wrong]);
    let value = format!("{:?}", scene.output.rods_at);
    Err(Invalid::new("output.rods_at", value, allowed))
}

fn refused_gradient(scene: &Scene, allowed: &str) -> Invalid {
    let rows = scene.flow.gradient_per_s().unwrap_or_default();
    Invalid::new("flow.gradient_per_s", format!("{rows:?}"), allowed)
}

fn check_interaction(scene: &Scene, interaction: &Interaction, flow: &VelocityGradient) -> Result<(), Invalid> {
    let (given, of_box) = (interaction.concentration_per_cm3, interaction.box_mm);
    if let Some(fraction) = scene.particles.volume_fraction {
        let others = [("concentration_per_cm3", given.is_some()), ("box_mm", of_box.is_some())];
        if let Some((other, _)) = others.into_iter().find(|(_, given)| *given) {
            let allowed = format!("either it or interaction.{other}, not both");
            return Err(Invalid::new("particles.volume_fraction", fraction, allowed));
        }
    }
    let (Some(n), Some(volume)) = (scene.concentration_per_cm3(), scene.volume()) else {
        return Err(Invalid::missing(
            "interaction.concentration_per_cm3",
            "concentration_per_cm3, box_mm or particles.volume_fraction must be given",
        ));
    };
    if let (Some(given), Some(sides)) = (given, of_box)
        && (given / n - 1.0).abs() > AGREE
    {
        let count = scene.particles.count;
        return Err(Invalid::new(
            "interaction.concentration_per_cm3",
            given,
            format!(
                "either it or box_mm, or both where they agree to 1e-3: {count} rods in {sides:?} mm are {n} per cm³"
            ),
        ));
    }
    let sound = |side: f64| side.is_finite() && side > 0.0;
    let other_flow = flow.shear_rate_per_s().is_none();
    if !(volume.sides().into_iter().all(sound) && n.is_finite() && n > 0.0) || other_flow && !volume.is_known() {
        return Err(match of_box {
            Some(sides) => Invalid::new(
                "interaction.box_mm",
                format!("{sides:?}"),
                "lengths for which the sides over the rods' length, their product and the concentration are finite \
                 numbers > 0",
            ),
            None => Invalid::new(
                scene.concentration_key(),
                scene.particles.volume_fraction.unwrap_or(n),
                "expected a number for which the control volume's side (N/(n a³))^⅓ is a finite number > 0",
            ),
        });
    }
    let (gradient, trace) = (flow.per_s(), flow.per_s().trace());
    if trace.is_nan() || trace.abs() > INCOMPRESSIBLE * gradient.amax() {
        return Err(refused_gradient(
            scene,
            "where rods interact, a gradient with ∂u_1/∂x_1 + ∂u_2/∂x_2 + ∂u_3/∂x_3 = 0: any other changes the volume \
             of the liquid and the concentration of the rods",
        ));
    }
    Ok(())
}
