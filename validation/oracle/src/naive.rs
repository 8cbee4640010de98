//! A naive reference for the fibre-collision model of Lee & Springer (J. Reinf. Plast. Compos. 1, 279, 1982).
//!
//! Test against something too simple to be wrong, and test that too: every rod and every pair is visited in every
//! step, all quantities are physical (mm, s, rad), and the arithmetic is the paper's, equation by equation. It shares
//! no code with the simulator it judges, only the written protocol of random numbers and of the order in a step.
//! Axes: 1 gradient, 2 flow, 3 vorticity; u = L x with L_ij = du_i/dx_j; p = (sin th cos ph, sin th sin ph, cos th).

mod averaged;
mod contact;
mod inflow;
mod mistake;
mod motion;
mod neighbour;
mod problem;
mod random;
mod reading;
#[cfg(test)]
mod tests;

pub use contact::{Contact, collide};
pub use inflow::{OtherFlow, carry};
pub use mistake::Mistake;
pub use motion::{jeffery, mean_projections};
pub use neighbour::{collision_probability, expected_candidates, nearest};
pub use problem::{NaiveProblem, Start, Update};
pub use random::stream;
pub use reading::{Images, Length, Lines, Reading, Replacement, Who};

use contact::contact;
use mistake::either;
use motion::{axis, jeffery_matrix, matrix, moved_by_angles, rotated, shape_factor, sin_theta, turned, vector};
use nalgebra::Matrix3;
pub(crate) use neighbour::distance_mm;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Dxsm;
use random::{ASPECT_RATIOS, COLLISIONS, LENGTHS, ORIENTATIONS, POSITIONS, REPLACEMENTS, uniform};
use std::f64::consts::TAU;

/// The current state of the suspension.
#[derive(Debug)]
pub struct Naive {
    /// Centres of mass, mm.
    pub positions_mm: Vec<[f64; 3]>,
    /// Unit axes.
    pub orientations: Vec<[f64; 3]>,
    /// Aspect ratio r_e of every rod.
    pub aspect_ratios: Vec<f64>,
    /// Length a of every rod, mm.
    pub lengths_mm: Vec<f64>,
    /// Number of collisions so far.
    pub collisions: u64,
    /// Number of rods that have left the volume so far.
    pub replacements: u64,
    /// Number of repeated draws of aspect ratios that were 1 or less, and of lengths that were not positive.
    pub redraws: u64,
    /// Rods (i, j) that collided in the last step, in order; i is the rod whose draw led to the collision.
    pub last_collisions: Vec<(usize, usize)>,
    /// |pdot'| dt of i and of j for each of these collisions, rad: the whole turn, including Jeffery's part.
    pub last_turns_rad: Vec<[f64; 2]>,
    problem: NaiveProblem,
    propagators: Vec<Matrix3<f64>>,
    collision_stream: Pcg64Dxsm,
    replacement_stream: Pcg64Dxsm,
}

impl Naive {
    /// The suspension at t = 0 (eqs. 11, 12).
    pub fn new(problem: NaiveProblem) -> Self {
        let stream_for = |purpose| stream(problem.seed, problem.replica, purpose);
        let mut redraws = 0;
        let mut gaussian = |purpose, mean: f64, sd_percent: f64, least: f64| {
            let mut values = vec![mean; problem.count];
            if sd_percent > 0.0 {
                let normal = Normal::new(mean, mean * sd_percent / 100.0).expect("the deviation is finite");
                let mut draws = stream_for(purpose);
                for value in &mut values {
                    *value = normal.sample(&mut draws);
                    while *value <= least {
                        redraws += 1;
                        *value = normal.sample(&mut draws);
                    }
                }
            }
            values
        };
        let aspect_ratios = gaussian(ASPECT_RATIOS, problem.aspect_ratio, problem.aspect_ratio_sd_percent, 1.0);
        let lengths_mm = gaussian(LENGTHS, problem.length_mm, problem.length_sd_percent, 0.0);
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
            positions_mm.push(problem.edges_mm().map(|edge_mm| edge_mm * uniform(&mut draws)));
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
            lengths_mm,
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
                    // phi is undefined at the pole
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
            // without contact there is no collision: both rods stay free for a later candidate
            if let Some(contact) = self.contact(i, j) {
                (taken[i], taken[j]) = (true, true);
                contacts.push((i, j, contact));
            }
        }
        contacts
    }

    /// Every rod i whose draw is below P_c, with its nearest neighbour, in the order of collisions.
    fn candidates(&mut self) -> Vec<(usize, usize)> {
        let problem = &self.problem;
        let (n, m, made, who) = (problem.count, problem.m, problem.mistake, problem.reading.who);
        let m = either(made, Mistake::ProbabilityExponent, m + 1.0, m);
        let (images, edges_mm) = (problem.reading.images, problem.edges_mm());
        let neighbour = |i| nearest(&self.positions_mm, i, images, edges_mm);
        let neighbours: Vec<_> = (0..n).map(neighbour).collect();
        // drawn at any distance, so that no rod's draw depends on another rod
        let draws: Vec<_> = (0..n).map(|_| uniform(&mut self.collision_stream)).collect();
        let mut candidates = Vec::new();
        for i in 0..n {
            let Some(j) = neighbours[i] else { continue };
            let mutual = neighbours[j] == Some(i);
            let draw = draws[if who == Who::PairDraws && mutual { i.min(j) } else { i }];
            let j = either(made, Mistake::AnyNeighbour, (i + 1) % n, j);
            let s_mm = distance_mm(self.positions_mm[i], self.seen_from(i, j));
            let p_c = collision_probability(s_mm, self.length_mm(i, j), problem.alpha, m);
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

    /// The length in mm by which s is divided when rod i draws and j is its neighbour.
    fn length_mm(&self, i: usize, j: usize) -> f64 {
        let [own, partners] = [i, j].map(|rod| self.lengths_mm[rod]);
        match (self.problem.mistake, self.problem.reading.length) {
            (Some(Mistake::PartnersLength), _) | (_, Length::Partners) => partners,
            (Some(Mistake::MeanLength), _) => self.problem.length_mm,
            (_, Length::Own) => own,
            (_, Length::MeanOfBoth) => 0.5 * (own + partners),
        }
    }

    /// The position of rod j, or of its image, as seen from rod i.
    fn seen_from(&self, i: usize, j: usize) -> [f64; 3] {
        let images = self.problem.reading.images;
        images.nearest_mm(self.positions_mm[j], self.positions_mm[i], self.problem.edges_mm())
    }

    /// The effect of a collision of i and j; `None` if they make no contact.
    fn contact(&self, i: usize, j: usize) -> Option<Contact> {
        let problem = &self.problem;
        let gradient = problem.gradient_per_s();
        let rod = |k: usize, x: [f64; 3]| {
            let p = self.orientations[k];
            [x, p, jeffery(p, self.aspect_ratios[k], gradient)].map(vector)
        };
        let (a, b) = (rod(i, self.positions_mm[i]), rod(j, self.seen_from(i, j)));
        let contact = contact(a, b, matrix(gradient), problem.mistake)?;
        let longest = match problem.reading.lines {
            Lines::Infinite => f64::INFINITY,
            Lines::CutAtEnds => 0.5,
        };
        let reached = |(k, arm_mm): (usize, f64)| {
            let a_mm = self.lengths_mm[k];
            let unit_mm = either(problem.mistake, Mistake::ArmsOverMeanLength, problem.length_mm, a_mm);
            arm_mm.abs() >= problem.min_contact_arm * unit_mm && arm_mm.abs() <= longest * a_mm
        };
        let arms = [(i, contact.arm_a_mm), (j, contact.arm_b_mm)];
        arms.into_iter().all(reached).then_some(contact)
    }

    /// x_2 grows by G x_1 dt; rods that leave the volume come back by eq. 14 and keep orientation and r_e. In other
    /// flows x becomes exp(L dt) x, and rods that leave come back with the liquid that came in.
    fn translate(&mut self, dt_s: f64) {
        if self.problem.other_flow.is_some() {
            let (flow, edges_mm) = (self.problem.gradient_per_s(), self.problem.edges_mm());
            let (places_mm, replaced) = (&mut self.positions_mm, &mut self.replacements);
            let (draws, made) = (&self.replacement_stream, self.problem.mistake);
            return carry(places_mm, flow, edges_mm, dt_s, draws, replaced, made);
        }
        let ([h1_mm, h2_mm, h3_mm], made) = (self.problem.edges_mm(), self.problem.mistake);
        for x in &mut self.positions_mm {
            x[1] += self.problem.shear_rate_per_s * x[0] * dt_s;
            if (0.0..h2_mm).contains(&x[1]) {
                continue;
            }
            self.replacements += 1;
            let (old_x1, beyond) = (x[0], if x[1] < 0.0 { x[1] } else { x[1] - h2_mm });
            x[1] = x[1].rem_euclid(h2_mm);
            if made == Some(Mistake::ReplacementNone) {
                continue;
            }
            // the inflow through the face is proportional to u_2, and so to x_1: hence the root
            let draw = uniform(&mut self.replacement_stream);
            let h1_mm = either(made, Mistake::ReplacementAlongFlow, h2_mm, h1_mm);
            x[0] = h1_mm * either(made, Mistake::ReplacementUniform, draw, draw.sqrt());
            x[2] = h3_mm * uniform(&mut self.replacement_stream);
            if self.problem.reading.replacement == Replacement::ScaledOvershoot {
                x[1] = (beyond * x[0] / old_x1).rem_euclid(h2_mm);
            }
        }
    }
}
