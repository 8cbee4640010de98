//! How long a scene runs, and in how many steps and outputs.

use super::*;

impl Scene {
    pub(super) fn check_time(&self, flow: &VelocityGradient) -> Result<(), Invalid> {
        let time = &self.time;
        match (time.periods, time.strain) {
            (Some(periods), None) => self.check_periods(periods, flow),
            (None, Some(strain)) => self.check_strain(strain, flow),
            (Some(periods), Some(_)) => Err(Invalid::new(
                "time.periods",
                periods,
                "either periods or strain, not both",
            )),
            (None, None) => Err(Invalid::missing(
                "time.periods",
                "periods or strain must be given",
            )),
        }
    }

    fn check_periods(&self, periods: f64, flow: &VelocityGradient) -> Result<(), Invalid> {
        let key = "time.periods";
        let propagator = Propagator::new(flow, self.particles.aspect_ratio);
        let no_period = "rods of this aspect ratio have no period in this flow";
        let (Some(period_s), Some(drift)) = (propagator.period_s(), propagator.drift_per_period()) else {
            return Err(Invalid::new(key, periods, format!("{no_period}: give strain")));
        };
        let drift = drift * periods;
        if drift.is_nan() || drift > MAX_DRIFT {
            let allowed = format!(
                "{no_period}: in what would be one, times this, what turns has grown by e^{drift:.1e} against what does \
                 not, more than e^{MAX_DRIFT:e}: give strain"
            );
            return Err(Invalid::new(key, periods, allowed));
        }
        if let Some(outputs) = self.time.outputs_per_strain {
            return Err(Invalid::new(
                "time.outputs_per_strain",
                outputs,
                "goes with strain; periods take outputs_per_period",
            ));
        }
        let outputs = self.outputs_per_period();
        bounded(key, periods, outputs, "outputs", MAX_OUTPUTS)?;
        self.check_seconds(periods * period_s)?;
        if self.interaction.is_some() {
            let steps = self.steps_per_period();
            self.check_default_steps(steps)?;
            bounded(key, periods, steps, "steps", MAX_STEPS).map_err(|mut refused| {
                if self.time.steps_per_period.is_none() {
                    refused.allowed += &format!(": {steps} a period by default, which steps_per_period sets");
                }
                refused
            })?;
            if !steps.is_multiple_of(outputs) {
                return Err(Invalid::new(
                    "time.outputs_per_period",
                    outputs,
                    format!("interacting rods need a divisor of steps_per_period = {steps}"),
                ));
            }
        }
        Ok(())
    }

    /// A default that would take too many steps is refused: whoever wants fewer has to say so.
    fn check_default_steps(&self, steps: u64) -> Result<(), Invalid> {
        if self.time.steps_per_period.is_some() || steps <= MAX_PER_UNIT {
            return Ok(());
        }
        let r = self.particles.aspect_ratio;
        let resolved = resolved_strain(self.particles.mean_aspect_ratio());
        let needed = strain_per_period(r) / resolved;
        let allowed = format!(
            "at aspect_ratio = {r} some {needed:.1e} steps a period resolve the motion (GΔt ≤ {resolved}), and at \
             most {MAX_PER_UNIT} are allowed; set steps_per_period to take fewer, which do not resolve it, or a smaller \
             aspect_ratio"
        );
        Err(Invalid::missing("time.steps_per_period", &allowed))
    }

    fn check_strain(&self, strain: f64, flow: &VelocityGradient) -> Result<(), Invalid> {
        let key = "time.strain";
        if flow.magnitude_per_s() == 0.0 {
            return Err(Invalid::new(
                key,
                strain,
                "this flow has no strain rate: give periods",
            ));
        }
        if self.interaction.is_some() {
            return Err(Invalid::new(
                key,
                strain,
                "interacting rods take steps per period: give periods",
            ));
        }
        for (key, value) in [
            ("time.steps_per_period", self.time.steps_per_period),
            ("time.outputs_per_period", self.time.outputs_per_period),
        ] {
            if let Some(value) = value {
                return Err(Invalid::new(
                    key,
                    value,
                    "goes with periods; strain takes outputs_per_strain",
                ));
            }
        }
        bounded(key, strain, self.outputs_per_strain(), "outputs", MAX_OUTPUTS)?;
        // A rate that overflows would take no time at all.
        let unit_s = 1.0 / flow.magnitude_per_s();
        self.check_seconds(if unit_s > 0.0 {
            strain * unit_s
        } else {
            f64::INFINITY
        })
    }

    /// Where phases are not counted in periods they come from the time in seconds, which must not overflow.
    fn check_seconds(&self, duration_s: f64) -> Result<(), Invalid> {
        if duration_s.is_finite() {
            return Ok(());
        }
        let allowed = "such that the run lasts a finite number of seconds > 0";
        Err(match self.flow.shear_rate_per_s {
            Some(g) => Invalid::new("flow.shear_rate_per_s", g, allowed),
            None => {
                let rows = format!("{:?}", self.flow.gradient_per_s.unwrap_or_default());
                Invalid::new("flow.gradient_per_s", rows, allowed)
            }
        })
    }
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
