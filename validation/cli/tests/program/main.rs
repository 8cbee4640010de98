//! The program as a user meets it, and what the suite hands out: one executable, whose tests share the cores.

#[path = "../common/mod.rs"]
mod common;

mod certified;
mod checkpoint;
mod columns;
mod contributing;
mod diffusing;
mod ending;
#[rustfmt::skip]
mod example_case;
#[rustfmt::skip]
mod example_study;
mod experiments;
mod fit;
mod folders;
mod hostile;
mod order;
mod overwrite;
mod plot;
mod problems;
mod provenance;
mod reference;
mod report;
mod reports;
mod resources;
mod rods;
mod run;
mod set;
mod shape;
mod studies;
mod supply;
mod sweep;
#[cfg(target_os = "linux")]
mod transcripts;
mod until;
