//! How a claim is judged: cases with controls, rules of acceptance with their errors, statistics, the paper's problem as a scene.
//! It may use the oracles and what is below.

pub mod accept;
pub mod case;
pub mod lab;
pub mod statistics;
