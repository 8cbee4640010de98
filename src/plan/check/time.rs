//! How long a scene runs, and in how many steps and outputs.

use super::*;

impl Scene {
    pub(super) fn check_time(&self, flow: &VelocityGradient) -> Result<(), Invalid> {
        let time = &self.time;
        match (time.periods, time.strain) {
            (Some(periods), None) => self.check_periods(periods, flow),
            (None, Some(strain)) => self.check_strain(strain, flow),
            (Some(periods), Some(_)) => {
                Err(Invalid::new("time.periods", periods, "either periods or strain, not both"))
            }
            (None, None) => Err(Invalid::missing("time.periods", "periods or strain must be given")),
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
        let time = &self.time;
        not_given(
            "goes with strain; periods take",
            [
                ("time.steps_per_strain", time.steps_per_strain, "steps_per_period"),
                ("time.outputs_per_strain", time.outputs_per_strain, "outputs_per_period"),
            ],
        )?;
        let outputs = self.outputs_per_period();
        bounded(key, periods, outputs, "outputs", MAX_OUTPUTS)?;
        self.check_seconds(periods * period_s)?;
        self.check_counted_steps(key, periods, ("time.outputs_per_period", outputs))
    }

    /// That interacting rods take a number of steps that can be taken, some for each output.
    fn check_counted_steps(
        &self,
        key: &'static str,
        duration: f64,
        (outputs_key, outputs): (&'static str, u64),
    ) -> Result<(), Invalid> {
        if self.interaction.is_none() {
            return Ok(());
        }
        let steps = self.steps_per_unit();
        let steps_name = self.steps_key().trim_start_matches("time.");
        self.check_default_steps(steps)?;
        bounded(key, duration, steps, "steps", MAX_STEPS).map_err(|mut refused| {
            if !self.gives_steps() {
                let unit = self.time_unit();
                refused.allowed += &format!(": {steps} a {unit} by default, which {steps_name} sets");
            }
            refused
        })?;
        if !steps.is_multiple_of(outputs) {
            let allowed = format!("interacting rods need a divisor of {steps_name} = {steps}");
            return Err(Invalid::new(outputs_key, outputs, allowed));
        }
        Ok(())
    }

    fn gives_steps(&self) -> bool {
        self.time.steps_per_period.or(self.time.steps_per_strain).is_some()
    }

    /// That a step of interacting rods, other than in plane Couette flow by periods, is short enough to be known.
    pub(super) fn check_steps(&self, flow: &VelocityGradient) -> Result<(), Invalid> {
        let steps = self.steps_per_unit();
        let refused = |allowed: String| Err(Invalid::new(self.steps_key(), steps, allowed));
        let longest = flow.per_s().amax();
        let (gradient, duration) = (flow.per_s() / longest, longest * self.seconds_per_unit(flow));
        let needed = gradient.norm() * duration / MAX_STEP;
        if needed.is_nan() || needed > steps as f64 {
            return refused(format!(
                "at least {:.0}, in which the liquid's gradient is resolved",
                needed.ceil()
            ));
        }
        let other_flow = flow.shear_rate_per_s().is_none();
        let crossings = self.volume().map_or(0.0, |volume| volume.crossings(&gradient)) * duration;
        if other_flow && (crossings.is_nan() || crossings > MAX_CROSSINGS * steps as f64) {
            return refused(format!(
                "at least {:.0}: in a step the liquid may cross the control volume {MAX_CROSSINGS} times at most; or a box_mm whose \
                 sides differ less",
                (crossings / MAX_CROSSINGS).ceil()
            ));
        }
        let error =
            step_maps(self, flow, &self.particles.extreme_aspect_ratios()).fold(0.0, |worst: f64, map| {
                map.map_or(
                    f64::INFINITY,
                    |(_, error)| {
                        if error > worst || error.is_nan() { error } else { worst }
                    },
                )
            });
        let all = error * steps as f64 * self.time.strain.or(self.time.periods).unwrap_or(0.0);
        if all <= MAX_ERROR_RAD {
            return Ok(());
        }
        refused(format!(
            "the map of a step, known to {error:.1e}, leaves directions unknown by {all:.1e} rad in the end, more than \
             {MAX_ERROR_RAD:e}: give a shorter time or other rods"
        ))
    }

    /// A default that would take too many steps is refused: whoever wants fewer has to say so.
    fn check_default_steps(&self, steps: u64) -> Result<(), Invalid> {
        if self.gives_steps() || steps <= MAX_PER_UNIT {
            return Ok(());
        }
        let r = self.particles.aspect_ratio;
        let resolved = resolved_strain(self.particles.mean_aspect_ratio());
        let needed = self.motion_per_unit() / resolved;
        let (unit, key) = (self.time_unit(), self.steps_key());
        let allowed = format!(
            "at aspect_ratio = {r} some {needed:.1e} steps a {unit} resolve the motion (GΔt ≤ {resolved}), and at \
             most {MAX_PER_UNIT} are allowed; set {} to take fewer, which do not resolve it, or a smaller \
             aspect_ratio",
            key.trim_start_matches("time.")
        );
        Err(Invalid::missing(key, &allowed))
    }

    fn check_strain(&self, strain: f64, flow: &VelocityGradient) -> Result<(), Invalid> {
        let key = "time.strain";
        if flow.magnitude_per_s() == 0.0 {
            return Err(Invalid::new(key, strain, "this flow has no strain rate: give periods"));
        }
        let time = &self.time;
        not_given(
            "goes with periods; strain takes",
            [
                ("time.steps_per_period", time.steps_per_period, "steps_per_strain"),
                ("time.outputs_per_period", time.outputs_per_period, "outputs_per_strain"),
            ],
        )?;
        let outputs = self.outputs_per_strain();
        bounded(key, strain, outputs, "outputs", MAX_OUTPUTS)?;
        self.check_counted_steps(key, strain, ("time.outputs_per_strain", outputs))?;
        // A rate that overflows would take no time at all.
        let unit_s = 1.0 / flow.magnitude_per_s();
        self.check_seconds(if unit_s > 0.0 { strain * unit_s } else { f64::INFINITY })
    }

    /// Where phases are not counted in periods they come from the time in seconds, which must not overflow.
    fn check_seconds(&self, duration_s: f64) -> Result<(), Invalid> {
        if duration_s.is_finite() {
            return Ok(());
        }
        let allowed = "such that the run lasts a finite number of seconds > 0";
        Err(match self.flow.shear_rate_per_s {
            Some(g) => Invalid::new("flow.shear_rate_per_s", g, allowed),
            None => self.refused_gradient(allowed),
        })
    }
}

/// Refuses keys of the other unit of time, and names those of the own.
fn not_given(why: &str, keys: [(&'static str, Option<u64>, &str); 2]) -> Result<(), Invalid> {
    match keys.into_iter().find_map(|(key, value, own)| Some((key, value?, own))) {
        Some((key, value, own)) => Err(Invalid::new(key, value, format!("{why} {own}"))),
        None => Ok(()),
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
