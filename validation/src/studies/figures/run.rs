//! The built-in scenes of the figures, run replica by replica, and their curves.

use super::*;
use crate::files::cluster;
use crate::input::scenes::{self, BuiltIn};
use crate::methods::derived::{Derived, Estimate, Extreme};
use crate::present::study::ScenePlan;
use shearbed::run::Replica;
use shearbed::run::ensemble::{Tally, group_sizes};
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

#[derive(Clone)]
pub(super) struct Run {
    plan: Arc<Plan>,
    replicas: Arc<Vec<Replica>>,
    /// The ± of a sample.
    error: fn(Sample) -> f64,
}

impl Run {
    /// The times of the outputs, t/T.
    pub(super) fn times(&self) -> Vec<f64> {
        self.plan.times()
    }

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
        self.with_errors(label, times.iter().copied().zip((0..times.len()).map(sample)))
    }

    /// A channel's mean against t/T with its ±.
    pub(super) fn curve(&self, channel: &str, label: impl Into<String>) -> Curve {
        let times = self.times();
        let samples = (0..times.len()).map(|output| self.sample(channel, |mean| mean(output)));
        self.with_errors(label, times.iter().copied().zip(samples))
    }

    fn with_errors(&self, label: impl Into<String>, samples: impl Iterator<Item = (f64, Sample)>) -> Curve {
        Curve::with_band(label, samples, |at| self.point(at))
    }

    /// A sample at an abscissa as abscissa, mean and ±.
    pub(super) fn point(&self, (x, sample): (f64, Sample)) -> (f64, f64, f64) {
        (x, sample.mean, (self.error)(sample))
    }
}

/// The runs of all scenes, by the scenes' names. Scenes that differ only in their titles share a run. Their ± are 95 %
/// by Student's t.
pub(super) struct Runs(BTreeMap<&'static str, Run>);

impl Runs {
    /// Runs the scenes over all ranks; `finished` is called on the root for each replica, after its scene. `None`
    /// except on the root.
    pub(super) fn new(plans: Vec<(&'static str, Plan)>, finished: &dyn Fn()) -> Result<Option<Self>, String> {
        let untitled = |plan: &Plan| Scene { title: String::new(), ..plan.scene().clone() };
        let first = |k: usize| plans.iter().position(|other| untitled(&other.1) == untitled(&plans[k].1));
        let own: Vec<_> = (0..plans.len()).filter(|k| first(*k) == Some(*k)).collect();
        let job = |job: usize| {
            let (name, plan) = &plans[own[job]];
            let replicas = 0..plan.scene().ensemble.replicas;
            ensemble::replicas_of(plan, replicas, &|| ()).map_err(|error| format!("{name}: {error}"))
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
            let plan = Arc::new(plans[*k].1.clone());
            (*k, Run { plan, replicas: Arc::new(replicas), error: Sample::half_width })
        };
        let runs: BTreeMap<usize, Run> = own.iter().zip(results).map(run).collect();
        let named = (0..plans.len()).filter_map(|k| Some((plans[k].0, runs.get(&first(k)?)?.clone())));
        Ok(Some(Self(named.collect())))
    }

    /// The same with standard errors as ±.
    pub(super) fn with_standard_errors(&self) -> Self {
        let run = |(name, run): (&&'static str, &Run)| (*name, Run { error: |sample| sample.se, ..run.clone() });
        Self(self.0.iter().map(run).collect())
    }

    pub(super) fn get(&self, name: &str) -> Result<&Run, String> {
        self.0.get(name).ok_or_else(|| format!("{name}: no figure's scene has this name"))
    }
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

/// A₁, the amplitude of the oscillation of X̄₁ (Figs 7 to 10), against t/T: of each maximum beyond noise.
pub(super) fn amplitude(run: &Run, label: impl Into<String>) -> Curve {
    let mut tally = Tally::new(&run.plan);
    run.replicas.iter().cloned().for_each(|replica| tally.add(replica));
    let replicas = tally.replicas();
    let results = tally.results(&run.plan);
    let derived = results.column("x1").map(|x1| Derived::new(&results.times, x1, replicas));
    let extremes = derived.map(|derived| derived.extremes).unwrap_or_default();
    let sample = |extreme: Extreme| {
        let Estimate { value, se } = extreme.amplitude?;
        Some((extreme.time.value, Sample { mean: value, se: se?, samples: group_sizes(replicas).count() as u64 }))
    };
    run.with_errors(label, extremes.into_iter().filter_map(sample))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_a_curve_is_half_of_95_percent_or_a_standard_error() {
        let mut scene = scenes::find("fig6-uniform").unwrap().scene().unwrap();
        (scene.ensemble.replicas, scene.particles.count) = (3, 10);
        let runs = Runs::new(vec![("few", Plan::new(&scene).unwrap())], &|| ()).unwrap().unwrap();
        let error = |runs: &Runs| runs.get("few").unwrap().curve("x1", "").half_band.unwrap()[1];
        // Student's t with two degrees of freedom.
        assert!((error(&runs) / error(&runs.with_standard_errors()) - 4.3027).abs() < 1e-4);
    }
}
