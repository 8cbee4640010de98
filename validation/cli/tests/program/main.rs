//! The program as a user meets it, and what the suite hands out: one executable, whose tests share the cores.

#[path = "../common/mod.rs"]
mod common;

mod certified;
mod checkpoint;
mod columns;
mod contributing;
mod ending;
#[rustfmt::skip]
mod example_case;
#[rustfmt::skip]
mod example_study;
mod experiments;
mod folders {
    mod stopped;
}
mod order;
mod report;
mod run;
mod supply;
#[cfg(target_os = "linux")]
mod transcripts;
