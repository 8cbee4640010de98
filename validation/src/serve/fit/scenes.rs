//! Scenes as a model of measured points: sets keys of scenes to values, runs the replicas, and evaluates them at the
//! points' times.

mod one_length;

use super::data::TimeColumn;
use super::error::{SceneError, Warning};
use super::range::Range;
use super::runs::{Runs, key};
use crate::input::scenes;
use crate::input::start::Starts;
use crate::methods::interpolate::interpolate;
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::basis::grid;
use crate::methods::least_squares::emulator::{Part, Prediction, Replica};
use crate::serve::sweep::{self, KeyValue};
use shearbed::observable::Channel;
use shearbed::run::run_replica;
use shearbed::scene::{Holds, Output, keys};
use shearbed::{Observable, Plan, Scene};
use std::sync::Arc;
use toml::Value;

/// A scene with the times and columns at which it was measured.
#[derive(Clone, Debug)]
pub struct Set {
    /// The scene's name or file, for messages.
    pub source: String,
    /// The text of the scene's file.
    pub text: String,
    /// The initial directions of rods that are given in a file beside the scene, read once for all values of the
    /// parameters.
    pub starts: Starts,
    /// Keys whose values differ from the text, the same for all values of the parameters.
    pub settings: Vec<KeyValue>,
    /// The seed of all random numbers.
    pub seed: u64,
    /// The unit of the points' times.
    pub time: TimeColumn,
}

impl Set {
    /// A built-in scene with keys that are set as `KEY=VALUE`.
    ///
    /// # Errors
    ///
    /// A setting of another form, or a name of no scene.
    pub fn built_in(name: &str, settings: &[String], seed: u64, time: TimeColumn) -> Result<Self, String> {
        let text = scenes::find(name).ok_or("no scene")?.text.into();
        let settings = settings.iter().map(|setting| KeyValue::parse(setting)).collect::<Result<_, _>>()?;
        Ok(Self { source: name.into(), text, starts: Starts::default(), settings, seed, time })
    }
}

/// A change of the model from the scene as written, to measure its effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Number of steps, in multiples of the scene's.
    pub steps: u64,
    /// Number of rods, in multiples of the scene's.
    pub rods: usize,
    /// True if all rods have the mean r_e.
    pub one_aspect_ratio: bool,
}

/// The scene as written.
pub const AS_WRITTEN: Variant = Variant { steps: 1, rods: 1, one_aspect_ratio: false };

/// Several scenes, with parameters that they share or that belong to one of them.
#[derive(Clone, Debug)]
pub struct Scenes {
    /// The scenes.
    pub sets: Vec<Set>,
    /// The parameters.
    pub ranges: Vec<Range>,
    /// Steps per period or unit of strain of each scene, the same for all parameter values, so that the random numbers
    /// stay the same.
    steps: Vec<u64>,
    /// Finished runs, if they outlive the fit.
    runs: Option<Arc<Runs>>,
}

/// √3: the outer nodes of Gauss–Hermite quadrature, in standard deviations.
const OUTER: f64 = 1.732_050_807_568_877_2;

/// Outputs per unit of strain, for scenes whose unit of time is the strain.
const PER_STRAIN: u64 = 40;

/// Outputs per period of free rods with a common initial direction: |p_i| has a kink where p_i changes its sign, for
/// all rods at once, which a cubic between outputs rounds off by an error in proportion to the outputs' distance.
const KINKED: u64 = 5000;

impl Scenes {
    /// Checks every scene at all corners of the ranges. An error says which scene, which values, and why.
    pub fn new(sets: Vec<Set>, ranges: Vec<Range>) -> Result<Self, SceneError> {
        let is_whole =
            |range: &&Range| keys().any(|key| key.path == range.key && matches!(key.holds, Holds::Whole { .. }));
        if let Some(range) = ranges.iter().find(is_whole) {
            return Err(SceneError::Whole(range.label()));
        }
        let mut scenes = Self { steps: vec![0; sets.len()], sets, ranges, runs: None };
        for set in 0..scenes.sets.len() {
            for corner in scenes.corners() {
                let scene = scenes.scene(set, &corner)?;
                scenes.says_something(set, &scene)?;
                scenes.steps[set] = scenes.steps[set].max(scene.steps_per_unit());
            }
        }
        Ok(scenes)
    }

    /// Refuses to fit what no curve depends on: the interaction of rods that never disturb each other; the shear rate
    /// where times are strains or periods, but for diffusion.
    fn says_something(&self, set: usize, scene: &Scene) -> Result<(), SceneError> {
        let of_rate = |range: &&Range| range.is_of(set) && range.key == "flow.shear_rate_per_s";
        let free_of_it = self.sets[set].time != TimeColumn::Seconds && scene.particles.rotary_diffusion_per_s == 0.0;
        if let Some(range) = self.ranges.iter().find(of_rate).filter(|_| free_of_it) {
            return Err(SceneError::Parameters {
                scene: self.sets[set].source.clone(),
                parameters: vec![range.label()],
                why: "means are functions of the strain Gt, which the points' times give, so they do not determine G; \
                      times as t_s do"
                    .to_owned(),
            });
        }
        let fitted = self.ranges.iter().find(|range| range.is_of(set) && range.key.starts_with("interaction."));
        match (fitted, scene.particles.undisturbed()) {
            (Some(range), Some(why)) => Err(SceneError::Parameters {
                scene: self.sets[set].source.clone(),
                parameters: vec![range.label()],
                why: format!(
                    "{why}: such rods disturb each other in this model only by the error of a time step, so their \
                     points do not determine it. Lee & Springer leave such points out (r_e = 3.96; Results, after \
                     Fig. 5). Keys of particles and flow are allowed"
                ),
            }),
            _ => Ok(()),
        }
    }

    /// Warnings about points in periods whose length is fitted.
    pub fn moving_points(&self) -> impl Iterator<Item = Warning> {
        let in_periods = |range: &&Range| {
            let mut sets = self.sets.iter().enumerate();
            sets.any(|(set, own)| range.is_of(set) && own.time == TimeColumn::Periods)
        };
        let of_shape = |range: &&Range| range.key == "particles.aspect_ratio";
        self.ranges.iter().filter(of_shape).filter(in_periods).map(|range| {
            Warning::Other(format!(
                "{}: t_over_T counts periods of the fitted r_e, so the points move with it; times as t_s or strain do \
                    not",
                range.label()
            ))
        })
    }

    /// The end of the set's scene with these values, in the unit of its points' times.
    pub fn end(&self, set: usize, values: &[f64]) -> Result<f64, SceneError> {
        let plan = Plan::new(&self.scene(set, values)?).map_err(|error| self.refused(set, &error.to_string()))?;
        (self.sets[set].time.end_of(&plan)).ok_or_else(|| self.refused(set, "has no period"))
    }

    fn refused(&self, set: usize, why: &str) -> SceneError {
        SceneError::Scene { scene: self.sets[set].source.clone(), why: why.to_owned() }
    }

    /// The same scenes at `factor` times their concentration, and that concentration; none for rods that do not
    /// interact, or whose concentration is fitted. A box is scaled in proportion.
    pub fn at_concentration(&self, factor: f64, values: &[f64]) -> Result<(Self, Vec<Option<f64>>), SceneError> {
        const KEY: &str = "interaction.concentration_per_cm3";
        const BOX: &str = "interaction.box_mm";
        const FRACTION: &str = "particles.volume_fraction";
        let (mut scenes, mut all) = (self.clone(), Vec::new());
        for set in 0..self.sets.len() {
            let fitted =
                (self.ranges.iter()).any(|range| range.is_of(set) && [KEY, FRACTION].contains(&&range.key[..]));
            let scene = self.scene(set, values)?;
            let own = scene.concentration_per_cm3().filter(|_| !fitted);
            let concentration = own.map(|own| factor * own);
            if let (Some(value), Some(interaction)) = (concentration, scene.interaction) {
                let side = |side: f64| Value::Float(side / factor.cbrt());
                let sides = interaction.box_mm;
                let sides = sides.map(|sides| Value::Array(sides.map(side).to_vec()));
                let given = interaction.concentration_per_cm3.map(|_| Value::Float(value));
                let settings = &mut scenes.sets[set].settings;
                let fraction = scene.particles.volume_fraction.map(|fraction| Value::Float(factor * fraction));
                for (key, value) in [(KEY, given), (BOX, sides), (FRACTION, fraction)] {
                    settings.retain(|setting| setting.key != key);
                    let key = key.to_owned();
                    settings.extend(value.map(|value| KeyValue { key, value }));
                }
            }
            all.push(concentration);
        }
        Ok((scenes, all))
    }

    fn corners(&self) -> Vec<Vec<f64>> {
        let corner =
            |ends: Vec<usize>| self.ranges.iter().zip(ends).map(|(range, end)| [range.from, range.to][end]).collect();
        grid(self.ranges.len(), 2).into_iter().map(corner).collect()
    }

    /// The scene of a set with these values; the other keys are as in its file.
    pub fn scene(&self, set: usize, values: &[f64]) -> Result<Scene, SceneError> {
        let Set { source, text, starts, settings, seed, .. } = &self.sets[set];
        let own = || self.ranges.iter().zip(values).filter(|(range, _)| range.is_of(set));
        let fitted = own().map(|(range, value)| KeyValue { key: range.key.clone(), value: Value::Float(*value) });
        let settings: Vec<_> = settings.iter().cloned().chain(fitted).collect();
        let mut filled = starts.clone();
        let mut scene = sweep::scene_with(text, &settings)
            .and_then(|mut scene| filled.fill(&mut scene).map(|()| scene))
            .map_err(|why| SceneError::Parameters {
                scene: source.clone(),
                parameters: own().map(|(range, value)| format!("{}={value}", range.label())).collect(),
                why,
            })?;
        scene.ensemble.seed = *seed;
        Ok(scene)
    }

    /// The plans of all scenes with these values, each until the last time in `data` (in the unit of its set), with an
    /// output in every step.
    pub fn plans(&self, values: &[f64], data: &[Datum], variant: Variant) -> Result<Vec<Plan>, SceneError> {
        (0..self.sets.len()).map(|set| self.plan(set, values, data, variant)).collect()
    }

    fn plan(&self, set: usize, values: &[f64], data: &[Datum], variant: Variant) -> Result<Plan, SceneError> {
        let refused = |why: &str| self.refused(set, why);
        let mut scene = self.scene(set, values)?;
        let own = Plan::new(&scene).map_err(|error| refused(&error.to_string()))?;
        if scene.flow.steps().is_some() {
            let why = "a fit needs one flow throughout: shear_rate_per_s or gradient_per_s in place of flow.steps";
            return Err(refused(why));
        }
        let per_unit = self.sets[set]
            .time
            .per_unit(&own)
            .ok_or_else(|| refused("has no period: times as t_s or strain are allowed, not t_over_T"))?;
        let here = data.iter().filter(|datum| datum.set == set);
        let last = crate::oracle::worst(here.map(|datum| (datum.time + OUTER * datum.u_time) / per_unit));
        // One output more than the last point needs, for the cubic interpolation.
        let kinked = scene.interaction.is_none() && scene.particles.common_start_deg().is_some();
        let by_period = scene.time.unit == shearbed::scene::TimeUnit::Period;
        let outputs = match (&scene.interaction, by_period) {
            (Some(_), _) => self.steps[set],
            (None, false) => (scene.outputs_per_unit()).max(if kinked { KINKED / 10 } else { PER_STRAIN }),
            (None, true) => self.steps[set].max(if kinked { KINKED } else { 1 }),
        };
        scene.time.duration = ((last * outputs as f64).ceil() + 1.0) / outputs as f64;
        scene.time.outputs_per_unit = Some(outputs);
        scene.time.steps_per_unit = scene.interaction.as_ref().map(|_| outputs * variant.steps);
        scene.set_count(scene.particles.count * variant.rods);
        if variant.one_aspect_ratio {
            scene.particles.aspect_ratio_sd_percent = 0.0;
        }
        let needed = |observable: &Observable| {
            let mut channels = observable.channels();
            channels.any(|channel| data.iter().any(|datum| datum.set == set && datum.column == channel.name()))
        };
        let observables = Observable::ALL.into_iter().filter(needed).collect();
        scene.output = Output { observables, ..Output::default() };
        Plan::new(&scene).map_err(|error| refused(&error.to_string()))
    }

    /// True if replicas of any scene differ with some values of the parameters.
    pub fn draw(&self, data: &[Datum]) -> Result<bool, SceneError> {
        let of = |corner: Vec<f64>| Ok(self.plans(&corner, data, AS_WRITTEN)?.iter().any(Plan::draws));
        self.corners().into_iter().map(of).try_fold(false, |any, one: Result<bool, SceneError>| Ok(any || one?))
    }

    /// The same scenes, with runs that a checkpoint has and takes.
    #[must_use]
    pub fn with_runs(self, runs: Option<Arc<Runs>>) -> Self {
        Self { runs, ..self }
    }

    /// The model of the points `data` at these parameter values.
    pub fn model(&self, data: &[Datum], variant: Variant, values: &[f64]) -> Result<Replica, SceneError> {
        let part = |(set, plan): (usize, Plan)| {
            let looks = looks(&plan, self.sets[set].time, data, set);
            let own = self.ranges.iter().zip(values).filter(|(range, _)| range.is_of(set));
            let depends_on = std::iter::once(set as u64).chain(own.map(|(_, value)| value.to_bits()));
            let depends_on = Some(depends_on.collect());
            let Some(runs) = self.runs.clone() else {
                return Part { depends_on, run: Box::new(move |replica| predict(&plan, &looks, replica)) };
            };
            let key = key((set, serde_json::to_string(&plan.scene().resolved()).ok(), format!("{looks:?}")));
            let run = move |replica| runs.run(key, replica, || predict(&plan, &looks, replica));
            Part { depends_on, run: Box::new(run) }
        };
        Ok(Replica(self.plans(values, data, variant)?.into_iter().enumerate().map(part).collect()))
    }
}

/// The place of one point in the outputs of a scene.
#[derive(Clone, Copy, Debug)]
struct Look {
    point: usize,
    channel: Channel,
    /// Its time, and the standard uncertainty of that, in outputs.
    outputs: f64,
    u_outputs: f64,
}

fn looks(plan: &Plan, time: TimeColumn, data: &[Datum], set: usize) -> Vec<Look> {
    let per_output = plan.times().get(1).copied().unwrap_or(1.0) * time.per_unit(plan).unwrap_or(f64::NAN);
    let here = data.iter().enumerate().filter(|(_, datum)| datum.set == set);
    here.filter_map(|(point, datum)| {
        Some(Look {
            point,
            channel: Channel::named(&datum.column)?,
            outputs: datum.time / per_output,
            u_outputs: datum.u_time / per_output,
        })
    })
    .collect()
}

fn predict(plan: &Plan, looks: &[Look], replica: u64) -> Result<Vec<(usize, Prediction)>, String> {
    let found = run_replica(plan, replica).map_err(|error| error.to_string())?;
    let one = |look: &Look| {
        let mean = |output: usize| found.mean(look.channel, output).unwrap_or(f64::NAN);
        let at = |outputs: f64| interpolate(plan.outputs(), outputs, 4, &mean);
        (look.point, [0.0, -OUTER, OUTER].map(|side| at(look.outputs + side * look.u_outputs)))
    };
    Ok(looks.iter().map(one).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether two keys are told apart depends on what is fitted, and on whether another length is in the scene.
    #[test]
    fn keys_of_one_length_are_not_fitted_together() {
        const TEXT: &str = "title = 't'\nflow = { shear_rate_per_s = 1 }\ntime = { periods = 1 }\n[particles]\n\
            count = 10\nlength_mm = 1\naspect_ratio = 15\norientation = 'isotropic'\nFRACTION\n\
            [interaction]\nalpha = 0.5\nCONCENTRATION\n";
        let n = TEXT.replace("FRACTION", "").replace("CONCENTRATION", "concentration_per_cm3 = 50");
        let fraction = TEXT.replace("FRACTION", "volume_fraction = 0.001").replace("CONCENTRATION", "");
        let box_mm = TEXT.replace("FRACTION", "").replace("CONCENTRATION", "box_mm = [5, 5, 5]");
        let refused = |text: &str, sets: usize, settings: &[&str], over: &[&str], column: &str| {
            let set = Set {
                source: "s.toml".into(),
                text: text.into(),
                starts: Starts::default(),
                settings: settings.iter().map(|setting| KeyValue::parse(setting).unwrap()).collect(),
                seed: 1,
                time: TimeColumn::Seconds,
            };
            let ranges = over.iter().map(|range| Range::parse(range).unwrap()).collect();
            let datum = |set| Datum { set, line: 2, column: column.into(), time: 1.0, value: 0.5, u_time: 0.0, u: 0.1 };
            let scenes = Scenes::new(vec![set; sets], ranges).unwrap();
            let refused = scenes.one_length(&(0..sets).map(datum).collect::<Vec<_>>());
            refused.map_or_else(|error| error.to_string(), |()| String::new())
        };
        let (alpha, length, m) = ("interaction.alpha=0.1:1", "particles.length_mm=0.5:1", "interaction.m=2:4");
        let (per_cm3, of_second) =
            ("interaction.concentration_per_cm3=10:90", "2:interaction.concentration_per_cm3=10:90");
        let part = "particles.volume_fraction=0.001:0.01";
        let of_first = "1:interaction.concentration_per_cm3=10:90";
        for (text, sets, over) in [
            (&n, 1, &[alpha, per_cm3][..]),
            (&n, 1, &[alpha, length]),
            (&n, 1, &[length, per_cm3]),
            (&n, 1, &[alpha, m, length]),
            (&n, 2, &[alpha, per_cm3]),
            (&n, 2, &[alpha, of_first, of_second]),
            (&fraction, 1, &[alpha, part]),
            (&fraction, 1, &[length]),
            (&box_mm, 1, &[alpha, length]),
        ] {
            // The scatter of lengths is relative: it is no length of its own.
            for scatter in [&[][..], &["particles.length_sd_percent=10"]] {
                let why = refused(text, sets, scatter, over, "x1");
                assert!(why.contains("by α·a·n^(1/3) alone; fix "), "{over:?}: {why}");
            }
        }
        for (text, sets, settings, over, column) in [
            (&n, 1, &[][..], &[alpha, m][..], "x1"),
            (&n, 1, &[], &[length], "x1"),
            (&n, 2, &[], &[alpha, of_second], "x1"),
            (&n, 1, &["interaction.min_contact_arm=0.1"], &[alpha, per_cm3], "x1"),
            (&n, 1, &["liquid.viscosity_pa_s=1"], &[alpha, per_cm3], "s12_pa"),
            (&box_mm, 1, &[], &[alpha, m], "x1"),
            (&box_mm, 1, &["interaction.min_contact_arm=0.1"], &[alpha, length], "x1"),
            (&fraction, 1, &[], &[alpha, "particles.aspect_ratio=10:20"], "x1"),
        ] {
            assert_eq!(refused(text, sets, settings, over, column), "", "{settings:?} {over:?}");
        }
    }
}
