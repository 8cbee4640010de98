//! How claims are judged: cases with controls, rules of acceptance with their errors, statistics, the paper's problem as a scene.
//! This module may use the oracles and all modules below.

pub mod accept;
pub mod case;
pub mod lab;
pub mod statistics;
