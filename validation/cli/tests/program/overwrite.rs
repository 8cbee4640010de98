//! What lies in a folder already, and what is left where a run cannot be.

use crate::common::bounded::Bounded;
use crate::common::{UNEQUAL, files, limited, names, read, shearbed, unequal};
use std::fs;
use std::path::Path;

#[test]
fn a_name_with_a_dot_keeps_it_in_the_folder() {
    let dir = unequal();
    assert_eq!(shearbed(dir.path(), "run fig8-a0.36 --replicas 1 --quiet").code, Some(0));
    assert_eq!(names(&dir.path().join("out")), ["fig8-a0.36"]);
}

#[test]
fn a_run_that_ends_badly_leaves_what_was_complete() {
    let dir = unequal();
    assert_eq!(shearbed(dir.path(), "run small.toml --quiet --out a").code, Some(0));
    let before: Vec<_> =
        names(&dir.path().join("a")).iter().map(|name| read(&dir.path().join("a").join(name))).collect();
    fs::write(dir.path().join("small.toml"), UNEQUAL.replace("aspect_ratio = 11.6", "aspect_ratio = 1e200")).unwrap();
    let ended = shearbed(dir.path(), "run small.toml --quiet --out a");
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("particles.aspect_ratio = 1e200 is not allowed"), "{}", ended.stderr);
    let after: Vec<_> =
        names(&dir.path().join("a")).iter().map(|name| read(&dir.path().join("a").join(name))).collect();
    assert_eq!(before, after);
}

#[test]
fn a_file_that_cannot_be_replaced_leaves_all_as_it_was() {
    let dir = unequal();
    let out = dir.path().join("out");
    fs::create_dir_all(out.join("run.json")).unwrap();
    fs::write(out.join("projections.csv"), "old").unwrap();
    let ended = shearbed(dir.path(), "run small.toml --out out --force");
    assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""));
    assert_eq!(ended.stderr, "error: out/run.json: cannot be written: is a directory\n");
    assert_eq!(names(&out), ["projections.csv", "run.json"]);
    assert_eq!(read(&out.join("projections.csv")), "old");
}

#[test]
fn no_command_replaces_a_file_that_it_reads() {
    let dir = unequal();
    fs::create_dir(dir.path().join("f")).unwrap();
    let points = "t_over_T,x1,x1_u\n0.5,0.3,0.01\n1,0.2,0.01\n1.5,0.2,0.01\n";
    let file = dir.path().join("f/residuals.csv");
    fs::write(&file, points).unwrap();
    fs::copy(&file, dir.path().join("points.svg")).unwrap();
    assert_eq!(shearbed(dir.path(), "run small.toml --quiet --out a").code, Some(0));
    grade_keeps_its_references(dir.path());
    a_scene_and_rods_of_earlier_results_stay(dir.path());
    for (arguments, read_file) in [
        ("fit fig4-n50 --data f/residuals.csv --over interaction.alpha=0.1:1 --out f --force", "f/residuals.csv"),
        ("plot a --data points.svg --out points.svg --force", "points.svg"),
    ] {
        let ended = shearbed(dir.path(), arguments);
        let said = format!("a result would replace {read_file}, which this command reads: choose another --out");
        assert!(ended.code == Some(2) && ended.stderr.contains(&said), "{arguments}: {}", ended.stderr);
        assert_eq!(read(&dir.path().join(read_file)), points);
    }
}

fn grade_keeps_its_references(dir: &Path) {
    assert_eq!(shearbed(dir, "problems export ref --quiet").code, Some(0));
    fs::create_dir_all(dir.join("mine/sphere")).unwrap();
    let certified = dir.join("ref/sphere/certified.csv");
    fs::copy(&certified, dir.join("mine/sphere/answer.csv")).unwrap();
    let ended = shearbed(dir, "grade ref mine --problem sphere --out ref --force");
    let said = "would replace ref/shearbed.json, which this command reads";
    assert!(ended.code == Some(2) && ended.stderr.contains(said), "{}", ended.stderr);
    // Results of another command stay.
    assert_eq!(shearbed(dir, "run small.toml --quiet --out ref --force").code, Some(0));
    assert!(certified.exists());
}

fn a_scene_and_rods_of_earlier_results_stay(dir: &Path) {
    let small = read(&dir.join("small.toml"));
    // Rods that the earlier run wrote, and that this one would remove.
    let first = "run small.toml --set output.rods_at=[1] --replicas 1 --quiet --out r";
    assert_eq!(shearbed(dir, first).code, Some(0));
    let from_rods = small.replace("orientation = \"isotropic\"", "rods = { file = \"r/rods.csv\" }");
    fs::write(dir.join("from.toml"), from_rods).unwrap();
    fs::create_dir(dir.join("s")).unwrap();
    fs::write(dir.join("s/run.json"), &small).unwrap();
    for (arguments, file) in
        [("run from.toml --replicas 1 --out r --force", "r/rods.csv"), ("run s/run.json --out s --force", "s/run.json")]
    {
        let before = read(&dir.join(file));
        let ended = shearbed(dir, arguments);
        let said = format!("would replace {file}, which this command reads");
        assert!(ended.code == Some(2) && ended.stderr.contains(&said), "{arguments}: {}", ended.stderr);
        assert_eq!(read(&dir.join(file)), before);
    }
}

#[test]
fn a_run_replaces_an_earlier_one_and_says_so_but_nothing_that_was_edited() {
    let dir = unequal();
    let run = |arguments: &str| shearbed(dir.path(), &format!("run small.toml --out a {arguments}"));
    let out = dir.path().join("a");
    let tables = |out: &Path| {
        let mut all = files(out);
        all.retain(|name, _| name.ends_with(".csv") || name.ends_with(".svg"));
        all
    };
    assert!(!run("").stdout.contains("replaced"));
    let first = tables(&out);
    // The same again replaces nothing that is other.
    assert!(!run("--threads 1").stdout.contains("replaced"));
    assert_eq!(tables(&out), first);
    fs::write(out.join("notes.txt"), "mine").unwrap();
    for (arguments, what) in [
        ("--seed 2", "scene.ensemble.seed was 1 and is 2 now"),
        ("--replicas 4", "scene.ensemble.replicas was 3 and is 4 now"),
        ("--set interaction.alpha=0.4", "scene.ensemble.replicas was 4 and is 3 now"),
    ] {
        let ended = run(arguments);
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        let said = format!("(replaced an earlier run: {what}");
        assert!(ended.stdout.contains(&said), "{arguments}: {}", ended.stdout);
        assert_ne!(tables(&out), first);
    }
    // What the earlier run left and this one does not write goes; the user's own stays.
    assert_eq!(run("--set output.observables=[\"mean_angle\"]").code, Some(0));
    let left = ["mean_angle.csv", "mean_angle.svg", "notes.txt", "run.json", "shearbed.json"];
    assert_eq!(names(&out), left);
    assert_eq!(read(&out.join("notes.txt")), "mine");

    // What is no record, and what was changed since.
    let record = read(&out.join("shearbed.json"));
    fs::write(out.join("shearbed.json"), "{").unwrap();
    assert!(run("").stderr.contains("a/shearbed.json: is no record of results"));
    fs::write(out.join("shearbed.json"), record).unwrap();
    fs::write(out.join("mean_angle.csv"), "edited").unwrap();
    let before = files(&out);
    for seed in [1, 2] {
        let said = run(&format!("--seed {seed}")).stderr;
        assert!(said.contains("a/mean_angle.csv: was changed after `shearbed run` wrote it"), "{said}");
        assert_eq!(files(&out), before);
    }
    assert_eq!(run("--force").code, Some(0));
    assert_eq!(tables(&out), first);
}

/// One rule for all commands: what a command did not write itself, or wrote from other input, stays.
#[test]
fn what_a_command_did_not_write_stays() {
    let dir = unequal();
    let ended = |arguments: &str| {
        let ended = shearbed(dir.path(), arguments);
        (ended.code, ended.stderr)
    };
    let put = |name: &str| {
        fs::create_dir_all(dir.path().join(name).parent().unwrap()).unwrap();
        fs::write(dir.path().join(name), "mine").unwrap();
    };
    for (command, mine) in [
        ("run small.toml --out r", "r/projections.csv"),
        ("run small.toml --out q", "q/mean_angle.svg"),
        ("validate --case jeffery-period --out v", "v/report.md"),
        ("sweep small.toml --over interaction.alpha=1,2 --out s", "s/sweep.csv"),
        ("reference --aspect-ratio 2 --times 0:1:3 --out x.csv", "x.csv"),
    ] {
        put(mine);
        let (code, said) = ended(command);
        assert_eq!(code, Some(2), "{command}: {said}");
        assert!(said.contains(&format!("{mine}: is here already")), "{command}: {said}");
        assert_eq!(read(&dir.path().join(mine)), "mine");
        assert_eq!(ended(&format!("{command} --force")).0, Some(0), "{command}");
        assert_ne!(read(&dir.path().join(mine)), "mine", "{command}");
        // The same again is its own.
        let (code, said) = ended(command);
        assert_eq!(code, Some(0), "{command}: {said}");
    }
    for other in [
        "validate --case kick-bound --out v",
        "reference --aspect-ratio 3 --times 0:1:3 --out x.csv",
        "plot r --out r/projections.svg",
    ] {
        let (code, said) = ended(other);
        assert_eq!(code, Some(2), "{other}: {said}");
        assert!(said.contains("--force overwrites it"), "{other}: {said}");
    }
}

#[cfg(unix)]
#[test]
fn a_file_is_written_where_a_link_leads_and_a_pipe_keeps_nobody_waiting() {
    let dir = unequal();
    let reference = |out: &str| format!("reference --aspect-ratio 2 --times 0:1:3 --out {out}");
    assert_eq!(shearbed(dir.path(), &reference("plain.csv")).code, Some(0));
    let expected = read(&dir.path().join("plain.csv"));
    fs::write(dir.path().join("target.csv"), "old").unwrap();
    for (link, target) in [("link.csv", "target.csv"), ("dangling.csv", "new.csv")] {
        std::os::unix::fs::symlink(target, dir.path().join(link)).unwrap();
        assert_eq!(shearbed(dir.path(), &format!("{} --force", reference(link))).code, Some(0));
        assert!(dir.path().join(link).is_symlink());
        assert_eq!(read(&dir.path().join(target)), expected);
    }
    let mkfifo = |name: &str| {
        let pipe = dir.path().join(name);
        fs::create_dir_all(pipe.parent().unwrap()).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(&pipe).ended().status.success());
    };
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
        assert_eq!(shearbed(dir.path(), "run small.toml --quiet --out a").code, Some(0));
        mkfifo(pipe);
        let ended = limited(dir.path(), "true", arguments);
        assert_eq!(ended.code, Some(2), "{arguments}: {}", ended.stderr);
        assert!(ended.stderr.contains("a regular file is needed"), "{arguments}: {}", ended.stderr);
        assert!(!fs::metadata(dir.path().join(pipe)).unwrap().is_file());
    }
    assert!(!dir.path().join("k/run.json").exists());
}

#[test]
fn a_study_spares_what_it_did_not_write_and_a_run() {
    let dir = unequal();
    let out = dir.path().join("a");
    let converge = |scene: &str, out: &str| {
        shearbed(
            dir.path(),
            &format!("converge {scene} --set particles.aspect_ratio=1 --set time.periods=2 --quiet --out {out}"),
        )
    };
    fs::create_dir(&out).unwrap();
    fs::write(out.join("replicas.csv"), "mine").unwrap();
    let ended = converge("fig6-uniform", "a");
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("a/replicas.csv: is here already"), "{}", ended.stderr);
    fs::remove_file(out.join("replicas.csv")).unwrap();
    assert_eq!(converge("fig6-uniform", "a").code, Some(0));
    assert_eq!(names(&out), ["converge.csv", "converge.json", "shearbed.json"]);
    assert_eq!(shearbed(dir.path(), "run small.toml --quiet --out b").code, Some(0));
    let before = names(&dir.path().join("b"));
    let ended = converge("fig6-uniform", "b");
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("b/shearbed.json: results of `shearbed run` are kept here"), "{}", ended.stderr);
    assert_eq!(names(&dir.path().join("b")), before);
}

#[test]
fn a_point_of_a_sweep_and_a_checkpoint_are_no_place_for_a_run() {
    let dir = unequal();
    let ended = |arguments: &str| {
        let ended = shearbed(dir.path(), arguments);
        (ended.code, ended.stderr)
    };
    assert_eq!(ended("sweep small.toml --over interaction.alpha=0.1,0.2 --out w --quiet").0, Some(0));
    let before = read(&dir.path().join("w/points/1/projections.csv"));
    let (code, said) = ended("run small.toml --quiet --out w/points/1 --seed 77");
    assert!(
        code == Some(2) && said.contains("w/points/1/shearbed.json: results of `shearbed sweep` are kept here"),
        "{said}"
    );
    assert_eq!(read(&dir.path().join("w/points/1/projections.csv")), before);
    fs::create_dir(dir.path().join("d")).unwrap();
    let (code, said) = ended("run small.toml --quiet --out d --checkpoint d/projections.csv");
    assert!(
        code == Some(2) && said.contains("a result may have that name; choose a checkpoint outside the output folder"),
        "{said}"
    );
    assert_eq!(ended("run small.toml --quiet --out d --checkpoint d/kept").0, Some(0));
}
