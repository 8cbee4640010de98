//! `shearbed sweep` as a user meets it: rows, going on after a kill, refusals.

use crate::common::{SMALL, folder, shearbed};
use std::fs;

const GRID: &str = "--over interaction.alpha=0.1:0.3:3 --over interaction.update=rotation,angles";

#[test]
fn a_row_is_the_last_output_of_a_run_with_these_keys() {
    let dir = folder();
    let text = dir.runs(&format!("sweep small.toml {GRID} --seed 7 --threads 2")).stdout;
    assert!(text.contains("points: 6, of which 0 were finished before"), "{text}");
    let out = dir.at("out/sweep-small");
    let csv = fs::read_to_string(out.join("sweep.csv")).unwrap();
    let rows: Vec<_> = csv.lines().collect();
    let columns = "interaction.alpha,interaction.update,t_over_T,time_s,strain,x1,x1_se,x2,x2_se,x3,x3_se,phi,phi_se";
    assert_eq!(rows[0], columns);
    let points = ["0.1,rotation", "0.1,angles", "0.2,rotation", "0.2,angles", "0.3,rotation", "0.3,angles"];
    assert_eq!(rows.len(), 1 + points.len());
    for (k, (row, point)) in rows[1..].iter().zip(points).enumerate() {
        // The same point by hand, as a scene of its own.
        let (alpha, update) = point.split_once(',').unwrap();
        let scene = SMALL.replace("alpha = 0.5", &format!("alpha = {alpha}\nupdate = \"{update}\""));
        dir.write("point.toml", scene);
        dir.runs("run point.toml --seed 7 --quiet --force");
        let table = |name: &str| fs::read_to_string(dir.at("out/point").join(name)).unwrap();
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

#[test]
fn another_sweep_in_the_folder_is_refused_and_left_as_it_is() {
    let dir = folder();
    let first = format!("sweep small.toml --out here {GRID} --quiet");
    dir.runs(&first);
    let first_files = dir.files("here");
    let other_input = "here/shearbed.json: results of `shearbed sweep` from other input are kept here: ";
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    // A version whose number has changed, and one whose results have without it.
    let record = dir.read("here/shearbed.json");
    assert!(record.contains(&version));
    dir.write("here/shearbed.json", record.replace(&version, "\"version\": \"0.0.1\""));
    dir.refuses(&first, "version was \"0.0.1\" and is");
    dir.write("here/shearbed.json", record);
    dir.write("small.toml", SMALL.replace("count = 20", "count = 21"));
    dir.refuses(&first, &format!("{other_input}scene.particles.count was 20 and is 21 now"));
    dir.write("small.toml", SMALL);
    fs::remove_dir_all(dir.at("here/points/6")).unwrap();
    let (point, point_record) = ("here/points/1/projections.csv", "here/points/1/shearbed.json");
    let table = dir.read(point);
    let other = table.replacen("0.", "0.9", 1);
    dir.write(point, &other);
    // As that build would have kept it.
    let [sum, other_sum] = [&table, &other].map(|text| {
        let bytes = text.len();
        format!("\"bytes\": {bytes},\n      \"crc32\": \"{:08x}\"", crc32fast::hash(text.as_bytes()))
    });
    let text = dir.read(point_record);
    assert!(text.contains(&sum), "{text}");
    dir.write(point_record, text.replace(&sum, &other_sum));
    dir.refuses(&first, "here/points/1: run again, this point gives other numbers");

    // Files of unknown origin.
    for name in ["shearbed.json", "sweep.json", "sweep.csv"] {
        fs::remove_file(dir.at("here").join(name)).unwrap();
        dir.refuses(&first, "is here already, and no shearbed.json says that this command wrote it");
    }
    // By force all is new, and nothing of before is left.
    dir.runs(&format!("{first} --force"));
    assert_eq!(dir.files("here"), first_files);
    dir.write(point, &other);
    dir.refuses(&first, "not as it was written");
    dir.runs(&format!("{first} --force"));
    assert_eq!(dir.files("here"), first_files);

    // A file that is gone is written again; what is of another sweep goes by force, what somebody put beside it does
    // not.
    fs::remove_file(dir.at("here/sweep.json")).unwrap();
    dir.runs(&first);
    assert_eq!(dir.files("here"), first_files);
    let other = first.replace("small.toml", "other.toml") + " --force";
    dir.write("other.toml", SMALL.replace("count = 20", "count = 21"));
    dir.write("here/points/1/notes.txt", "notes");
    dir.refuses(&other, "points/1/notes.txt: was not written by `shearbed sweep`");
    fs::remove_file(dir.at("here/points/1/notes.txt")).unwrap();
    fs::create_dir(dir.at("here/points/2/mine")).unwrap();
    dir.refuses(&other, "points/2/mine: was not written by `shearbed sweep`");
    fs::remove_dir(dir.at("here/points/2/mine")).unwrap();
    dir.runs(&other);
    assert_ne!(dir.files("here"), first_files);
}

#[test]
fn a_start_that_has_changed_is_another_sweep() {
    let dir = folder();
    dir.write("small.toml", SMALL.replace("orientation = \"isotropic\"", "rods = { file = \"a.csv\" }"));
    let start = |name: &str, row: &str| dir.write(name, "p1,p2,p3\n".to_owned() + &row.repeat(20));
    start("a.csv", "1,0,0\n");
    start("b.csv", "0.6,0,0.8\n");
    let sweep = "sweep small.toml --over particles.rods={file=\"a.csv\"},{file=\"b.csv\"} --out here --quiet";
    dir.runs(sweep);
    dir.runs(sweep);
    start("b.csv", "0.6,0.8,0\n");
    dir.refuses(sweep, "starts_crc32.b.csv was");
}
