//! Tools for users.
//!
//! - [`problems`]: reference problems with their answers. [`grade`]: grades the answers of other programs, from
//!   files or live.
//! - [`fit`]: parameters from measured points. [`sweep`]: a scene over values of its keys.
//!
//! They may use `studies` and all parts above; commands only parse arguments and call them. To add a problem, write an
//! entry in a file of `problems`; to add a known mistake, an entry in `grade::mistakes`.

pub mod fit;
pub mod grade;
pub mod problems;
pub mod sweep;
