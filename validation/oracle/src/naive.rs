//! A naive reference for the fibre-collision model of Lee & Springer (J. Reinf. Plast. Compos. 1, 279, 1982).
//!
//! Test against something too simple to be wrong, and test that too: every rod and every pair is visited in every
//! step, all quantities are physical (mm, s, rad), and the arithmetic is the paper's, equation by equation. It shares
//! no code with the simulator it judges, only the written protocol of random numbers and of the order in a step.
//! Axes: 1 gradient, 2 flow, 3 vorticity; u = L x with L_ij = du_i/dx_j; p = (sin th cos ph, sin th sin ph, cos th).

mod averaged;
mod contact;
mod motion;
mod neighbour;
mod problem;
mod random;
mod reading;
#[cfg(test)]
mod tests;

pub use contact::{Contact, collide};
pub use motion::{jeffery, mean_projections};
pub use neighbour::{collision_probability, nearest};
pub use problem::{Mistake, Problem, Start, Update};
pub use random::stream;
pub use reading::{Images, Lines, Reading, Replacement, Who};

use contact::contact;
use motion::{
    axis, jeffery_matrix, matrix, moved_by_angles, rotated, shape_factor, sin_theta, turned, vector,
};
use nalgebra::Matrix3;
use neighbour::distance_mm;
use problem::either;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Dxsm;
use random::{ASPECT_RATIOS, COLLISIONS, ORIENTATIONS, POSITIONS, REPLACEMENTS, uniform};
use std::f64::consts::TAU;

/// The suspension as it is now.
#[derive(Debug)]
pub struct Naive {
    /// Centres of mass, mm.
    pub positions_mm: Vec<[f64; 3]>,
    /// Unit axes.
    pub orientations: Vec<[f64; 3]>,
    /// r_e of every rod.
    pub aspect_ratios: Vec<f64>,
    /// Collisions so far.
    pub collisions: u64,
    /// Rods that have left the volume so far.
    pub replacements: u64,
    /// Aspect ratios drawn again because they were 1 or less.
    pub redraws: u64,
    /// Rods (i, j) that collided in the last step, in the order taken; i is the one whose draw it was.
    pub last_collisions: Vec<(usize, usize)>,
    /// |pdot'| dt of i and of j for each of these, rad: the whole turn, Jeffery's share included.
    pub last_turns_rad: Vec<[f64; 2]>,
    problem: Problem,
    propagators: Vec<Matrix3<f64>>,
    collision_stream: Pcg64Dxsm,
    replacement_stream: Pcg64Dxsm,
}

impl Naive {
    /// The suspension at t = 0 (eqs. 11, 12).
    pub fn new(problem: Problem) -> Self {
        let stream_for = |purpose| stream(problem.seed, problem.replica, purpose);
        let mut redraws = 0;
        let mut aspect_ratios = vec![problem.aspect_ratio; problem.count];
        if problem.aspect_ratio_sd_percent > 0.0 {
            let sd = problem.aspect_ratio * problem.aspect_ratio_sd_percent / 100.0;
            let normal = Normal::new(problem.aspect_ratio, sd).expect("the standard deviation is finite");
            let mut draws = stream_for(ASPECT_RATIOS);
            for aspect_ratio in &mut aspect_ratios {
                *aspect_ratio = normal.sample(&mut draws);
                while *aspect_ratio <= 1.0 {
                    redraws += 1;
                    *aspect_ratio = normal.sample(&mut draws);
                }
            }
        }
        let mut draws = stream_for(ORIENTATIONS);
        let mut orientations = Vec::new();
        for _ in 0..problem.count {
            orientations.push(match problem.orientation {
                Start::Fixed { phi_rad, theta_rad } => axis([phi_rad, theta_rad]),
                Start::Isotropic => {
                    let phi = TAU * uniform(&mut draws);
                    axis([phi, (1.0 - 2.0 * uniform(&mut draws)).acos()])
                }
            });
        }
        let mut draws = stream_for(POSITIONS);
        let mut positions_mm = Vec::new();
        for _ in 0..problem.count {
            positions_mm.push([0; 3].map(|_| problem.box_edge_mm() * uniform(&mut draws)));
        }
        let gradient = matrix(problem.gradient_per_s());
        let propagator = |&aspect_ratio: &f64| {
            let lambda = shape_factor(aspect_ratio);
            let lambda = either(problem.mistake, Mistake::LambdaOne, 1.0, lambda);
            (jeffery_matrix(gradient, lambda) * problem.time_step_s()).exp()
        };
        Self {
            propagators: aspect_ratios.iter().map(propagator).collect(),
            collision_stream: stream_for(COLLISIONS),
            replacement_stream: stream_for(REPLACEMENTS),
            positions_mm,
            orientations,
            aspect_ratios,
            collisions: 0,
            replacements: 0,
            redraws,
            last_collisions: Vec::new(),
            last_turns_rad: Vec::new(),
            problem,
        }
    }

    /// One time step: contacts from the state at its start, then all orientations, then all positions.
    pub fn step(&mut self) {
        let dt_s = self.problem.time_step_s();
        let contacts = self.contacts();
        let old = self.orientations.clone();
        for (p, propagator) in self.orientations.iter_mut().zip(&self.propagators) {
            *p = (propagator * vector(*p)).normalize().into();
        }
        self.last_collisions.clear();
        self.last_turns_rad.clear();
        for (i, j, contact) in contacts {
            for (rod, pdot) in [(i, contact.pdot_a_per_s), (j, contact.pdot_b_per_s)] {
                let (p, made) = (old[rod], self.problem.mistake);
                self.orientations[rod] = match self.problem.update {
                    // phi has no meaning at the pole
                    Update::Angles if sin_theta(p) != 0.0 => moved_by_angles(p, pdot, dt_s, made),
                    Update::Angles | Update::Rotation => rotated(p, pdot, dt_s),
                    Update::ExactStepAndKick => {
                        let free = vector(jeffery(p, self.aspect_ratios[rod], self.problem.gradient_per_s()));
                        let change = vector(pdot) - free;
                        turned(self.orientations[rod], p, change.into(), dt_s)
                    }
                };
            }
            self.collisions += 1;
            self.last_collisions.push((i, j));
            let turn_rad = |pdot| vector(pdot).norm() * dt_s;
            let turns_rad = [contact.pdot_a_per_s, contact.pdot_b_per_s].map(turn_rad);
            self.last_turns_rad.push(turns_rad);
        }
        self.translate(dt_s);
    }

    /// The collisions of this step: nearest neighbours, eqs. 7 to 9, closest first, one collision per rod at most.
    fn contacts(&mut self) -> Vec<(usize, usize, Contact)> {
        let mut taken = vec![false; self.problem.count];
        let mut contacts = Vec::new();
        for (i, j) in self.candidates() {
            if taken[i] || taken[j] {
                continue;
            }
            // no contact is no collision: both rods stay free for a later candidate
            if let Some(contact) = self.contact(i, j) {
                (taken[i], taken[j]) = (true, true);
                contacts.push((i, j, contact));
            }
        }
        contacts
    }

    /// Every rod i whose draw is below P_c, with its nearest neighbour, in the order in which they are taken.
    fn candidates(&mut self) -> Vec<(usize, usize)> {
        let problem = &self.problem;
        let (n, m, made, who) = (problem.count, problem.m, problem.mistake, problem.reading.who);
        let m = either(made, Mistake::ProbabilityExponent, m + 1.0, m);
        let (images, edge_mm) = (problem.reading.images, problem.box_edge_mm());
        let neighbour = |i| nearest(&self.positions_mm, i, images, edge_mm);
        let neighbours: Vec<_> = (0..n).map(neighbour).collect();
        // drawn whatever the distance, so that one rod's fate never shifts another's draw
        let draws: Vec<_> = (0..n).map(|_| uniform(&mut self.collision_stream)).collect();
        let mut candidates = Vec::new();
        for i in 0..n {
            let Some(j) = neighbours[i] else { continue };
            let mutual = neighbours[j] == Some(i);
            let draw = draws[if who == Who::PairDraws && mutual {
                i.min(j)
            } else {
                i
            }];
            let j = either(made, Mistake::AnyNeighbour, (i + 1) % n, j);
            let s_mm = distance_mm(self.positions_mm[i], self.seen_from(i, j));
            let p_c = collision_probability(s_mm, problem.length_mm, problem.alpha, m);
            if either(made, Mistake::ProbabilityComplement, p_c < draw, p_c > draw) {
                candidates.push((i, j, s_mm));
            }
        }
        if made != Some(Mistake::IndexOrder) && who != Who::IndexOrder {
            // stable: equal distances stay in the order of i
            candidates.sort_by(|one, other| one.2.total_cmp(&other.2));
        }
        candidates.into_iter().map(|(i, j, _)| (i, j)).collect()
    }

    /// Where rod i sees rod j.
    fn seen_from(&self, i: usize, j: usize) -> [f64; 3] {
        let images = self.problem.reading.images;
        images.nearest_mm(
            self.positions_mm[j],
            self.positions_mm[i],
            self.problem.box_edge_mm(),
        )
    }

    /// What a collision of i and j does; `None` where they make no contact.
    fn contact(&self, i: usize, j: usize) -> Option<Contact> {
        let problem = &self.problem;
        let gradient = problem.gradient_per_s();
        let rod = |k: usize, x: [f64; 3]| {
            let p = self.orientations[k];
            [x, p, jeffery(p, self.aspect_ratios[k], gradient)].map(vector)
        };
        let (a, b) = (rod(i, self.positions_mm[i]), rod(j, self.seen_from(i, j)));
        let contact = contact(a, b, matrix(gradient), problem.mistake)?;
        let arms = [contact.arm_a_mm, contact.arm_b_mm].map(|arm_mm| arm_mm.abs() / problem.length_mm);
        let longest = match problem.reading.lines {
            Lines::Infinite => f64::INFINITY,
            Lines::CutAtEnds => 0.5,
        };
        let reached = |&arm: &f64| arm >= problem.min_contact_arm && arm <= longest;
        arms.iter().all(reached).then_some(contact)
    }

    /// x_2 grows by G x_1 dt; whoever leaves the volume comes back by eq. 14, orientation and r_e kept.
    fn translate(&mut self, dt_s: f64) {
        let (edge_mm, made) = (self.problem.box_edge_mm(), self.problem.mistake);
        for x in &mut self.positions_mm {
            x[1] += self.problem.shear_rate_per_s * x[0] * dt_s;
            if (0.0..edge_mm).contains(&x[1]) {
                continue;
            }
            self.replacements += 1;
            let (old_x1, beyond) = (x[0], if x[1] < 0.0 { x[1] } else { x[1] - edge_mm });
            x[1] = x[1].rem_euclid(edge_mm);
            if made == Some(Mistake::ReplacementNone) {
                continue;
            }
            // inflow through the face is proportional to u_2, so to x_1: hence the root
            let draw = uniform(&mut self.replacement_stream);
            x[0] = edge_mm * either(made, Mistake::ReplacementUniform, draw, draw.sqrt());
            x[2] = edge_mm * uniform(&mut self.replacement_stream);
            if self.problem.reading.replacement == Replacement::ScaledOvershoot {
                x[1] = (beyond * x[0] / old_x1).rem_euclid(edge_mm);
            }
        }
    }
}
