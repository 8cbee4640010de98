//! Output for readers.
//!
//! - [`study`]: the contract of a study, and what it finds: tables, figures, files.
//! - [`table`], [`plot`]: a table as text, Markdown, HTML and CSV; a figure as SVG, PDF and PNG.
//! - [`report`]: the pages of `validate`. `markup`: from plain text to each format.
//!
//! It may use `judge` and all parts above. To add a kind of picture, add a field to `plot::Figure` and draw it in a
//! module of `plot`; every format follows from the SVG.

pub(crate) mod markup;
pub mod plot;
pub mod report;
pub mod study;
pub mod table;
#[cfg(test)]
pub(crate) mod xml;
