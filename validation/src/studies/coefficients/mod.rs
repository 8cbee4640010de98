//! The effect of collisions on ⟨pp⟩, measured in runs: C_I with measured ⟨pppp⟩ (no closure), J per collision, and the
//! rods' stress.

mod comparison;
pub mod jumps;
mod measure;
pub mod study;

use super::*;
pub use measure::{Coefficients, FINER, Places, Setting, kick, rows, settings};
pub(crate) use measure::{scene, windows};
