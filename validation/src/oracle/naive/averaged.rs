//! The averaged motion: what is left of the model as dt -> 0 where arms are bounded below.
//!
//! In place of draws, every nearest pair that makes a contact turns both of its rods by the change of pdot that a
//! collision would make, weighted with the probability that it collides. Places move as in the model.

use super::motion::{jeffery, turned, vector};
use super::{Naive, collision_probability};
use crate::oracle::pairing::nearest_pairs;
use nalgebra::Vector3;

impl Naive {
    /// One time step of the averaged motion: Jeffery's exact step, then the turn by the mean change.
    /// No draw of a collision is used; the places are those of [`Naive::step`] with the same seed.
    pub fn step_averaged(&mut self) {
        let problem = &self.problem;
        let dt_s = problem.time_step_s();
        let chance = |s_mm| collision_probability(s_mm, problem.length_mm, problem.alpha, problem.m);
        let makes_contact = |i, j| self.contact(i, j).is_some();
        let mut change_per_s = vec![Vector3::zeros(); problem.count];
        for pair in nearest_pairs(&self.positions_mm, chance, makes_contact) {
            let [i, j] = pair.rods;
            let Some(contact) = self.contact(i, j) else { continue };
            for (rod, pdot) in [(i, contact.pdot_a_per_s), (j, contact.pdot_b_per_s)] {
                let free = jeffery(
                    self.orientations[rod],
                    self.aspect_ratios[rod],
                    problem.gradient_per_s(),
                );
                change_per_s[rod] += (vector(pdot) - vector(free)) * pair.chance;
            }
        }
        for (rod, change_per_s) in change_per_s.into_iter().enumerate() {
            let p = self.orientations[rod];
            let free = (self.propagators[rod] * vector(p)).normalize().into();
            self.orientations[rod] = turned(free, p, change_per_s.into(), dt_s);
        }
        self.translate(dt_s);
    }
}
