//! Output for readers: the contract of a study, the report, plots, tables and markup. It may use `judge` and all modules below.

pub(crate) mod markup;
pub mod plot;
pub mod report;
pub mod study;
pub mod table;
#[cfg(test)]
pub(crate) mod xml;
