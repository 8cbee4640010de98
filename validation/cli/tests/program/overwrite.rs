//! What lies in a folder already, and what is left where a run cannot be.

use crate::common::bounded::Bounded;
use crate::common::{UNEQUAL, names, unequal};
use std::fs;
use std::process::Command;

#[test]
fn a_run_that_ends_badly_leaves_what_was_complete() {
    let dir = unequal();
    dir.runs("run small.toml --quiet --out a");
    dir.write("small.toml", UNEQUAL.replace("aspect_ratio = 11.6", "aspect_ratio = 1e200"));
    dir.refuses("run small.toml --quiet --out a", "particles.aspect_ratio = 1e200 is not allowed");
}

#[test]
fn a_file_that_cannot_be_replaced_leaves_all_as_it_was() {
    let dir = unequal();
    dir.write("out/run.json/x", "a folder");
    dir.write("out/projections.csv", "old");
    dir.refuses("run small.toml --out out --force", "error: out/run.json: cannot be written: is a directory\n");
}

#[test]
fn no_command_replaces_a_file_that_it_reads() {
    let dir = unequal();
    let points = "t_over_T,x1,x1_u\n0.5,0.3,0.01\n1,0.2,0.01\n1.5,0.2,0.01\n";
    dir.write("f/residuals.csv", points);
    dir.write("points.svg", points);
    let small = dir.read("small.toml");
    dir.write("from.toml", small.replace("orientation = \"isotropic\"", "rods = { file = \"r/rods.csv\" }"));
    dir.write("s/run.json", small);
    dir.runs("run small.toml --quiet --out a");
    // Rods that the earlier run wrote, and that the next one would remove.
    dir.runs("run small.toml --set output.rods_at=[1] --replicas 1 --quiet --out r");
    dir.runs("problems export ref --quiet");
    dir.write("mine/sphere/answer.csv", dir.read("ref/sphere/certified.csv"));
    for (arguments, file) in [
        ("fit fig4-n50 --data f/residuals.csv --over interaction.alpha=0.1:1 --out f --force", "f/residuals.csv"),
        ("plot a --data points.svg --out points.svg --force", "points.svg"),
        ("run from.toml --replicas 1 --out r --force", "r/rods.csv"),
        ("run s/run.json --out s --force", "s/run.json"),
        ("grade ref mine --problem sphere --out ref --force", "ref/shearbed.json"),
    ] {
        dir.refuses(arguments, &format!("would replace {file}, which this command reads: choose another --out"));
    }
    // Results of another command stay.
    dir.runs("run small.toml --quiet --out ref --force");
    assert!(dir.at("ref/sphere/certified.csv").exists());
}

#[test]
fn a_run_replaces_an_earlier_one_and_says_so_but_nothing_that_was_edited() {
    let dir = unequal();
    let run = |arguments: &str| dir.runs(&format!("run small.toml --out a {arguments}"));
    let tables = || {
        let mut all = dir.files("a");
        all.retain(|name, _| name.ends_with(".csv") || name.ends_with(".svg"));
        all
    };
    assert!(!run("").stdout.contains("replaced"));
    let first = tables();
    // The same again replaces nothing that is other.
    assert!(!run("--threads 1").stdout.contains("replaced"));
    assert_eq!(tables(), first);
    dir.write("a/notes.txt", "mine");
    for (arguments, what) in [
        ("--seed 2", "scene.ensemble.seed was 1 and is 2 now"),
        ("--replicas 4", "scene.ensemble.replicas was 3 and is 4 now"),
        ("--set interaction.alpha=0.4", "scene.ensemble.replicas was 4 and is 3 now"),
    ] {
        let printed = run(arguments).stdout;
        assert!(printed.contains(&format!("(replaced an earlier run: {what}")), "{arguments}: {printed}");
        assert_ne!(tables(), first);
    }
    // What the earlier run left and this one does not write goes; the user's own stays.
    run("--set output.observables=[\"mean_angle\"]");
    assert_eq!(names(&dir.at("a")), ["mean_angle.csv", "mean_angle.svg", "notes.txt", "run.json", "shearbed.json"]);
    assert_eq!(dir.read("a/notes.txt"), "mine");

    // What is no record, and what was changed since.
    let record = dir.read("a/shearbed.json");
    dir.write("a/shearbed.json", "{");
    dir.refuses("run small.toml --out a", "a/shearbed.json: is no record of results");
    dir.write("a/shearbed.json", record);
    dir.write("a/mean_angle.csv", "edited");
    for seed in [1, 2] {
        let changed = "a/mean_angle.csv: was changed after `shearbed run` wrote it";
        dir.refuses(&format!("run small.toml --out a --seed {seed}"), changed);
    }
    run("--force");
    assert_eq!(tables(), first);
}

/// One rule for all commands: what a command did not write itself, or wrote from other input, stays.
#[test]
fn what_a_command_did_not_write_stays() {
    let dir = unequal();
    for (command, mine) in [
        ("run small.toml --out r", "r/projections.csv"),
        ("run small.toml --out q", "q/mean_angle.svg"),
        ("validate --case jeffery-period --out v", "v/report.md"),
        ("sweep small.toml --over interaction.alpha=1,2 --out s", "s/sweep.csv"),
        ("reference --aspect-ratio 2 --times 0:1:3 --out x.csv", "x.csv"),
    ] {
        dir.write(mine, "mine");
        dir.refuses(command, &format!("{mine}: is here already"));
        dir.runs(&format!("{command} --force"));
        assert_ne!(dir.read(mine), "mine", "{command}");
        // The same again is its own.
        dir.runs(command);
    }
    for other in [
        "validate --case kick-bound --out v",
        "reference --aspect-ratio 3 --times 0:1:3 --out x.csv",
        "plot r --out r/projections.svg",
    ] {
        dir.refuses(other, "--force overwrites it");
    }
}

#[cfg(unix)]
#[test]
fn a_file_is_written_where_a_link_leads_and_a_pipe_keeps_nobody_waiting() {
    let dir = unequal();
    let reference = "reference --aspect-ratio 2 --times 0:1:3 --force --out";
    dir.runs(&format!("{reference} plain.csv"));
    let expected = dir.read("plain.csv");
    dir.write("target.csv", "old");
    for (link, target) in [("link.csv", "target.csv"), ("dangling.csv", "new.csv")] {
        std::os::unix::fs::symlink(target, dir.at(link)).unwrap();
        dir.runs(&format!("{reference} {link}"));
        assert!(dir.at(link).is_symlink());
        assert_eq!(dir.read(target), expected);
    }
    // A pipe that nobody reads or writes keeps no command waiting, wherever it lies.
    for (pipe, arguments) in [
        ("pipe", "reference --aspect-ratio 2 --times 0:1:3 --force --out pipe"),
        ("p.svg", "plot a --out p.svg"),
        ("kept", "run small.toml --out k --checkpoint kept"),
        ("scene.toml", "run scene.toml --out k"),
        ("r/report.json", "compare r/report.json r/report.json"),
        ("s/shearbed.json", "sweep small.toml --over interaction.alpha=1,2 --out s"),
        ("d/d.csv", "fit small.toml --data d/d.csv --over interaction.alpha=0.1:1"),
    ] {
        dir.runs("run small.toml --quiet --out a");
        fs::create_dir_all(dir.at(pipe).parent().unwrap()).unwrap();
        assert!(Command::new("mkfifo").arg(dir.at(pipe)).ended().status.success());
        dir.refuses(arguments, "a regular file is needed");
        assert!(!fs::metadata(dir.at(pipe)).unwrap().is_file());
    }
}

#[test]
fn a_study_spares_what_it_did_not_write_and_a_run() {
    let dir = unequal();
    let converge = "converge fig6-uniform --set particles.aspect_ratio=1 --set time.periods=2 --quiet --out";
    dir.write("a/replicas.csv", "mine");
    dir.refuses(&format!("{converge} a"), "a/replicas.csv: is here already");
    fs::remove_file(dir.at("a/replicas.csv")).unwrap();
    dir.runs(&format!("{converge} a"));
    assert_eq!(names(&dir.at("a")), ["converge.csv", "converge.json", "shearbed.json"]);
    dir.runs("run small.toml --quiet --out b");
    dir.refuses(&format!("{converge} b"), "b/shearbed.json: results of `shearbed run` are kept here");
}

#[test]
fn a_checkpoint_has_no_name_of_a_result() {
    let dir = unequal();
    dir.write("d/notes.txt", "");
    let outside = "a result may have that name; choose a checkpoint outside the output folder";
    dir.refuses("run small.toml --quiet --out d --checkpoint d/projections.csv", outside);
    dir.runs("run small.toml --quiet --out d --checkpoint d/kept");
}
