//! The plan of a scene: which stages run, which are dropped, and why.
//!
//! [`Plan::new`] is the one judge of a scene. It may use `scene` and the parts before it. To add a check, add a
//! function to `check`; to add a stage, a variant of [`Stage`] with the reason for which a scene needs it.

mod check;
mod elapsed;
pub mod free_motion;
mod stages;
mod warnings;

pub use elapsed::Elapsed;
pub use stages::{Entry, Stage};

use crate::model::flow::VelocityGradient;
use crate::observable::Observable;
use crate::plan::free_motion::FreeMotion;
use crate::scene::document::Document;
use crate::scene::{Error, MAX_REPLICAS, Scene, TimeUnit, of_document};
use elapsed::Timing;
pub(crate) use stages::no_interaction;
use stages::{entries, rod_errors};
use std::fmt;
use std::sync::Arc;

/// Units in which outputs and steps are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Clock {
    /// Ticks per period of the mean aspect ratio: steps if there are steps, else outputs.
    Periods { ticks: u64 },
    /// Steps or outputs, each by its map.
    Maps,
}

/// A checked scene and the stages that will run for it.
///
/// ```
/// let plan = shearbed::Plan::new(&shearbed::Scene::default())?;
/// assert_eq!((plan.steps(), plan.outputs()), (0, 401)); // free rods take no steps
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Plan {
    scene: Scene,
    flow: VelocityGradient,
    timing: Timing,
    /// Motion of free rods, except in plane Couette flow by periods.
    free: Option<Arc<FreeMotion>>,
    entries: Vec<Entry>,
}

impl Plan {
    /// Checks the scene and decides what it needs.
    ///
    /// # Errors
    ///
    /// [`Error::Scene`] with all values that their keys do not allow; or else with inconsistent values.
    pub fn new(scene: &Scene) -> Result<Self, Error> {
        let one = |invalid| Error::Scene(vec![invalid]);
        let invalid = check::invalid(scene);
        if !invalid.is_empty() {
            return Err(Error::Scene(invalid));
        }
        check::rods::check_rods_are_read(scene).map_err(one)?;
        let flow = check::gradient(scene).map_err(one)?;
        let free = if check::closed_form(scene, &flow) || no_interaction(scene).is_none() || scene.diffuses() {
            None
        } else {
            Some(Arc::new(FreeMotion::new(scene, &flow).map_err(one)?))
        };
        let timing = Timing::of(scene, &flow);
        Ok(Self { scene: scene.clone(), flow, timing, free, entries: entries(scene) })
    }

    /// Reads a scene file's text and plans it; `file` names the text in errors.
    ///
    /// # Errors
    ///
    /// [`Error::Text`] with every mistake that can be found at once, each with its line.
    ///
    /// ```
    /// let text = "title = 't'\nflow = { shear_rate_per_s = 1 }\ntime = { periods = 1e9 }\n\
    ///     [particles]\ncount = 10\nlength_mm = 1\n\
    ///     aspect_ratio = 5\norientation = 'isotropic'\n";
    /// let error = shearbed::Plan::parse("s.toml", text).unwrap_err().to_string();
    /// assert!(error.starts_with("s.toml:3: time.periods = 1e9 \
    ///     is not allowed: at most 1e6 outputs in all"), "{error}");
    /// ```
    pub fn parse(file: &str, text: &str) -> Result<Self, Error> {
        let document = Document::parse(file, text)?;
        Self::new(&of_document(&document)?).map_err(|error| document.located(error))
    }

    /// The same plan with `stage`, and the stages that it needs, run although the scene does not need them: to test
    /// that dropping it changes nothing, and to measure its cost. `None` if the scene has nothing for the stage to work
    /// on: no `[interaction]` table, or free rods in any but plane Couette flow by periods.
    pub fn with_stage(&self, stage: Stage) -> Option<Self> {
        let needs: &[Stage] = match stage {
            Stage::Translation => &[Stage::Positions],
            Stage::Neighbours => &[Stage::Translation, Stage::Positions],
            Stage::CollisionDraws => &[Stage::Translation, Stage::Positions],
            Stage::Contacts => &[Stage::CollisionDraws, Stage::Neighbours, Stage::Translation, Stage::Positions],
            _ => &[],
        };
        let in_volume = stage == Stage::Positions || !needs.is_empty();
        if in_volume && (self.scene.interaction.is_none() || self.free.is_some()) {
            return None;
        }
        let mut plan = self.clone();
        let reason = || "asked for by the caller".to_owned();
        for entry in &mut plan.entries {
            if entry.stage == stage || needs.contains(&entry.stage) {
                entry.kept = true;
                entry.reason = reason();
            }
        }
        // An observable that the scene does not ask for has no entry.
        if !plan.runs(stage) {
            plan.entries.push(Entry { stage, kept: true, reason: reason() });
        }
        Some(plan)
    }

    /// The same plan with `replicas` replicas, clamped to 1 to [`crate::scene::MAX_REPLICAS`].
    ///
    /// ```
    /// let plan = shearbed::Plan::new(&shearbed::Scene::default())?;
    /// assert_eq!(plan.with_replicas(40).scene().ensemble.replicas, 40);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_replicas(&self, replicas: u64) -> Self {
        let mut plan = self.clone();
        plan.scene.ensemble.replicas = replicas.clamp(1, MAX_REPLICAS);
        let errors = rod_errors(&plan.scene);
        match plan.entries.iter_mut().find(|entry| entry.stage == errors.stage) {
            Some(entry) => *entry = errors,
            None => plan.entries.push(errors),
        }
        plan
    }

    /// The scene of the plan.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The imposed flow; the first one of a sequence.
    pub fn flow(&self) -> &VelocityGradient {
        &self.flow
    }

    /// The bound on the error of free rods' directions in rad; `None` for the closed form of plane Couette flow. For
    /// random directions it is the error of the map that moves them, relative to its size.
    pub fn error_rad(&self) -> Option<f64> {
        self.free.as_ref().map(|free| free.error_rad)
    }

    pub(crate) fn free(&self) -> Option<&Arc<FreeMotion>> {
        self.free.as_ref()
    }

    /// The stages, kept and dropped, in the order of a run.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// True if `stage` runs.
    pub fn runs(&self, stage: Stage) -> bool {
        self.entries.iter().any(|entry| entry.stage == stage && entry.kept)
    }

    /// True if replicas differ: something of a rod or of its motion is drawn.
    pub fn draws(&self) -> bool {
        let random =
            [Stage::AspectRatios, Stage::Lengths, Stage::Orientations, Stage::CollisionDraws, Stage::Diffusion];
        random.into_iter().any(|stage| self.runs(stage))
    }

    /// The observables to compute, in the order of the scene.
    pub fn observables(&self) -> Vec<Observable> {
        let kept = self.entries.iter().filter(|entry| entry.kept);
        kept.filter_map(|entry| match entry.stage {
            Stage::Observe(observable) => Some(observable),
            _ => None,
        })
        .collect()
    }

    /// The number of outputs, including that at t = 0 unless the scene gives their times.
    pub fn outputs(&self) -> usize {
        self.scene.outputs()
    }

    /// The number of time steps; 0 if the exact motion goes straight to each output.
    pub fn steps(&self) -> u64 {
        if self.takes_steps() { self.ticks()(self.outputs() - 1) } else { 0 }
    }

    fn takes_steps(&self) -> bool {
        self.runs(Stage::Translation) || self.runs(Stage::Diffusion)
    }

    /// The name of the time column: `t_over_T`, or `strain` or `time_s` if the scene's time is that.
    pub fn time_name(&self) -> &'static str {
        match self.scene.time.unit {
            TimeUnit::Period => "t_over_T",
            TimeUnit::Strain => "strain",
            TimeUnit::Second => "time_s",
        }
    }

    /// Seconds and shear strain from the start to `time`, which is in the unit of [`Plan::times`].
    pub fn elapsed(&self, time: f64) -> Elapsed {
        self.timing.at(time)
    }

    /// The times of the outputs, in periods, units of strain or seconds.
    pub fn times(&self) -> Vec<f64> {
        let each = self.scene.outputs_each() as f64;
        self.scene.output_times().map(|time| time / each).collect()
    }

    /// The largest shear strain between two outputs.
    pub fn strain_between_outputs(&self) -> f64 {
        let strains: Vec<f64> = self.times().into_iter().map(|time| self.elapsed(time).strain).collect();
        strains.windows(2).map(|pair| pair[1] - pair[0]).max_by(f64::total_cmp).unwrap_or(0.0)
    }

    /// The outputs at which the scene asks for every rod, without repetition, in the order of time.
    pub fn rods_outputs(&self) -> Vec<usize> {
        let times = self.scene.output.rods_at.iter();
        let mut outputs: Vec<_> = times.filter_map(|time| self.scene.output_at(*time)).collect();
        if let Some(every) = self.scene.output.rods_every {
            outputs.extend((0..self.outputs()).step_by(every.max(1) as usize));
            outputs.sort_unstable();
            outputs.dedup();
        }
        outputs
    }

    /// The number of rods that the scene asks for, over all replicas and outputs.
    pub fn rods_out(&self) -> u64 {
        let of_replica = self.rods_outputs().len() as u64 * self.scene.particles.count as u64;
        of_replica.saturating_mul(self.scene.ensemble.replicas)
    }

    pub(crate) fn clock(&self) -> Clock {
        match self.scene.time.unit {
            TimeUnit::Strain | TimeUnit::Second => Clock::Maps,
            TimeUnit::Period if self.runs(Stage::Translation) => Clock::Periods { ticks: self.scene.steps_per_unit() },
            TimeUnit::Period => Clock::Periods { ticks: self.scene.outputs_each() },
        }
    }

    /// The tick of an output: its step, or its index if no steps are taken.
    pub(crate) fn ticks(&self) -> impl Fn(usize) -> u64 {
        let steps = self.takes_steps().then(|| self.scene.output_steps());
        // The plan has checked that every output is near a step.
        move |output| steps.as_ref().map_or(output as u64, |steps| steps(output).round() as u64)
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scene = &self.scene;
        writeln!(f, "{}", scene.title)?;
        let duration = match scene.time.unit {
            TimeUnit::Strain => format!("strain {}", scene.time.duration),
            TimeUnit::Second => format!("{} s", scene.time.duration),
            TimeUnit::Period => format!("t/T = {}", scene.time.duration),
        };
        let steps = match self.steps() {
            0 => "no time steps: the exact motion goes straight to each output".to_owned(),
            steps => counted(steps, "time step"),
        };
        writeln!(
            f,
            "{}, {}, {duration}, {}, {steps}",
            counted(scene.particles.count as u64, "rod"),
            counted(scene.ensemble.replicas, "replica"),
            counted(self.outputs() as u64, "output"),
        )?;
        for entry in &self.entries {
            let verb = if entry.kept { "keep" } else { "drop" };
            writeln!(f, "{verb} {:<18} {}", entry.stage, entry.reason)?;
        }
        for warning in self.warnings() {
            writeln!(f, "warning: {warning}")?;
        }
        Ok(())
    }
}

/// A number of things in words, as `1 rod` and `2 rods`.
pub fn counted(count: u64, what: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {what}{plural}")
}
