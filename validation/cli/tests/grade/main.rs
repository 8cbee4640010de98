//! `shearbed grade REF MINE` and `shearbed grade --command` as a user meets them, on answers made from the certified
//! ones and on programs in other languages. The problems are exported once.

#[path = "../common/bounded.rs"]
mod bounded;
#[path = "../common/grading.rs"]
mod grading;
#[path = "../common/programs.rs"]
mod programs;

mod closures;
mod edited;
mod peers;
mod planted;
mod templates;
