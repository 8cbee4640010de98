//! Where integrators of a free rod leave their region of stability: maps of what was found in every corner, and the
//! longest steps by bisection beside theory. Derived in `docs/src/developer/step-limits.md`.

pub mod chapter;
pub mod corners;
pub mod corners_table;
pub mod ends;
pub mod figures;
pub mod limit_tables;
pub mod limits;
pub mod map;
pub mod maps;
pub mod orbit;
mod panels;
pub mod theory;
