//! Checking each value of a scene by itself.

use super::allowed::{Invalid, number, refused, whole};
use super::{Interaction, Orientation, Scene};

impl Scene {
    /// Every value that its key does not allow.
    pub(crate) fn out_of_range(&self) -> Vec<Invalid> {
        let given = |key, value: Option<f64>| value.map_or(Ok(()), |value| number(key, value));
        let (flow, particles, time) = (&self.flow, &self.particles, &self.time);
        let interaction = self.interaction.as_ref();
        let of_interaction = |value: fn(&Interaction) -> f64| interaction.map(value);
        [
            given("flow.shear_rate_per_s", flow.shear_rate_per_s),
            self.check_gradient(),
            whole("particles.count", particles.count as u64),
            number("particles.length_mm", particles.length_mm),
            number("particles.length_sd_percent", particles.length_sd_percent),
            self.check_aspect_ratio(),
            given("particles.physical_aspect_ratio", particles.physical_aspect_ratio),
            number("particles.aspect_ratio_sd_percent", particles.aspect_ratio_sd_percent),
            self.check_orientation(),
            given("interaction.concentration_per_cm3", interaction.and_then(|i| i.concentration_per_cm3)),
            self.check_box(),
            given("interaction.alpha", of_interaction(|i| i.alpha)),
            given("interaction.m", of_interaction(|i| i.m)),
            given("interaction.min_contact_arm", of_interaction(|i| i.min_contact_arm)),
            given("time.periods", time.periods),
            given("time.strain", time.strain),
            whole("time.steps_per_period", time.steps_per_period.unwrap_or(1)),
            whole("time.steps_per_strain", time.steps_per_strain.unwrap_or(1)),
            whole("time.outputs_per_period", time.outputs_per_period.unwrap_or(1)),
            whole("time.outputs_per_strain", time.outputs_per_strain.unwrap_or(1)),
            whole("ensemble.replicas", self.ensemble.replicas),
            whole("ensemble.seed", self.ensemble.seed),
            self.check_observables(),
            self.check_rods_at(),
        ]
        .into_iter()
        .filter_map(Result::err)
        .collect()
    }

    /// What a correlation makes of another is judged with it.
    fn check_aspect_ratio(&self) -> Result<(), Invalid> {
        match self.particles.physical_aspect_ratio {
            Some(_) => Ok(()),
            None => number("particles.aspect_ratio", self.particles.aspect_ratio),
        }
    }

    fn check_gradient(&self) -> Result<(), Invalid> {
        match self.flow.gradient_per_s {
            Some(rows) if rows.iter().flatten().any(|value| !value.is_finite()) => {
                Err(refused("flow.gradient_per_s", format!("{rows:?}")))
            }
            _ => Ok(()),
        }
    }

    fn check_box(&self) -> Result<(), Invalid> {
        match self.box_mm() {
            Some(sides) if !sides.iter().all(|side| side.is_finite() && *side > 0.0) => {
                Err(refused("interaction.box_mm", format!("{sides:?}")))
            }
            _ => Ok(()),
        }
    }

    fn check_orientation(&self) -> Result<(), Invalid> {
        match self.particles.orientation {
            Orientation::Given { phi_deg, theta_deg }
                if !(phi_deg.is_finite() && (0.0..=180.0).contains(&theta_deg)) =>
            {
                let value = format!("{{ phi_deg = {phi_deg}, theta_deg = {theta_deg} }}");
                Err(refused("particles.orientation", value))
            }
            _ => Ok(()),
        }
    }

    /// That they are outputs depends on other keys.
    fn check_rods_at(&self) -> Result<(), Invalid> {
        let times = &self.output.rods_at;
        let known = times.iter().all(|time| time.is_finite() && *time >= 0.0);
        if known && times.is_sorted_by(|a, b| a < b) {
            return Ok(());
        }
        Err(refused("output.rods_at", format!("{times:?}")))
    }

    fn check_observables(&self) -> Result<(), Invalid> {
        let observables = &self.output.observables;
        let repeated = observables.iter().enumerate().any(|(k, o)| observables[..k].contains(o));
        if observables.is_empty() || repeated {
            let names: Vec<_> = observables.iter().map(|o| o.name()).collect();
            return Err(refused("output.observables", format!("{names:?}")));
        }
        Ok(())
    }
}
