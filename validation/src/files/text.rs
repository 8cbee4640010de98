//! Texts of other people, made harmless and short.

mod cells;
mod message;
mod readable;
mod shell;

pub(crate) use cells::cell;
pub use cells::{four_decimals, left_aligned, right_aligned};
pub(crate) use message::shortened;
pub use message::{complain, message, snippet, start_of};
pub use readable::{Shown, line, readable};
pub(crate) use readable::{escaped, json};
pub use shell::command;
