//! The plan of a scene: which stages run, which are left out, and why.

mod stages;

pub use stages::{Entry, Stage};

use crate::flow::VelocityGradient;
use crate::free::FreeMotion;
use crate::jeffery::{period_s, strain_per_period};
use crate::observable::Observable;
use crate::propagator::Propagator;
use crate::scene::{Invalid, Orientation, Scene, Update, resolved_strain};
use stages::entries;
pub(crate) use stages::no_interaction;
use std::fmt;
use std::sync::Arc;

/// The units in which outputs and steps are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Clock {
    /// Ticks per period of the mean aspect ratio: steps where there are steps, else outputs.
    Periods { ticks: u64 },
    /// Ticks per unit of strain: outputs.
    Strain { ticks: u64 },
}

/// The aspect ratio below which the slender limit of the rods' stress comes with a warning: a rule of thumb, for what the limit
/// leaves out falls slowly with r_e, and there is no r_e at which it becomes right.
const SLENDER: f64 = 30.0;

/// Relative difference between the mean r_e in a file and the scene's that triggers no warning: three standard errors of a few rods.
const OWN_MEAN: f64 = 0.1;

/// What a unit of time is.
///
/// ```
/// let unit = shearbed::Plan::new(&shearbed::Scene::default())?.unit();
/// assert_eq!(unit.strain, shearbed::jeffery::strain_per_period(11.6));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// In s.
    pub seconds: f64,
    /// In shear strain.
    pub strain: f64,
}

/// What will run for a scene: the scene, checked, and its stages.
///
/// ```
/// let plan = shearbed::Plan::new(&shearbed::Scene::default())?;
/// assert_eq!((plan.steps(), plan.outputs()), (0, 51)); // free rods take no steps
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Plan {
    scene: Scene,
    flow: VelocityGradient,
    /// Where rods that do not meet are, but in plane Couette flow by periods.
    free: Option<Arc<FreeMotion>>,
    entries: Vec<Entry>,
}

impl Plan {
    /// Checks the scene and decides what it needs.
    ///
    /// # Errors
    ///
    /// The first value, or combination of values, that is not allowed.
    pub fn new(scene: &Scene) -> Result<Self, Invalid> {
        let (flow, free) = scene.checked()?;
        Ok(Self {
            scene: scene.clone(),
            flow,
            free: free.map(Arc::new),
            entries: entries(scene),
        })
    }

    /// The same plan with `stage`, and what it needs, kept although the scene does not need it: for tests
    /// that leaving it out changes nothing, and for measuring what it would cost. `None` where the scene
    /// lacks what the stage works on: no `[interaction]` table, or free rods in other than plane Couette flow by periods.
    pub fn keeping(&self, stage: Stage) -> Option<Self> {
        let needs: &[Stage] = match stage {
            Stage::Translation => &[Stage::Positions],
            Stage::Neighbours => &[Stage::Translation, Stage::Positions],
            Stage::CollisionDraws => &[Stage::Translation, Stage::Positions],
            Stage::Contacts => &[
                Stage::CollisionDraws,
                Stage::Neighbours,
                Stage::Translation,
                Stage::Positions,
            ],
            _ => &[],
        };
        let in_volume = stage == Stage::Positions || !needs.is_empty();
        if in_volume && (self.scene.interaction.is_none() || self.free.is_some()) {
            return None;
        }
        let mut plan = self.clone();
        for entry in &mut plan.entries {
            if entry.stage == stage || needs.contains(&entry.stage) {
                entry.kept = true;
                entry.reason = "kept by request".to_owned();
            }
        }
        Some(plan)
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The imposed flow.
    pub fn flow(&self) -> &VelocityGradient {
        &self.flow
    }

    /// The bound on the error of free rods' directions in rad, where they do not move by the closed form of plane Couette
    /// flow. Random directions: of the map that moves them, relative to its size.
    pub fn error_rad(&self) -> Option<f64> {
        self.free.as_ref().map(|free| free.error_rad)
    }

    pub(crate) fn free(&self) -> Option<&Arc<FreeMotion>> {
        self.free.as_ref()
    }

    /// The stages, kept and dropped, in the order in which they run.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Whether a stage runs.
    pub fn keeps(&self, stage: Stage) -> bool {
        self.entries
            .iter()
            .any(|entry| entry.stage == stage && entry.kept)
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

    /// The number of outputs, the one at t = 0 included.
    pub fn outputs(&self) -> usize {
        self.scene.outputs()
    }

    /// The number of time steps; 0 where the exact motion goes straight to each output.
    pub fn steps(&self) -> u64 {
        if self.keeps(Stage::Translation) {
            (self.outputs() as u64 - 1) * self.ticks_per_output()
        } else {
            0
        }
    }

    /// What the reader of the results should know before trusting them.
    pub fn warnings(&self) -> Vec<String> {
        [
            self.unresolved_steps(),
            self.turned_straight(),
            self.unrelated_sizes(),
            self.other_mean(),
            self.drawn_for_nothing(),
            self.half_empty(),
            self.not_slender(),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Steps that are too long for the motion.
    fn unresolved_steps(&self) -> Option<String> {
        let (steps, motion) = (self.scene.steps_per_unit(), self.scene.motion_per_step());
        let resolved = resolved_strain(self.scene.particles.mean_aspect_ratio());
        (self.steps() > 0 && motion > resolved).then(|| {
            let what = match motion > 1.5 * self.unit().strain / steps as f64 {
                true => "twice the angle by which the liquid turns in a step",
                false => "the strain per step",
            };
            format!(
                "{} = {steps} does not resolve the motion: {what} is {motion:.3}, above {resolved:.3}; {} \
                 steps a {} resolve it (the default)",
                self.scene.steps_key(),
                self.scene.resolving_steps(),
                self.scene.time_unit()
            )
        })
    }

    /// Collisions that turn rods straight in a liquid that turns, other than in the paper's flow.
    fn turned_straight(&self) -> Option<String> {
        let update = self.scene.interaction.as_ref()?.update;
        let turns = self.flow.shear_rate_per_s().is_none() && self.flow.turn_per_s() > 0.0;
        (self.keeps(Stage::Contacts) && turns && update != Update::Kick).then(|| {
            "interaction.update turns colliding rods straight through a step, where free rods follow the liquid: an error ∝ Δt that \
             adds up with time in flows that turn; \"kick\" has none"
                .to_owned()
        })
    }

    /// Directions from a file for rods whose aspect ratios or lengths are drawn anew.
    fn unrelated_sizes(&self) -> Option<String> {
        let particles = &self.scene.particles;
        let (file, own) = (&particles.rods.as_ref()?.file, particles.own()?);
        let drawn = [
            (
                "aspect_ratio",
                own.aspect_ratio.is_none(),
                particles.aspect_ratio_sd_percent,
            ),
            ("length", own.length_mm.is_none(), particles.length_sd_percent),
        ];
        let (name, _, sd) =
            (drawn.into_iter()).find(|(_, lacks, sd)| own.p.is_some() && *lacks && *sd > 0.0)?;
        Some(format!(
            "particles.{name}_sd_percent = {sd} draws each rod's {} anew, unrelated to its direction in {file}: to \
             continue a suspension of unequal rods, give the file that column too, as rods.csv has it",
            name.replace('_', " ")
        ))
    }

    /// A mean r_e of the rods of a file that is far from the scene's.
    fn other_mean(&self) -> Option<String> {
        let particles = &self.scene.particles;
        let mean = particles.mean_aspect_ratio();
        let near = (mean / particles.aspect_ratio - 1.0).abs() <= OWN_MEAN;
        (!near).then(|| {
            format!(
                "particles.aspect_ratio = {} sets only the period T and the output times: the rods in particles.rods have a mean of \
                 {mean:.4}",
                particles.aspect_ratio
            )
        })
    }

    /// Keys that have no effect because the file gives what they would draw.
    fn drawn_for_nothing(&self) -> Option<String> {
        let particles = &self.scene.particles;
        let own = particles.own()?;
        let unused = [
            (
                "orientation",
                own.p.is_some() && particles.orientation != Orientation::default(),
            ),
            (
                "aspect_ratio_sd_percent",
                own.aspect_ratio.is_some() && particles.aspect_ratio_sd_percent > 0.0,
            ),
            (
                "length_sd_percent",
                own.length_mm.is_some() && particles.length_sd_percent > 0.0,
            ),
        ];
        let unused = unused.into_iter().filter(|(_, is)| *is);
        let unused: Vec<_> = unused.map(|(key, _)| format!("particles.{key}")).collect();
        (!unused.is_empty()).then(|| {
            format!(
                "{} has no effect: particles.rods gives it for each rod",
                unused.join(", ")
            )
        })
    }

    /// Places that leave part of the control volume empty, as they would after a change of its size.
    fn half_empty(&self) -> Option<String> {
        let (places, sides) = (
            self.scene.particles.own()?.place_mm.as_ref()?,
            self.scene.sides_mm()?,
        );
        let farthest = |axis: &Vec<f64>| axis.iter().copied().fold(0.0, f64::max);
        let short = places.iter().map(farthest).zip(sides);
        // n uniform places all lie within this share of a side by chance once in a million.
        let rods = places[0].len() as f64;
        let by_chance = |share: f64| libm::pow(share, rods) < 1e-6;
        let (axis, (farthest, side)) =
            (short.enumerate()).find(|(_, (farthest, side))| by_chance(farthest / side))?;
        Some(format!(
            "the places in particles.rods reach only {farthest} of {side} mm along axis {}: check that they belong to this control volume",
            axis + 1
        ))
    }

    /// A stress of slender rods for rods that are not.
    fn not_slender(&self) -> Option<String> {
        let r = self.scene.particles.mean_aspect_ratio();
        (self.keeps(Stage::Observe(Observable::ParticleStress)) && r < SLENDER).then(|| {
            format!(
                "particle_stress is the limit of slender rods, r_e ≫ 1: at aspect_ratio = {r} the terms that it leaves out \
                 are not small (docs/coefficients.md)"
            )
        })
    }

    /// The name of the time column: `t_over_T`, or `strain` where the scene's time is a strain.
    pub fn time_name(&self) -> &'static str {
        if self.scene.time.strain.is_some() {
            "strain"
        } else {
            "t_over_T"
        }
    }

    /// The seconds, and the shear strain ∫(2D:D)^½ dt, of one unit of [`Plan::times`].
    pub fn unit(&self) -> Unit {
        let r = self.scene.particles.aspect_ratio;
        let rate_per_s = self.flow.magnitude_per_s();
        match (self.scene.time.strain, self.flow.shear_rate_per_s()) {
            (Some(_), _) => Unit {
                seconds: 1.0 / rate_per_s,
                strain: 1.0,
            },
            (None, Some(shear_rate_per_s)) => Unit {
                seconds: period_s(shear_rate_per_s, r),
                strain: strain_per_period(r),
            },
            (None, None) => {
                let seconds = Propagator::new(&self.flow, r).period_s().unwrap_or(f64::NAN);
                Unit {
                    seconds,
                    strain: seconds * rate_per_s,
                }
            }
        }
    }

    /// The times of the outputs, in periods or units of strain.
    pub fn times(&self) -> Vec<f64> {
        let per_unit = self.scene.outputs_per_unit();
        (0..self.outputs()).map(|k| k as f64 / per_unit as f64).collect()
    }

    /// The outputs at which every rod is wanted, in the order of time.
    pub fn rods_outputs(&self) -> Vec<usize> {
        let times = self.scene.output.rods_at.iter();
        times.filter_map(|time| self.scene.output_at(*time)).collect()
    }

    /// All rods that are wanted: of each replica at each of these outputs.
    pub fn rods_out(&self) -> u64 {
        let of_replica = self.scene.output.rods_at.len() as u64 * self.scene.particles.count as u64;
        of_replica.saturating_mul(self.scene.ensemble.replicas)
    }

    pub(crate) fn clock(&self) -> Clock {
        match self.scene.time.strain {
            Some(_) => Clock::Strain {
                ticks: self.scene.outputs_per_strain(),
            },
            None => Clock::Periods {
                ticks: self.scene.outputs_per_period() * self.ticks_per_output(),
            },
        }
    }

    /// Steps between outputs; 1 where no steps are taken.
    pub(crate) fn ticks_per_output(&self) -> u64 {
        if self.keeps(Stage::Translation) {
            self.scene.steps_per_unit() / self.scene.outputs_per_unit()
        } else {
            1
        }
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scene = &self.scene;
        writeln!(f, "{}", scene.title)?;
        let duration = match scene.time.strain {
            Some(strain) => format!("strain {strain}"),
            None => format!("t/T = {}", scene.time.periods.unwrap_or(0.0)),
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

fn counted(count: u64, what: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {what}{plural}")
}
