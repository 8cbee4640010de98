//! Suspensions: error against run time of free ones; of interacting ones how the mean depends on steps, rods and
//! replicas, what a given error costs, and which coupled estimates pay. Plain data; the
//! studies are [`free_study`] and [`interacting`].

pub mod blocks;
pub mod coupled;
pub mod fit;
pub mod free;
pub mod free_study;
pub mod interacting;
pub mod job;
pub mod law;
pub mod law_tables;
pub mod split;
pub mod starts;

use crate::judge::statistics::{Estimate, correlation, covariance, slope};
