//! Checking a scene: which values go together.

mod time;

use crate::model::flow::VelocityGradient;
use crate::model::volume::MAX_STEP;
use crate::motion::Propagator;
use crate::plan::free::MAX_ERROR_RAD;
use crate::plan::no_interaction;
use crate::scene::{Interaction, Invalid, MAX_PER_UNIT, Scene, resolved_strain, step_maps};

/// The most steps and the most outputs of one scene.
const MAX_STEPS: f64 = 1e9;
/// 52 channels of 10⁶ outputs are 2.5 GB of sums.
const MAX_OUTPUTS: f64 = 1e6;
/// How far a concentration may be from that of count and box, for a side in five digits or so: the box counts.
const AGREE: f64 = 1e-3;
/// The trace of a gradient over its largest component up to which a liquid is taken to keep its volume: some rounded decimals.
const INCOMPRESSIBLE: f64 = 1e-6;
/// How often the liquid may cross the control volume in a step: places are drawn for a rod until one is inside.
const MAX_CROSSINGS: f64 = 30.0;
/// The growth over the whole time up to which what turns is called periodic: a rod misses its start by as many rad.
const MAX_DRIFT: f64 = 1e-6;

impl Scene {
    /// Every value that its key does not allow; where there is none, what does not go together. What a file says of rods is
    /// looked at where it has been read. Whether double precision reaches the rods' motion is seen by [`crate::Plan::new`] alone.
    pub fn problems(&self) -> Vec<Invalid> {
        match self.out_of_range() {
            wrong if wrong.is_empty() => self.at_odds(),
            wrong => wrong,
        }
    }

    /// What does not go together: of the particles, and of the rest the first, for what is wrong there follows from
    /// one to the next. Every value is one that its key allows.
    fn at_odds(&self) -> Vec<Invalid> {
        if let Err(refused) = self.check_shape().and_then(|()| self.check_own_rods()) {
            return vec![refused];
        }
        [self.check_particles(), self.check_motion()].into_iter().filter_map(Result::err).collect()
    }

    /// Orbit constants (eq. 13), shear stress and normal stress differences are those of plane Couette flow along the axes.
    fn check_observed(&self, flow: &VelocityGradient) -> Result<(), Invalid> {
        let observables = &self.output.observables;
        let asked = observables.iter().find(|o| o.needs_couette());
        let Some(asked) = asked.filter(|_| flow.shear_rate_per_s().is_none()) else {
            return Ok(());
        };
        let names: Vec<_> = observables.iter().map(|o| o.name()).collect();
        let allowed = format!("{} needs plane Couette flow: only ∂u_2/∂x_1 other than 0", asked.name());
        Err(Invalid::new("output.observables", format!("{names:?}"), allowed))
    }

    fn check_motion(&self) -> Result<(), Invalid> {
        let flow = self.check_flow()?;
        self.check_observed(&flow)?;
        if let Some(interaction) = &self.interaction {
            self.check_interaction(interaction, &flow)?;
        }
        self.check_time(&flow)?;
        self.check_rods_outputs()?;
        let turns_in_closed_form = flow.shear_rate_per_s().is_some() && self.time.strain.is_none();
        match turns_in_closed_form || no_interaction(self).is_some() {
            true => Ok(()),
            false => self.check_steps(&flow),
        }
    }

    fn check_rods_outputs(&self) -> Result<(), Invalid> {
        let outputs: Vec<_> = self.output.rods_at.iter().map(|time| self.output_at(*time)).collect();
        let wrong =
            (0..outputs.len()).find(|&k| outputs[k].is_none() || k > 0 && outputs[k] == outputs[k - 1]);
        let Some(wrong) = wrong else {
            return Ok(());
        };
        let each = self.outputs_per_unit();
        let allowed = format!(
            "each the time of another output, k/{each} up to {}, which {} is not",
            (self.outputs() - 1) as f64 / each as f64,
            self.output.rods_at[wrong]
        );
        let value = format!("{:?}", self.output.rods_at);
        Err(Invalid::new("output.rods_at", value, allowed))
    }

    fn refused_gradient(&self, allowed: &str) -> Invalid {
        let rows = self.flow.gradient_per_s.unwrap_or_default();
        Invalid::new("flow.gradient_per_s", format!("{rows:?}"), allowed)
    }

    fn check_interaction(&self, interaction: &Interaction, flow: &VelocityGradient) -> Result<(), Invalid> {
        let (given, of_box) = (interaction.concentration_per_cm3, interaction.box_mm);
        let (Some(n), Some(volume)) = (self.concentration_per_cm3(), self.volume()) else {
            return Err(Invalid::missing(
                "interaction.concentration_per_cm3",
                "concentration_per_cm3 or box_mm must be given",
            ));
        };
        if let (Some(given), Some(sides)) = (given, of_box)
            && (given / n - 1.0).abs() > AGREE
        {
            let count = self.particles.count;
            return Err(Invalid::new(
                "interaction.concentration_per_cm3",
                given,
                format!(
                    "either it or box_mm, or both where they agree to 1e-3: {count} rods in {sides:?} mm are {n} per cm³"
                ),
            ));
        }
        let known = |side: f64| side.is_finite() && side > 0.0;
        let other_flow = flow.shear_rate_per_s().is_none();
        if !(volume.sides().into_iter().all(known) && n.is_finite() && n > 0.0)
            || other_flow && !volume.is_known()
        {
            return Err(match of_box {
                Some(sides) => Invalid::new(
                    "interaction.box_mm",
                    format!("{sides:?}"),
                    "such that the sides over the rods' length, their product and the concentration are finite numbers > 0",
                ),
                None => Invalid::new(
                    "interaction.concentration_per_cm3",
                    n,
                    "such that the control volume's side (N/(n a³))^⅓ is a finite number > 0",
                ),
            });
        }
        let (gradient, trace) = (flow.per_s(), flow.per_s().trace());
        if trace.is_nan() || trace.abs() > INCOMPRESSIBLE * gradient.amax() {
            return Err(self.refused_gradient(
                "such that ∂u_1/∂x_1 + ∂u_2/∂x_2 + ∂u_3/∂x_3 is 0 where rods interact: else the liquid does not keep its volume, \
                 nor rods their concentration",
            ));
        }
        Ok(())
    }
}
