//! Input from users: built-in scenes and their keys, files of rods, measured and published points. It may use `files`.
//! A published data set is a folder of `validation/published` and a function of `published`.

pub mod experiment;
pub mod published;
pub mod scene_keys;
pub mod scenes;
pub mod start;
