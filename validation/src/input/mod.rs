//! What users give: scenes and their keys, files of rods, measured points.
//!
//! - [`scenes`]: the built-in scenes and those of files; [`scene_keys`]: the table of keys.
//! - [`start`]: files of rods. [`experiment`]: measured points and their comparison. [`published`]: data sets that
//!   ship.
//!
//! It may use `files`. To add a built-in scene, put a file into `validation/scenes`. To add a data set, put a folder
//! with its provenance into `validation/published` and a function into `published`. Reading an input checks its form;
//! whether a scene makes sense is decided by `Plan::new` alone.

pub mod experiment;
pub mod published;
pub mod scene_keys;
pub mod scenes;
pub mod start;
