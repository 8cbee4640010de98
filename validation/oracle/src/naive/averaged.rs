//! The averaged motion: the limit of the model as dt -> 0 if arms have a lower bound.
//!
//! Instead of by draws, every nearest pair that makes a contact turns both of its rods by the change of pdot that a
//! collision would make, times the probability that it collides. Positions move as in the model.

use super::motion::{jeffery, turned, vector};
use super::{Naive, collision_probability};
use crate::pairing::nearest_pairs;
use nalgebra::Vector3;

impl Naive {
    /// One time step of the averaged motion: Jeffery's exact step, then the turn by the mean change.
    /// No collision is drawn; positions are those of [`Naive::step`] with the same seed.
    pub fn step_averaged(&mut self) {
        let problem = &self.problem;
        let dt_s = problem.time_step_s();
        let chance = |s_mm| collision_probability(s_mm, problem.length_mm, problem.alpha, problem.m);
        let makes_contact = |i, j| self.contact(i, j).is_some();
        let mut change_per_s = vec![Vector3::zeros(); problem.count];
        for pair in nearest_pairs(&self.positions_mm, chance, makes_contact) {
            let [i, j] = pair.rods;
            let Some(contact) = self.contact(i, j) else {
                continue;
            };
            for (rod, pdot) in [(i, contact.pdot_a_per_s), (j, contact.pdot_b_per_s)] {
                let free = jeffery(self.orientations[rod], self.aspect_ratios[rod], problem.gradient_per_s());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::naive::NaiveProblem;

    fn apart(a: &Naive, b: &Naive) -> f64 {
        let rods = a.orientations.iter().zip(&b.orientations);
        crate::worst(rods.map(|(a, b)| (vector(*a) - vector(*b)).norm()))
    }

    /// Two rods, always each other's nearest, over one short step: the mean over the draws lies between the free step
    /// and the step with a collision, weighted by the probability that one of two draws is below P_c.
    #[test]
    fn one_step_of_two_rods_is_the_mean_of_the_model_s() {
        let mut turned = 0;
        for replica in 0..50 {
            let mut problem = NaiveProblem::paper(1, replica);
            (problem.count, problem.concentration_per_cm3) = (2, 500.0);
            (problem.steps_per_period, problem.min_contact_arm) = (100_000, 0.1);
            let with = |alpha: f64| {
                let mut problem = problem.clone();
                problem.alpha = alpha;
                Naive::new(problem)
            };
            let (mut free, mut collided, mut averaged) = (with(0.0), with(1e12), with(0.5));
            let s_mm = super::super::distance_mm(averaged.positions_mm[0], averaged.positions_mm[1]);
            let missed = 1.0 - collision_probability(s_mm, problem.length_mm, 0.5, problem.m);
            free.step();
            collided.step();
            averaged.step_averaged();
            assert_eq!(free.positions_mm, averaged.positions_mm);
            turned += collided.collisions;
            for rod in 0..2 {
                let [free, collided, averaged] = [&free, &collided, &averaged].map(|run| vector(run.orientations[rod]));
                let expected = free + (collided - free) * (1.0 - missed * missed);
                // GΔt = 7·10⁻⁴, kicks are about ten times that: the neglected terms are of second order.
                assert!((averaged - expected).norm() < 1e-4 * (collided - free).norm() + 1e-6, "{replica}");
            }
        }
        assert!((20..50).contains(&turned), "some make contact, some have too short an arm: {turned}");
    }

    #[test]
    fn without_collisions_it_is_the_free_motion() {
        let mut problem = NaiveProblem::paper(1, 0);
        (problem.count, problem.alpha) = (10, 0.0);
        let (mut free, mut averaged) = (Naive::new(problem.clone()), Naive::new(problem.clone()));
        problem.alpha = 0.5;
        let mut colliding = Naive::new(problem);
        for _ in 0..200 {
            free.step();
            averaged.step_averaged();
            colliding.step_averaged();
        }
        assert_eq!(apart(&free, &averaged), 0.0);
        assert!(apart(&free, &colliding) > 0.1);
        assert_eq!(free.positions_mm, colliding.positions_mm);
    }
}
