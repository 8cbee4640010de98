//! Where integrators of a free rod leave their region of stability: maps of what was found in every corner, and the
//! longest steps by bisection beside theory. Derived in `docs/stability.md`.

pub mod core;
pub mod figures;
pub mod limit_tables;
pub mod limits;
pub mod map;
pub mod orbit;
pub mod tables;
pub mod theory;
