//! Interacting rods in the control volume, step by step (the paper's method of solution).
//!
//! A [`Suspension`] is one replica: places, directions since the last collision, and its random streams. It may use
//! `plan` and the parts before it. A rod's state is added in `rods`, whose `state` is what a checkpoint keeps.

pub(crate) mod diffusion;
mod liquid;
pub(crate) mod rods;
pub mod snapshot;
#[cfg(test)]
mod tests;

use crate::model::chunks::CHUNK;
use crate::model::collision::{Reach, kick, norm, share_velocity, step_angles, turn};
use crate::model::contact::contact;
use crate::model::jeffery::shape_factor;
use crate::model::neighbours::{Nearest, Neighbours};
use crate::model::random::{Purpose, ahead, stream};
use crate::model::work::Counters;
use crate::plan::{Plan, Stage};
use crate::scene::{Error, Update};
use crate::suspension::rods::Rods;
use liquid::Liquid;
use nalgebra::{UnitVector3, Vector3};
use rand::RngExt;
use rand_pcg::Pcg64Dxsm;
use rayon::prelude::*;

/// A collision of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// The rod that drew R, and its nearest neighbour.
    pub rods: [usize; 2],
    /// |ṗ′|Δt: the angles in rad by which the two rods turned.
    pub angles_rad: [f64; 2],
    /// |ṗ′ − ṗ|Δt: the part due to the collision, in rad.
    pub kicks_rad: [f64; 2],
}

/// One replica of an interacting scene, with lengths in mean rod lengths.
///
/// Each step finds neighbours, draws and contacts from the state at its start; then every orientation moves;
/// then every position, with replacements.
///
/// ```
/// use shearbed::scene::{Interaction, Scene};
/// let scene = Scene { interaction: Some(Interaction::default()), ..Scene::default() };
/// let plan = shearbed::Plan::new(&scene)?;
/// let mut suspension = shearbed::Suspension::new(&plan, 0).expect("rods that interact");
/// suspension.step()?;
/// assert_eq!((suspension.tick(), suspension.directions().len()), (1, 100));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Suspension {
    pub(crate) rods: Rods,
    pub(crate) counters: Counters,
    /// Coordinates in mean rod lengths; empty if the plan drops positions.
    pub(crate) positions: [Vec<f64>; 3],
    sides: [f64; 3],
    liquid: Liquid,
    neighbours: Option<Neighbours>,
    pub(crate) draws: Option<Pcg64Dxsm>,
    pub(crate) replacements: Pcg64Dxsm,
    contacts: bool,
    reach: Reach,
    rule: Rule,
    pub(crate) tick: u64,
    /// R of every rod in this step; empty above [`MOST_KEPT`] rods.
    drawn: Vec<f64>,
    candidates: Vec<Candidate>,
    collisions: Vec<Collision>,
    seed: u64,
    replica: u64,
}

/// The squared distance, the index of the rod that drew R, and that of its nearest neighbour.
type Candidate = (f64, u32, u32);

/// Up to this number of rods every R is kept for its step; of more rods the few that are needed twice are drawn again.
pub(crate) const MOST_KEPT: usize = CHUNK;

/// From this number of candidates on, contacts are computed on all threads.
const MANY: usize = 1024;

struct Effect {
    ends: [UnitVector3<f64>; 2],
    angles_rad: [f64; 2],
    kicks_rad: [f64; 2],
    arms: [f64; 2],
}

/// The most bytes of the lists of a step, for these numbers of candidates and collisions: pairs as found and as
/// candidates, effects, and collisions. A list may have twice the capacity that it needs.
pub(crate) fn bytes_of_lists(candidates: f64, collisions: f64) -> f64 {
    let candidate = 2 * size_of::<Nearest>() + 2 * size_of::<Candidate>() + size_of::<Option<Effect>>();
    candidate as f64 * candidates + (2 * size_of::<Collision>()) as f64 * collisions
}

#[derive(Clone, Copy, Debug)]
struct Rule {
    update: Update,
    min_arm: f64,
    /// Δt in the liquid's unit of time; |G|Δt in plane Couette flow.
    step: f64,
}

impl Suspension {
    /// The state of one replica at t = 0. `None` for a plan that takes no steps.
    pub fn new(plan: &Plan, replica: u64) -> Option<Self> {
        let scene = plan.scene();
        let interaction = scene.interaction.as_ref().filter(|_| plan.runs(Stage::Translation))?;
        let (rods, counters) = Rods::draw(plan, replica);
        let count = rods.count();
        let volume = scene.volume()?;
        let (liquid, step) = Liquid::of(plan, volume);
        let seed = scene.ensemble.seed;
        let rng = |purpose| stream(seed, replica, purpose);
        Some(Self {
            rods,
            counters,
            positions: match scene.particles.own().and_then(|own| own.place_mm.as_ref()) {
                Some(places) => volume.within(places, scene.particles.length_mm),
                None => volume.draw_positions(count, &rng(Purpose::Positions)),
            },
            sides: volume.sides(),
            liquid,
            neighbours: plan.runs(Stage::Neighbours).then(|| Neighbours::new(volume.sides(), count)),
            draws: plan.runs(Stage::CollisionDraws).then(|| rng(Purpose::Collisions)),
            replacements: rng(Purpose::Replacements),
            contacts: plan.runs(Stage::Contacts),
            reach: Reach::new(interaction.alpha, interaction.m),
            rule: Rule { update: interaction.update, min_arm: interaction.min_contact_arm, step },
            tick: 0,
            drawn: Vec::new(),
            candidates: Vec::new(),
            collisions: Vec::new(),
            seed,
            replica,
        })
    }

    /// Moves the rods to `places` in the control volume (three arrays of coordinates, in mean rod lengths) and along
    /// `directions`. Returns `None` and changes nothing if a count is not that of the rods, or a place is outside the
    /// volume.
    pub fn place(&mut self, places: [Vec<f64>; 3], directions: &[UnitVector3<f64>]) -> Option<()> {
        let count = self.rods.count();
        let inside = |(axis, side): (&Vec<f64>, &f64)| axis.iter().all(|x| (0.0..=*side).contains(x));
        if directions.len() != count
            || places.iter().any(|axis| axis.len() != count)
            || !places.iter().zip(&self.sides).all(inside)
        {
            return None;
        }
        self.positions = places;
        for (rod, p) in directions.iter().enumerate() {
            self.rods.set(rod, p, self.tick);
        }
        Some(())
    }

    /// Random numbers of the stream of replacements per replaced rod.
    pub(crate) fn numbers_per_replacement(&self) -> u128 {
        self.liquid.numbers()
    }

    /// The work done so far.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Steps taken so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The sides H₁, H₂ and H₃ of the control volume, in mean rod lengths.
    pub fn sides_in_lengths(&self) -> [f64; 3] {
        self.sides
    }

    /// The rods' positions in mean rod lengths: three arrays of coordinates.
    pub fn positions_in_lengths(&self) -> &[Vec<f64>; 3] {
        &self.positions
    }

    /// The current direction of every rod.
    pub fn directions(&self) -> Vec<Vector3<f64>> {
        (0..self.rods.count()).map(|rod| self.rods.direction(rod, self.tick)).collect()
    }

    /// The length of every rod over the mean.
    pub fn lengths(&self) -> Vec<f64> {
        (0..self.rods.count()).map(|rod| self.rods.length(rod)).collect()
    }

    /// The aspect ratio of every rod.
    pub fn aspect_ratios(&self) -> Vec<f64> {
        (0..self.rods.count()).map(|rod| self.rods.aspect_ratio(rod)).collect()
    }

    /// Takes one step and returns its collisions, closest pair first.
    ///
    /// # Errors
    ///
    /// If a kick overflows; the suspension is then in the middle of its step.
    pub fn step(&mut self) -> Result<&[Collision], Error> {
        self.find_candidates();
        self.collide()?;
        self.rods.advance(self.tick);
        self.tick += 1;
        self.counters.steps += 1;
        self.counters.replacements += (self.liquid).carry(&mut self.positions, self.rule.step, &mut self.replacements);
        Ok(&self.collisions)
    }

    /// Draws R for every rod; a nearest neighbour within the reach of R makes a candidate (eqs 8 and 9).
    fn find_candidates(&mut self) {
        self.candidates.clear();
        let Some(draws) = &mut self.draws else { return };
        let (count, start) = (self.rods.count(), draws.clone());
        *draws = ahead(&start, count as u64);
        self.counters.draws += count as u64;
        let Some(neighbours) = &mut self.neighbours else { return };
        if count <= MOST_KEPT {
            let mut draws = start.clone();
            self.drawn.resize(count, 0.0);
            self.drawn.fill_with(|| draws.random());
        }
        let (rods, reach, drawn) = (&self.rods, &self.reach, &self.drawn);
        // The bound is tested first: most rods have no neighbour that near, and need no logarithm.
        let bounds = |first: usize| {
            let mut draws = ahead(&start, first as u64);
            (first..).map(move |rod| {
                let drawn = drawn.get(rod).copied().unwrap_or_else(|| draws.random());
                reach.bound(drawn) * rods.length(rod)
            })
        };
        let mut work = self.counters;
        neighbours.each_nearest(&self.positions, bounds, &mut work, |nearest| {
            let rod = nearest.rod as usize;
            let drawn = drawn.get(rod).copied().unwrap_or_else(|| ahead(&start, nearest.rod).random());
            if nearest.square < (reach.of(drawn) * rods.length(rod)).powi(2) {
                self.candidates.push((nearest.square, nearest.rod, nearest.other));
            }
        });
        self.counters = work;
        self.counters.candidates += self.candidates.len() as u64;
    }

    /// Makes candidates collide, closest first (ties: lower index); each rod collides at most once.
    fn collide(&mut self) -> Result<(), Error> {
        self.collisions.clear();
        if !self.contacts {
            return Ok(());
        }
        let mut candidates = std::mem::take(&mut self.candidates);
        let closest_first = |a: &Candidate, b: &Candidate| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        if candidates.len() <= MANY {
            candidates.sort_unstable_by(closest_first);
            for &(_, a, b) in &candidates {
                if self.both_free(a, b)
                    && let Some(effect) = self.effect(a, b)
                {
                    self.apply(a, b, effect)?;
                }
            }
        } else {
            candidates.par_sort_unstable_by(closest_first);
            // Computed from the state at the start of the step, so the order does not matter.
            let effects: Vec<_> = candidates.par_iter().map(|&(_, a, b)| self.effect(a, b)).collect();
            for (&(_, a, b), effect) in candidates.iter().zip(effects) {
                if let (true, Some(effect)) = (self.both_free(a, b), effect) {
                    self.apply(a, b, effect)?;
                }
            }
        }
        self.candidates = candidates;
        self.counters.collisions += self.collisions.len() as u64;
        Ok(())
    }

    /// True if neither rod has collided in this step.
    fn both_free(&self, a: u32, b: u32) -> bool {
        ![a, b].iter().any(|&rod| self.rods.turned_after(rod as usize, self.tick))
    }

    /// The effect of a collision on both rods, and the contact's arms; `None` if there is no contact.
    fn effect(&self, a: u32, b: u32) -> Option<Effect> {
        let pair = [a as usize, b as usize];
        let p = pair.map(|rod| self.rods.direction(rod, self.tick));
        let separation = self.position(pair[1]) - self.position(pair[0]);
        let min_arms = pair.map(|rod| self.rule.min_arm * self.rods.length(rod));
        let contact = contact(&separation, &p[0], &p[1], min_arms)?;
        let rate = |k: usize| {
            let factor = shape_factor(self.rods.aspect_ratio(pair[k]));
            self.liquid.rate(&p[k], factor)
        };
        let relative_velocity = self.liquid.velocity(&separation);
        let free = [rate(0), rate(1)];
        let rates = share_velocity(&contact, &relative_velocity, free);
        let turned = [0, 1].map(|k| {
            let start = UnitVector3::new_unchecked(p[k]);
            match self.rule.update {
                Update::Rotation => turn(&start, &rates[k], self.rule.step),
                Update::Angles => step_angles(&start, &rates[k], self.rule.step),
                Update::Kick => {
                    let end = self.rods.after_step(pair[k], self.tick);
                    let change = rates[k] - free[k];
                    let end = kick(&end, &p[k], &change, self.rule.step);
                    (end, norm(&rates[k]) * self.rule.step)
                }
            }
        });
        Some(Effect {
            ends: turned.map(|(end, _)| end),
            angles_rad: turned.map(|(_, angle)| angle),
            kicks_rad: [0, 1].map(|k| norm(&(rates[k] - free[k])) * self.rule.step),
            arms: contact.arms,
        })
    }

    fn apply(&mut self, a: u32, b: u32, effect: Effect) -> Result<(), Error> {
        let rods = [a as usize, b as usize];
        for (k, end) in effect.ends.iter().enumerate() {
            if !end.iter().all(|component| component.is_finite()) {
                return Err(self.non_finite(rods[k], effect.arms[k], effect.angles_rad[k]));
            }
            self.rods.set(rods[k], end, self.tick + 1);
        }
        self.collisions.push(Collision { rods, angles_rad: effect.angles_rad, kicks_rad: effect.kicks_rad });
        Ok(())
    }

    fn non_finite(&self, rod: usize, arm: f64, angle_rad: f64) -> Error {
        Error::NonFinite {
            rod,
            step: self.tick,
            seed: self.seed,
            replica: self.replica,
            cause: format!("a contact arm of {arm:e} rod lengths turned it by {angle_rad:e} rad"),
        }
    }

    fn position(&self, rod: usize) -> Vector3<f64> {
        Vector3::new(self.positions[0][rod], self.positions[1][rod], self.positions[2][rod])
    }
}
