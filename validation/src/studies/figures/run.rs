//! The built-in scenes of the figures, run replica by replica, and their curves.

use super::*;
use crate::files::cluster;
use crate::input::scenes::{self, BuiltIn};
use crate::present::study::ScenePlan;
use shearbed::run::Replica;
use std::sync::Arc;

/// The number of replicas of each scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replicas {
    /// Replicas of a scene with interaction, usually of 100 rods each.
    pub interacting: u64,
    /// Replicas of a scene of free rods, usually of 10 000 rods each.
    pub free: u64,
}

impl Replicas {
    /// The number for a quick or a full run. The quick run of an interacting scene has the number in the scene's file.
    pub fn of(effort: &Effort) -> Self {
        Self { interacting: effort.pick(100, 1000), free: effort.pick(20, 200) }
    }
}

/// A scene's replicas.
pub(super) struct Run {
    plan: Plan,
    replicas: Vec<Replica>,
}

impl Run {
    /// The times of the outputs, t/T.
    pub(super) fn times(&self) -> Vec<f64> {
        self.plan.times()
    }

    /// The scene.
    pub(super) fn scene(&self) -> &Scene {
        self.plan.scene()
    }

    /// The sample over replicas of `value`, a function of a channel's means against time. Empty if the scene
    /// does not observe the channel.
    pub(super) fn sample(&self, channel: &str, value: impl Fn(&dyn Fn(usize) -> f64) -> f64) -> Sample {
        Sample::of(self.values(channel, value))
    }

    /// `value` for each replica.
    fn values(&self, channel: &str, value: impl Fn(&dyn Fn(usize) -> f64) -> f64) -> Vec<f64> {
        let channel = Channel::named(channel);
        let observed = |replica: &Replica| channel.is_some_and(|channel| replica.mean(channel, 0).is_some());
        let mean =
            |replica: &Replica, output| channel.and_then(|channel| replica.mean(channel, output)).unwrap_or(f64::NAN);
        let replicas = self.replicas.iter().filter(|replica| observed(replica));
        replicas.map(|replica| value(&|output| mean(replica, output))).collect()
    }

    /// A channel's mean less that of another scene with the same outputs, from pairs of replicas with the same random
    /// numbers.
    pub(super) fn less(&self, other: &Self, channel: &str, label: impl Into<String>) -> Curve {
        let times = self.times();
        let sample = |output: usize| {
            let [own, other] = [self, other].map(|run| run.values(channel, |mean| mean(output)));
            Sample::of_differences(&own, &other)
        };
        with_band(label, times.iter().copied().zip((0..times.len()).map(sample)))
    }

    /// A channel's mean against t/T with its 95 % band.
    pub(super) fn curve(&self, channel: &str, label: impl Into<String>) -> Curve {
        let times = self.times();
        let samples = (0..times.len()).map(|output| self.sample(channel, |mean| mean(output)));
        with_band(label, times.iter().copied().zip(samples))
    }
}

/// A curve through samples, with a band of 95 % by Student's t.
pub(super) fn with_band(label: impl Into<String>, samples: impl Iterator<Item = (f64, Sample)>) -> Curve {
    Curve::with_band(label, samples, |(x, sample)| (x, sample.mean, sample.half_width()))
}

/// The runs of all scenes, by the scenes' names. Scenes that differ only in their titles share a run.
pub(super) struct Runs(BTreeMap<&'static str, Arc<Run>>);

impl Runs {
    /// Runs the scenes over all ranks; `finished` is called on the root for each replica, after its scene. `None`
    /// except on the root.
    pub(super) fn new(plans: Vec<(&'static str, Plan)>, finished: &dyn Fn()) -> Result<Option<Self>, String> {
        let alike = |a: &(_, Plan), b: &(_, Plan)| same(a.1.scene(), b.1.scene());
        let first = |k: usize| plans.iter().position(|other| alike(other, &plans[k]));
        let own: Vec<_> = (0..plans.len()).filter(|k| first(*k) == Some(*k)).collect();
        let job = |job: usize| {
            let (name, plan) = &plans[own[job]];
            replicas(plan).map_err(|error| format!("{name}: {error}"))
        };
        let arrived = |job: usize, _: &_| {
            let shared = (0..plans.len()).filter(|k| first(*k) == Some(own[job]));
            let replicas: u64 = shared.map(|k| plans[k].1.scene().ensemble.replicas).sum();
            (0..replicas).for_each(|_| finished());
            Ok(())
        };
        let Some(results) = cluster::share(own.len(), job, arrived)? else {
            return Ok(None);
        };
        let run = |(k, replicas): (&usize, _)| {
            let plan = plans[*k].1.clone();
            (*k, Arc::new(Run { plan, replicas }))
        };
        let runs: BTreeMap<usize, Arc<Run>> = own.iter().zip(results).map(run).collect();
        let named = (0..plans.len()).filter_map(|k| Some((plans[k].0, runs.get(&first(k)?)?.clone())));
        Ok(Some(Self(named.collect())))
    }

    /// The run of a scene.
    pub(super) fn get(&self, name: &str) -> Result<&Run, String> {
        let run = self.0.get(name);
        run.map(Arc::as_ref).ok_or_else(|| format!("{name}: no figure's scene has this name"))
    }
}

/// Every replica of a scene.
fn replicas(plan: &Plan) -> Result<Vec<Replica>, String> {
    let replicas = 0..plan.scene().ensemble.replicas;
    ensemble::replicas_of(plan, replicas, &|| ()).map_err(|error| error.to_string())
}

/// True if two scenes differ only in their titles.
fn same(a: &Scene, b: &Scene) -> bool {
    let untitled = |scene: &Scene| Scene { title: String::new(), ..scene.clone() };
    untitled(a) == untitled(b)
}

/// The plans of the figures' scenes, with the number of replicas in `replicas`.
pub(super) fn plans(replicas: Replicas) -> Result<Vec<(&'static str, Plan)>, String> {
    let scenes = scenes::ALL.iter().filter(|scene| scene.name.starts_with("fig"));
    let plan = |built_in: &BuiltIn| {
        let mut scene = built_in.scene().map_err(|error| error.to_string())?;
        scene.ensemble.replicas = match scene.interaction {
            Some(_) => replicas.interacting,
            None => replicas.free,
        };
        let plan = Plan::new(&scene).map_err(|error| format!("{}: {error}", built_in.name))?;
        Ok((built_in.name, plan))
    };
    scenes.map(plan).collect()
}

/// The report's entry for a plan.
pub(super) fn shown((name, plan): &(&'static str, Plan)) -> ScenePlan {
    let ensemble = &plan.scene().ensemble;
    ScenePlan {
        scene: (*name).into(),
        title: plan.scene().title.clone(),
        seed: ensemble.seed,
        command: format!("cargo run --release -- run {name} --replicas {}", ensemble.replicas),
        text: plan.to_string(),
    }
}
