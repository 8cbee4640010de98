//! `shearbed sweep` as a user meets it: rows, going on after a kill, refusals.

use crate::common::{SMALL, files, folder, shearbed};
use std::fs;
use std::path::Path;

/// Exit code 2, and the message.
fn refused(dir: &Path, arguments: &str) -> String {
    let ended = shearbed(dir, arguments);
    assert_eq!(ended.code, Some(2), "{arguments}: {}", ended.stderr);
    ended.stderr
}

fn succeeds(dir: &Path, arguments: &str) -> String {
    let ended = shearbed(dir, arguments);
    assert_eq!(ended.code, Some(0), "{arguments}: {}", ended.stderr);
    ended.stdout
}

const GRID: &str = "--over interaction.alpha=0.1:0.3:3 --over interaction.update=rotation,angles";

#[test]
fn a_row_is_the_last_output_of_a_run_with_these_keys() {
    let dir = folder();
    let text = succeeds(dir.path(), &format!("sweep small.toml {GRID} --seed 7 --threads 2"));
    assert!(text.contains("points: 6, of which 0 were finished before"), "{text}");
    let out = dir.path().join("out/sweep-small");
    let csv = fs::read_to_string(out.join("sweep.csv")).unwrap();
    let rows: Vec<_> = csv.lines().collect();
    assert_eq!(
        rows[0],
        "interaction.alpha,interaction.update,t_over_T,time_s,strain,x1,x1_se,x2,x2_se,x3,x3_se,phi,phi_se"
    );
    let points = ["0.1,rotation", "0.1,angles", "0.2,rotation", "0.2,angles", "0.3,rotation", "0.3,angles"];
    assert_eq!(rows.len(), 1 + points.len());
    for (k, (row, point)) in rows[1..].iter().zip(points).enumerate() {
        // The same point by hand, as a scene of its own.
        let (alpha, update) = point.split_once(',').unwrap();
        let scene = SMALL.replace("alpha = 0.5", &format!("alpha = {alpha}\nupdate = \"{update}\""));
        fs::write(dir.path().join("point.toml"), scene).unwrap();
        succeeds(dir.path(), "run point.toml --seed 7 --quiet --force");
        let table = |name: &str| fs::read_to_string(dir.path().join("out/point").join(name)).unwrap();
        let last = |name: &str| table(name).lines().last().unwrap().to_owned();
        let angle = last("mean_angle.csv");
        // Behind the time in its three columns, which the first table has already.
        let angle = angle.splitn(4, ',').last().unwrap();
        assert_eq!(*row, format!("{point},{},{angle}", last("projections.csv")));
        let kept = out.join(format!("points/{}/projections.csv", k + 1));
        assert_eq!(fs::read_to_string(kept).unwrap(), table("projections.csv"));
    }
}

#[cfg(unix)]
#[test]
fn a_killed_sweep_goes_on_to_the_same_bytes() {
    use crate::common::{command, running::Running};

    let sweep = "sweep small.toml --over interaction.alpha=0.1:1.2:12 --out killed --threads";
    let dir = folder();
    let killed = dir.path().join("killed");
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
    succeeds(dir.path(), &format!("{sweep} 1").replace("killed", "whole"));
    assert_eq!(files(&killed), files(&dir.path().join("whole")));
    // Once more: nothing is left to do, and nothing changes.
    let whole = files(&killed);
    succeeds(dir.path(), &format!("{sweep} 1"));
    assert_eq!(files(&killed), whole);
}

#[test]
fn another_sweep_in_the_folder_is_refused_and_left_as_it_is() {
    let dir = folder();
    let sweep = |rest: &str| format!("sweep small.toml --out here {rest}");
    let first = sweep(&format!("{GRID} --quiet"));
    succeeds(dir.path(), &first);
    let here = dir.path().join("here");
    let kept = files(&here);
    let kept_before = kept.clone();
    for (arguments, named) in [
        (sweep("--over interaction.alpha=0.1:0.3:3"), "over was"),
        (sweep(&format!("{GRID} --seed 2")), "scene.ensemble.seed was 1 and is 2 now"),
        (sweep(&format!("{GRID} --replicas 4")), "scene.ensemble.replicas was 3 and is 4 now"),
    ] {
        let message = refused(dir.path(), &arguments);
        assert!(
            message.contains(&format!(
                "here/shearbed.json: results of `shearbed sweep` from other input are kept here: {named}"
            )),
            "{message}"
        );
        assert!(message.contains("nothing was changed"), "{message}");
    }
    fs::write(dir.path().join("small.toml"), SMALL.replace("count = 20", "count = 21")).unwrap();
    let message = refused(dir.path(), &first);
    assert!(message.contains("scene.particles.count was 20 and is 21 now"), "{message}");
    fs::write(dir.path().join("small.toml"), SMALL).unwrap();
    assert_eq!(files(&here), kept);

    // A version whose number has changed, and one whose results have without it.
    let record = fs::read_to_string(here.join("shearbed.json")).unwrap();
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    assert!(record.contains(&version));
    fs::write(here.join("shearbed.json"), record.replace(&version, "\"version\": \"0.0.1\"")).unwrap();
    assert!(refused(dir.path(), &first).contains("version was \"0.0.1\" and is"));
    fs::write(here.join("shearbed.json"), record).unwrap();
    fs::remove_dir_all(here.join("points/6")).unwrap();
    let point = here.join("points/1/projections.csv");
    let table = fs::read_to_string(&point).unwrap();
    let other = table.replacen("0.", "0.9", 1);
    fs::write(&point, &other).unwrap();
    // As that build would have kept it.
    let [sum, own] = [&table, &other].map(|text| {
        let bytes = text.len();
        format!("\"bytes\": {bytes},\n      \"crc32\": \"{:08x}\"", crc32fast::hash(text.as_bytes()))
    });
    let kept = here.join("points/1/shearbed.json");
    let text = fs::read_to_string(&kept).unwrap();
    assert!(text.contains(&sum), "{text}");
    fs::write(&kept, text.replace(&sum, &own)).unwrap();
    let message = refused(dir.path(), &first);
    assert!(message.contains("here/points/1: run again, this point gives other numbers"), "{message}");
    assert!(!here.join("points/6").exists());

    // Files of unknown origin.
    for name in ["shearbed.json", "sweep.json", "sweep.csv"] {
        fs::remove_file(here.join(name)).unwrap();
        let message = refused(dir.path(), &first);
        assert!(message.contains("is here already, and no shearbed.json says that this command wrote it"), "{message}");
    }
    // By force all is new, and nothing of before is left.
    succeeds(dir.path(), &format!("{first} --force"));
    assert_eq!(files(&here), kept_before);
    fs::write(&point, &other).unwrap();
    let message = refused(dir.path(), &first);
    assert!(message.contains("not as it was written") && message.contains("--force"), "{message}");
    succeeds(dir.path(), &format!("{first} --force"));
    assert_eq!(files(&here), kept_before);

    // A file that is gone is written again; what is of another sweep goes by force, what somebody put beside it does
    // not.
    fs::remove_file(here.join("sweep.json")).unwrap();
    succeeds(dir.path(), &first);
    assert_eq!(files(&here), kept_before);
    let other = first.replace("small.toml", "other.toml");
    fs::write(dir.path().join("other.toml"), SMALL.replace("count = 20", "count = 21")).unwrap();
    for mine in ["points/1/notes.txt", "points/2/mine"] {
        if mine.ends_with(".txt") {
            fs::write(here.join(mine), "notes").unwrap()
        } else {
            fs::create_dir(here.join(mine)).unwrap()
        }
        let kept = files(&here);
        let message = refused(dir.path(), &format!("{other} --force"));
        assert!(message.contains(&format!("{mine}: was not written by `shearbed sweep`")), "{message}");
        assert_eq!(files(&here), kept);
        let _ = fs::remove_file(here.join(mine)).or_else(|_| fs::remove_dir(here.join(mine)));
    }
    succeeds(dir.path(), &format!("{other} --force"));
    assert_ne!(files(&here), kept_before);
}

#[test]
fn a_start_that_has_changed_is_another_sweep() {
    let dir = folder();
    let scene = SMALL.replace("orientation = \"isotropic\"", "rods = { file = \"a.csv\" }");
    assert_ne!(scene, SMALL);
    fs::write(dir.path().join("small.toml"), scene).unwrap();
    let start = |name: &str, row: &str| {
        fs::write(dir.path().join(name), "p1,p2,p3\n".to_owned() + &row.repeat(20)).unwrap();
    };
    start("a.csv", "1,0,0\n");
    start("b.csv", "0.6,0,0.8\n");
    let sweep = "sweep small.toml --over particles.rods={file=\"a.csv\"},{file=\"b.csv\"} --out here --quiet";
    succeeds(dir.path(), sweep);
    succeeds(dir.path(), sweep);
    let kept = files(&dir.path().join("here"));
    start("b.csv", "0.6,0.8,0\n");
    let message = refused(dir.path(), sweep);
    assert!(message.contains("starts_crc32.b.csv was"), "{message}");
    assert_eq!(files(&dir.path().join("here")), kept);
}

#[test]
fn bad_input_is_refused_before_anything_runs() {
    let dir = folder();
    for (over, named) in [
        (
            "time={periods=1,steps_per_period=200},{periods=1,steps_per_period=100} --over time.periods=1,2",
            "both set time.periods",
        ),
        (
            "particles.count=10:20:4",
            "small.toml: --over particles.count=13.333333333333334 (point 2 of 4): particles.count = \
             13.333333333333334 is not allowed: expected a whole number from 1 to 100000000",
        ),
        (
            "interaction.alpha=0.5:-0.5:3",
            "(point 3 of 3): interaction.alpha = -0.5 is not allowed: expected a finite number ≥ 0",
        ),
        (
            "interaction.update=rotation,angels",
            "(point 2 of 2): interaction.update = \"angels\" is not allowed: expected \"rotation\", \"angles\" or \
             \"kick\"",
        ),
        ("interaction.alpa=1,2", "unknown key `alpa`, expected one of"),
        ("alpha=1,2", "unknown key `alpha`, expected one of"),
        ("title.x=1,2", "title is not a table"),
        ("interaction.alpha=1:2", "neither FROM:TO:COUNT nor a list"),
        ("interaction.alpha=1:2:0", "a whole number from 2 to 100000 is allowed"),
        ("interaction.alpha", "KEY=FROM:TO:COUNT or KEY=A,B,C is allowed"),
        ("interaction.alpha=1,1.0", "1.0 stands there twice; each value once is allowed"),
        ("interaction.alpha=1e0,2,1", "1 stands there twice; each value once is allowed"),
        ("particles.aspect_ratio_sd_percent=0,-0.0", "-0.0 stands there twice; each value once is allowed"),
        ("interaction.box_mm=[1,2,3],[1,2,3.0]", "[1, 2, 3.0] stands there twice"),
        ("interaction.alpha=1:1.0000000000000002:3", "has no 3 different values"),
        ("output.observables=[\"projections\"],[\"mean_angle\"]", "all points have the same columns"),
        ("interaction.alpha=1,2 --over interaction.alpha=3", "both set it; one of the two is allowed"),
        ("ensemble.seed=1,2 --seed 3", "--seed and --over ensemble.seed: both set ensemble.seed"),
        ("ensemble.replicas=1,2 --replicas 3", "--replicas and --over ensemble.replicas: both set ensemble.replicas"),
        ("interaction.alpha=0:1:1000 --over interaction.m=1:2:1000", "more than 100000 points"),
    ] {
        let message = refused(dir.path(), &format!("sweep small.toml --over {over}"));
        assert!(message.contains(named), "{over}: {message}");
    }
    assert!(refused(dir.path(), "sweep small.toml").contains("--over <KEY=VALUES>"));
    // A scene file that is wrong has a line.
    fs::write(dir.path().join("small.toml"), SMALL.replace("count = 20", "count = 0")).unwrap();
    let message = refused(dir.path(), "sweep small.toml --over interaction.alpha=1,2");
    assert!(message.contains("small.toml:5: particles.count = 0 is not allowed"), "{message}");
    assert!(!dir.path().join("out").exists());
}

#[test]
fn a_warning_of_several_points_is_said_once() {
    let dir = folder();
    let over = "--over interaction.alpha=0.1,0.2,0.3 --over particles.count=1,2";
    let ended = shearbed(dir.path(), &format!("sweep small.toml {over} --quiet"));
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    let of_one_rod = "interaction.alpha=0.1 particles.count=1 and 2 other points: interaction has no effect";
    assert!(ended.stderr.contains(of_one_rod), "{}", ended.stderr);
    assert_eq!(ended.stderr.matches("has no effect").count(), 1, "{}", ended.stderr);
}
