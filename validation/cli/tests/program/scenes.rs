//! The scenes that are built in, and their plans.

use crate::common::{shearbed, unequal};
use std::fs;

#[test]
fn a_file_wins_over_a_built_in_scene_and_a_folder_does_not() {
    let dir = unequal();
    fs::create_dir(dir.path().join("fig5")).unwrap();
    assert!(shearbed(dir.path(), "plan fig5").stdout.starts_with("Fig. 5"));
    fs::rename(dir.path().join("small.toml"), dir.path().join("fig12")).unwrap();
    assert!(shearbed(dir.path(), "plan fig12").stdout.starts_with("A small scene"));
}

#[test]
fn plans_of_built_in_scenes() {
    let dir = unequal();
    let plan = |name: &str| shearbed(dir.path(), &format!("plan {name}")).stdout;
    insta::assert_snapshot!(plan("fig9-sd3.6"));
    insta::assert_snapshot!(plan("fig4-n50"));
    insta::assert_snapshot!(plan("extension"));
}

#[test]
fn the_built_in_scenes_are_listed_and_shown() {
    let dir = unequal();
    insta::assert_snapshot!(shearbed(dir.path(), "scenes").stdout);
    let shown = shearbed(dir.path(), "scenes --show fig5").stdout;
    fs::write(dir.path().join("mine.toml"), shown).unwrap();
    let plan = |scene| shearbed(dir.path(), &format!("plan {scene}")).stdout;
    assert_eq!(plan("mine.toml"), plan("fig5"));
}
