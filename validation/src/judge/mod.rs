//! How claims are judged.
//!
//! - [`case`]: a claim with its check, and controls that the check must fail.
//! - [`accept`]: rules of acceptance with their two errors, and the sample sizes that follow.
//! - [`statistics`]: means, standard errors, critical values. [`lab`]: the paper's problem as scenes and samples.
//!
//! It may use the oracles and all parts above. To add a rule, write it in `accept` with the probabilities of a false
//! alarm and of a miss, and simulate both in its test.

pub mod accept;
pub mod case;
pub mod lab;
pub mod statistics;
