//! Interacting rods in the control volume, step by step (the paper's method of solution).

use crate::collision::{Reach, share_velocity, step_angles, turn};
use crate::contact::contact;
use crate::jeffery::{couette_rate, shape_factor, strain_per_period};
use crate::neighbours::Grid;
use crate::plan::{Plan, Stage};
use crate::random::{Purpose, stream};
use crate::rods::Rods;
use crate::scene::Update;
use crate::volume::ControlVolume;
use crate::work::{Counters, RunError};
use nalgebra::{UnitVector3, Vector3};
use rand::RngExt;
use rand_pcg::Pcg64Dxsm;

/// A collision of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collision {
    /// The rod that drew R, and its nearest neighbour.
    pub rods: [usize; 2],
    /// |ṗ′|Δt: the angles in rad by which the two turned.
    pub angles_rad: [f64; 2],
}

/// One replica of an interacting scene: lengths in rod lengths, time in 1/|G|.
///
/// Inside a step: neighbours, draws and contacts from the state at its start; then every orientation
/// moves; then every position, with replacements.
#[derive(Clone, Debug)]
pub struct Suspension {
    pub(crate) rods: Rods,
    pub(crate) counters: Counters,
    /// Empty arrays where the plan drops them.
    positions: [Vec<f64>; 3],
    volume: ControlVolume,
    grid: Option<Grid>,
    draws: Option<Pcg64Dxsm>,
    replacements: Pcg64Dxsm,
    contacts: bool,
    reach: Reach,
    rule: Rule,
    tick: u64,
    candidates: Vec<(f64, u32, u32)>,
    collisions: Vec<Collision>,
    /// For error messages.
    place: (u64, u64),
}

#[derive(Clone, Copy, Debug)]
struct Rule {
    update: Update,
    min_arm: f64,
    /// |G|Δt.
    strain: f64,
    sign: f64,
}

impl Suspension {
    /// The state of one replica at t = 0. `None` for a plan that takes no steps.
    pub fn new(plan: &Plan, replica: u64) -> Option<Self> {
        let scene = plan.scene();
        let interaction = scene
            .interaction
            .as_ref()
            .filter(|_| plan.keeps(Stage::Translation))?;
        let (rods, aspect_ratios_redrawn) = Rods::draw(plan, replica);
        let count = rods.count();
        let volume = ControlVolume::holding(count, scene.concentration(interaction));
        let seed = scene.ensemble.seed;
        let rng = |purpose| stream(seed, replica, purpose);
        Some(Self {
            rods,
            counters: Counters {
                aspect_ratios_redrawn,
                ..Counters::default()
            },
            positions: volume.draw_positions(count, &mut rng(Purpose::Positions)),
            volume,
            grid: plan
                .keeps(Stage::Neighbours)
                .then(|| Grid::new(volume.side(), count)),
            draws: plan
                .keeps(Stage::CollisionDraws)
                .then(|| rng(Purpose::Collisions)),
            replacements: rng(Purpose::Replacements),
            contacts: plan.keeps(Stage::Contacts),
            reach: Reach::new(interaction.alpha, interaction.m),
            rule: Rule {
                update: interaction.update,
                min_arm: interaction.min_contact_arm,
                strain: strain_per_period(scene.particles.aspect_ratio) / scene.steps_per_period() as f64,
                sign: plan.flow().shear_rate_per_s()?.signum(),
            },
            tick: 0,
            candidates: Vec::new(),
            collisions: Vec::new(),
            place: (seed, replica),
        })
    }

    /// Puts the rods at places inside the volume, in rod lengths (three arrays of coordinates), and along
    /// directions: a state of one's own. `None`, and nothing changed, where a count is not that of the rods.
    pub fn place(&mut self, places: [Vec<f64>; 3], directions: &[UnitVector3<f64>]) -> Option<()> {
        let count = self.rods.count();
        if directions.len() != count || places.iter().any(|axis| axis.len() != count) {
            return None;
        }
        self.positions = places;
        for (rod, p) in directions.iter().enumerate() {
            self.rods.set(rod, p, self.tick);
        }
        Some(())
    }

    /// Takes one step and returns its collisions, closest pair first.
    pub fn step(&mut self) -> Result<&[Collision], RunError> {
        self.find_candidates();
        self.collide()?;
        self.tick += 1;
        self.counters.steps += 1;
        self.counters.replacements += self.volume.advance(
            &mut self.positions,
            self.rule.strain,
            self.rule.sign,
            &mut self.replacements,
        );
        Ok(&self.collisions)
    }

    /// Every rod draws R; its nearest neighbour within the reach of R makes a candidate (eqs 8 and 9).
    fn find_candidates(&mut self) {
        self.candidates.clear();
        if let Some(grid) = &mut self.grid {
            grid.build(&self.positions);
        }
        let Some(draws) = &mut self.draws else { return };
        let [x1, x2, x3] = &self.positions;
        for rod in 0..x1.len() {
            let r: f64 = draws.random();
            let Some(grid) = &self.grid else { continue };
            // The bound first: most rods have no neighbour that near, and need no logarithm.
            let bound = self.reach.bound(r);
            let position = [x1[rod], x2[rod], x3[rod]];
            let tested = &mut self.counters.distances;
            if let Some((other, square)) = grid.nearest_within(rod, position, bound, tested)
                && square < self.reach.of(r).powi(2)
            {
                self.candidates.push((square, rod as u32, other as u32));
            }
        }
        self.counters.draws += x1.len() as u64;
        self.counters.candidates += self.candidates.len() as u64;
    }

    /// Takes candidates closest first (ties: lower index), each rod in one collision at most.
    fn collide(&mut self) -> Result<(), RunError> {
        self.collisions.clear();
        if !self.contacts {
            return Ok(());
        }
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for &(_, a, b) in &candidates {
            self.collide_pair(a as usize, b as usize)?;
        }
        self.candidates = candidates;
        self.counters.collisions += self.collisions.len() as u64;
        Ok(())
    }

    fn collide_pair(&mut self, a: usize, b: usize) -> Result<(), RunError> {
        let pair = [a, b];
        if pair.iter().any(|&rod| self.rods.turned_after(rod, self.tick)) {
            return Ok(());
        }
        let p = pair.map(|rod| self.rods.direction(rod, self.tick));
        let separation = self.position(b) - self.position(a);
        let Some(contact) = contact(&separation, &p[0], &p[1], self.rule.min_arm) else {
            return Ok(());
        };
        let rate = |k: usize| {
            let factor = shape_factor(self.rods.aspect_ratio(pair[k]));
            couette_rate(&p[k], factor, self.rule.sign)
        };
        let relative_velocity = Vector3::new(0.0, self.rule.sign * separation.x, 0.0);
        let rates = share_velocity(&contact, &relative_velocity, [rate(0), rate(1)]);
        let mut angles_rad = [0.0; 2];
        for k in 0..2 {
            let start = UnitVector3::new_unchecked(p[k]);
            let (end, angle) = match self.rule.update {
                Update::Rotation => turn(&start, &rates[k], self.rule.strain),
                Update::Angles => step_angles(&start, &rates[k], self.rule.strain),
            };
            if !end.iter().all(|component| component.is_finite()) {
                return Err(self.non_finite(pair[k], contact.arms[k], angle));
            }
            self.rods.set(pair[k], &end, self.tick + 1);
            angles_rad[k] = angle;
        }
        self.collisions.push(Collision {
            rods: pair,
            angles_rad,
        });
        Ok(())
    }

    fn non_finite(&self, rod: usize, arm: f64, angle_rad: f64) -> RunError {
        RunError::NonFinite {
            rod,
            step: self.tick,
            seed: self.place.0,
            replica: self.place.1,
            cause: format!("a contact arm of {arm:e} rod lengths turned it by {angle_rad:e} rad"),
        }
    }

    fn position(&self, rod: usize) -> Vector3<f64> {
        Vector3::new(
            self.positions[0][rod],
            self.positions[1][rod],
            self.positions[2][rod],
        )
    }

    /// The work done so far.
    pub fn counters(&self) -> &Counters {
        &self.counters
    }

    /// Steps taken so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The side H/a of the control volume, in rod lengths.
    pub fn side_in_lengths(&self) -> f64 {
        self.volume.side()
    }

    /// The rods' positions in rod lengths: three arrays of coordinates.
    pub fn positions_in_lengths(&self) -> &[Vec<f64>; 3] {
        &self.positions
    }

    /// The direction of every rod now.
    pub fn directions(&self) -> Vec<Vector3<f64>> {
        (0..self.rods.count())
            .map(|rod| self.rods.direction(rod, self.tick))
            .collect()
    }

    /// The aspect ratio of every rod.
    pub fn aspect_ratios(&self) -> Vec<f64> {
        (0..self.rods.count())
            .map(|rod| self.rods.aspect_ratio(rod))
            .collect()
    }
}
