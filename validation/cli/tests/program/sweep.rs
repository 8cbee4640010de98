//! `shearbed sweep` after a kill.
#![cfg(unix)]

use crate::common::running::Running;
use crate::common::{command, folder, shearbed};
use std::fs;

#[test]
fn a_killed_sweep_goes_on_to_the_same_bytes() {
    let sweep = "sweep small.toml --over interaction.alpha=0.1:1.2:12 --out killed --threads";
    let dir = folder();
    let killed = dir.at("killed");
    // Each life waits where it says that one more point is finished, until it is killed.
    for life in 1..4 {
        let mut running = Running::held_at_its_first_message(command(dir.path(), &format!("{sweep} 1")));
        let point = killed.join(format!("points/{life:02}"));
        running.wait_for("one more point is finished", || point.exists());
        running.signal("-KILL");
        assert_eq!(running.end().code, None);
        let names = fs::read_dir(killed.join("points")).unwrap();
        assert_eq!(names.count(), life);
    }
    assert!(!killed.join("sweep.csv").exists());
    // What a kill in the middle of a point leaves.
    let left = killed.join("points/.shearbed-0123456789abcdef");
    fs::create_dir(&left).unwrap();
    fs::write(left.join("projections.csv"), "half a ta").unwrap();

    let ended = shearbed(dir.path(), &format!("{sweep} 2"));
    let said = "killed/points/.shearbed-0123456789abcdef: a shearbed that was killed left this folder";
    assert!(ended.stderr.contains(said), "{}", ended.stderr);
    let text = ended.stdout;
    fs::remove_dir_all(left).unwrap();
    assert!(text.starts_with("goes on from killed: 3 of 12 points are finished\n"), "{text}");
    assert!(text.contains("points: 12, of which 3 were finished before"), "{text}");
    dir.runs(&format!("{sweep} 1").replace("killed", "whole"));
    assert_eq!(dir.files("killed"), dir.files("whole"));
    // Once more: nothing is left to do, and nothing changes.
    let whole = dir.files("killed");
    dir.runs(&format!("{sweep} 1"));
    assert_eq!(dir.files("killed"), whole);
}
