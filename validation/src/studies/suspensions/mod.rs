//! Suspensions: error against run time of free ones; of interacting ones how the mean depends on steps, rods and
//! replicas, what a given error costs, and which coupled estimates pay. Plain data; writers are in [`tables`],
//! [`figures`] and [`export`].

pub mod blocks;
pub mod chapter;
pub mod coupled;
pub mod export;
pub mod figures;
pub mod fit;
pub mod free;
pub mod job;
pub mod law;
pub mod law_tables;
pub mod split;
pub mod starts;
pub mod study;
pub mod tables;

use crate::judge::statistics::{Estimate, correlation, covariance, slope};
