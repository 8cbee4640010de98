//! One run of an interacting scene: replicas at one time step and one number of rods. Jobs are independent of each
//! other and return plain data, so that they may run anywhere.

use super::*;
use serde::Deserialize;
use shearbed::model::orientation::bounded_orbit_constant;

/// Number of values at which distribution functions are evaluated: 0.1, 0.2, … 0.9.
pub const PLACES: usize = 9;

/// The input of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Job {
    /// The scene to run; its own replicas, periods and outputs are ignored.
    pub scene: Scene,
    /// Number of replicas, counted from 0.
    pub replicas: u64,
    /// Numbers of steps after which the rods are evaluated, ascending.
    pub marks: Vec<u64>,
    /// The number of replicas, from the first, that keep the directions of their rods at the last mark.
    pub followed: u64,
}

/// The rods of one replica at one mark.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Look {
    /// X̄₁, the mean of |p_1|.
    pub x1: f64,
    /// The share of rods with |p_1| below 0.1, 0.2, … 0.9.
    pub p1_below: [f64; PLACES],
    /// The share of rods with C_b = C/(1 + C) below 0.1, 0.2, … 0.9.
    pub orbit_below: [f64; PLACES],
}

/// The results of one replica.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trace {
    /// The rods at each mark.
    pub looks: Vec<Look>,
    /// The directions at the last mark, for a replica that keeps them.
    pub directions: Vec<[f64; 3]>,
}

/// X̄₁ of each replica at the last mark.
pub fn x1(traces: &[Trace]) -> Vec<f64> {
    traces.iter().map(|trace| trace.last().x1).collect()
}

impl Trace {
    /// The rods at the last mark.
    pub fn last(&self) -> &Look {
        &self.looks[self.looks.len() - 1]
    }
}

impl Job {
    /// The scene's replicas 0 to `replicas` with `rods` rods and `steps_per_period` steps a period, evaluated after
    /// whole periods.
    pub fn new(scene: &Scene, steps_per_period: u64, rods: usize, replicas: u64, periods: u64) -> Self {
        let mut scene = scene.clone();
        scene.time =
            Time { steps_per_unit: Some(steps_per_period), outputs_per_unit: Some(1), ..Time::periods(periods as f64) };
        scene.set_count(rods);
        scene.output.drop_rods();
        scene.output.times.clear();
        Self { scene, replicas, marks: (1..=periods).map(|period| period * steps_per_period).collect(), followed: 0 }
    }

    /// The cost: rods times steps over all replicas.
    pub fn rod_steps(&self) -> u64 {
        let steps = self.marks.last().copied().unwrap_or(0);
        self.replicas * self.scene.particles.count as u64 * steps
    }

    /// Runs the job on the threads of the current pool. `finished` is called after each replica.
    pub fn run(&self, finished: &(dyn Fn() + Sync)) -> Result<Vec<Trace>, String> {
        let plan = Plan::new(&self.scene).map_err(|error| error.to_string())?;
        lab::replicas(self.replicas, |replica| {
            let trace = self.trace(&plan, replica);
            finished();
            trace
        })
    }

    fn trace(&self, plan: &Plan, replica: u64) -> Result<Trace, String> {
        let mut suspension = Suspension::new(plan, replica).ok_or("no rod can meet another: no steps to take")?;
        let mut looks = Vec::with_capacity(self.marks.len());
        for mark in &self.marks {
            while suspension.tick() < *mark {
                suspension.step().map_err(|error| error.to_string())?;
            }
            looks.push(Look::at(&suspension));
        }
        let directions = if replica < self.followed {
            suspension.directions().into_iter().map(Into::into).collect()
        } else {
            Vec::new()
        };
        Ok(Trace { looks, directions })
    }
}

impl Look {
    fn at(suspension: &Suspension) -> Self {
        let directions = suspension.directions();
        let share = 1.0 / directions.len() as f64;
        let mut look = Self {
            x1: directions.iter().map(|p| p.x.abs()).sum::<f64>() * share,
            p1_below: [0.0; PLACES],
            orbit_below: [0.0; PLACES],
        };
        for (p, aspect_ratio) in directions.iter().zip(suspension.aspect_ratios()) {
            let orbit = bounded_orbit_constant((*p).into(), aspect_ratio);
            for k in 0..PLACES {
                let place = (k + 1) as f64 / (PLACES + 1) as f64;
                look.p1_below[k] += f64::from(u8::from(p.x.abs() < place)) * share;
                look.orbit_below[k] += f64::from(u8::from(orbit < place)) * share;
            }
        }
        look
    }
}
