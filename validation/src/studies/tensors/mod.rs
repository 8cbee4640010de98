//! Closures against the exact distribution.

mod measure;
pub mod study;

use super::*;
