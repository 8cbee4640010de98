//! Limits of stability of integrators of a free rod: maps of outcomes over wide ranges, and the longest steps by
//! bisection compared with theory. Derived in `docs/src/developer/step-limits.md`.

pub mod extremes;
pub mod limit_study;
pub mod map;
pub mod maps;
pub mod orbit;
pub mod study;
pub mod theory;

use super::*;
