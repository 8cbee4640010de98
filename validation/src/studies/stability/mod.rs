//! Where integrators of a free rod leave their region of stability: maps of what was found in every corner, and the
//! longest steps by bisection beside theory. Derived in `docs/src/developer/step-limits.md`.

pub mod corners;
pub mod limit_study;
pub mod limits;
pub mod map;
pub mod maps;
pub mod orbit;
pub mod study;
pub mod theory;
