//! The validation suite of shearbed: cases with tolerances and controls, the oracles that judge the core,
//! the report, and the program's commands.
#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

pub mod accept;
pub mod build;
pub mod case;
pub mod cases;
pub mod catalogue;
pub mod checkpoint;
pub mod cli;
pub mod cluster;
pub mod coefficients;
pub mod dependencies;
mod difference;
pub mod equations;
pub mod experiment;
pub mod figures;
pub mod fit;
pub mod grade;
pub mod input;
pub mod integrators;
pub mod kicks;
pub mod lab;
mod markup;
pub mod output;
pub mod plot;
pub mod problems;
pub mod published;
pub mod readings;
pub mod report;
pub mod scene_keys;
pub mod scenes;
#[cfg(test)]
mod source;
pub mod speed;
pub mod stability;
pub mod start;
pub mod statistics;
pub mod studies;
pub mod study;
pub mod suspensions;
pub mod sweep;
pub mod table;
mod text;
pub mod tried;
pub mod work_precision;
#[cfg(test)]
mod xml;

pub use shearbed_oracle as oracle;
