//! The book (`docs/src/`) and the READMEs: what is made from the program is fresh, every link leads somewhere, every
//! shell block of the user guide runs and prints what is shown, numbers are those of their commands, and the parts keep
//! to their length.

mod blocks;
#[path = "../common/bounded.rs"]
mod bounded;
mod generated;
mod length;
mod links;
mod numbers;
mod pages;
