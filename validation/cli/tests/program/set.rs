//! Keys of a scene on the command line.

use crate::common::bounded::Bounded;
use crate::common::{UNEQUAL, command, names, read, shearbed, unequal};
use std::fs;

#[test]
fn keys_are_set_on_the_command_line_as_a_file_would() {
    let dir = unequal();
    let set = "--set interaction.alpha=0.25 --set particles.count=7 --set output.observables=[\"mean_angle\"] --set \
        ensemble.seed=9 --set interaction.update=angles";
    let ended = shearbed(dir.path(), &format!("run small.toml {set} --quiet --out a"));
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    let text = UNEQUAL
        .replace("alpha = 0.5", "alpha = 0.25\nupdate = \"angles\"")
        .replace("count = 20", "count = 7")
        .replace("replicas = 3", "replicas = 3\nseed = 9");
    let text = text.split("[output]").next().unwrap().to_owned() + "[output]\nobservables = [\"mean_angle\"]\n";
    fs::write(dir.path().join("other.toml"), text).unwrap();
    assert_eq!(shearbed(dir.path(), "run other.toml --quiet --out b").code, Some(0));
    assert_eq!(names(&dir.path().join("a")), ["mean_angle.csv", "mean_angle.svg", "run.json", "shearbed.json"]);
    assert_eq!(read(&dir.path().join("a/mean_angle.csv")), read(&dir.path().join("b/mean_angle.csv")));
    assert!(shearbed(dir.path(), "plan small.toml --set particles.count=7").stdout.contains("\n7 rods, "));

    for (set, message) in [
        ("--set alpha=1", "small.toml --set alpha=1: alpha = 1: unknown key `alpha`, expected one of"),
        ("--set alpha=1", "; did you mean interaction.alpha?"),
        ("--set particles.count=0", "particles.count = 0 is not allowed: expected a whole number from 1 to"),
        ("--set particles.count=20.0", "particles.count = 20.0 is not allowed: expected a whole number from 1 to"),
        (
            "--set ensemble.seed=9223372036854775808",
            "ensemble.seed = 9.223372036854776e18 is not allowed: expected a whole number from 0 to \
             9223372036854775807",
        ),
        ("--set particles.count=1,2", "\"1,2\" is no value"),
        ("--set particles.count=1:3:3", "\"1:3:3\" is no value"),
        ("--set particles.count", "KEY=VALUE is allowed"),
        (
            "--set particles.count=1 --set particles.count=2",
            "--set particles.count and --set particles.count: both set it; one of the two is allowed",
        ),
        (
            "--set ensemble.seed=1 --seed 2",
            "--seed and --set ensemble.seed: both set ensemble.seed; one of the two is allowed",
        ),
        (
            "--set ensemble.replicas=1 --replicas 2",
            "--replicas and --set ensemble.replicas: both set ensemble.replicas",
        ),
        (
            "--replicas 2 --set ensemble={replicas=5}",
            "--replicas and --set ensemble: both set ensemble.replicas; one of the two is allowed",
        ),
        (
            "--set particles.count=1 --set particles={count=7,length_mm=1,aspect_ratio=5,orientation=\"isotropic\"}",
            "--set particles and --set particles.count: both set particles.count",
        ),
        ("--set title.x=1", "title is not a table"),
    ] {
        let ended = shearbed(dir.path(), &format!("run small.toml {set} --out c"));
        assert_eq!(ended.code, Some(2), "{set}: {}", ended.stderr);
        assert!(ended.stderr.contains(message), "{set}: {}", ended.stderr);
    }
    assert!(!dir.path().join("c").exists());
}

#[test]
fn a_sweep_and_a_study_set_keys_as_a_run_does() {
    let dir = unequal();
    fs::write(dir.path().join("other.toml"), UNEQUAL.replace("count = 20", "count = 7")).unwrap();
    let succeeds = |arguments: &str| {
        let ended = shearbed(dir.path(), arguments);
        assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""), "{arguments}");
    };
    let over = "--over interaction.alpha=0.25,0.5 --quiet";
    succeeds(&format!("sweep small.toml {over} --set particles.count=7 --out a"));
    succeeds(&format!("sweep other.toml {over} --out b"));
    succeeds(&format!("sweep small.toml {over} --out c"));
    let rows = |out: &str| read(&dir.path().join(out).join("sweep.csv"));
    assert_eq!(rows("a"), rows("b"));
    assert_ne!(rows("a"), rows("c"));
    // The folder of one is not gone on with by the other.
    let ended = shearbed(dir.path(), &format!("sweep small.toml {over} --out a"));
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("particles.count"), "{}", ended.stderr);
    let ended = shearbed(dir.path(), &format!("sweep small.toml {over} --set interaction.alpha=1 --out d"));
    assert_eq!(ended.code, Some(2));
    let said = "--set interaction.alpha and --over interaction.alpha: both set it";
    assert!(ended.stderr.contains(said), "{}", ended.stderr);

    // Spheres and two periods need few steps.
    succeeds("converge fig6-uniform --set particles.aspect_ratio=1 --set time.periods=2 --quiet --out e");
    let own = shearbed_validation::input::scenes::find("fig6-uniform").unwrap().text;
    let spheres = own.replace("aspect_ratio = 11.6", "aspect_ratio = 1").replace("periods = 6", "periods = 2");
    assert_ne!(spheres, own);
    fs::write(dir.path().join("spheres.toml"), spheres).unwrap();
    succeeds("converge spheres.toml --quiet --out f");
    let studied = |out: &str| read(&dir.path().join(out).join("converge.csv"));
    assert_eq!(studied("e"), studied("f"));
    assert!(!dir.path().join("d").exists());
}

/// What a line of a scene file may have behind a value is no part of a value.
#[test]
fn nothing_behind_a_value_is_left_out() {
    let dir = unequal();
    for set in ["particles.count=7 # or 8", "particles.count=7#", "title='a' # b", "title=\"a\"\nx = 1"] {
        let ended = command(dir.path(), "plan small.toml --set").arg(set).ended();
        let said = String::from_utf8(ended.stderr).unwrap();
        assert!(ended.status.code() == Some(2) && said.contains("is no value"), "{set}: {said}");
    }
    let ended = command(dir.path(), "plan small.toml --set").arg("title='a # b'").ended();
    assert!(String::from_utf8(ended.stdout).unwrap().contains("a # b"));
}

/// A number of more digits than TOML's integers have is a number, in a file and on the command line.
#[test]
fn a_long_integer_is_the_number_that_it_is() {
    let dir = unequal();
    let scene = |count: &str, length: &str| {
        let text = UNEQUAL.replace("count = 20", &format!("count = {count}"));
        let text = text.replace("length_mm = 0.72", &format!("length_mm = {length}"));
        fs::write(dir.path().join("long.toml"), text).unwrap();
        shearbed(dir.path(), "plan long.toml")
    };
    for digits in ["9223372036854775808", "0x8000000000000000", "9_223_372_036_854_775_808"] {
        let ended = scene("20", digits);
        assert_eq!(ended.code, Some(0), "{digits}: {}", ended.stderr);
        let same = shearbed(dir.path(), &format!("plan small.toml --set particles.length_mm={digits}"));
        assert_eq!(same.code, Some(0), "{digits}: {}", same.stderr);
        assert_eq!(ended.stdout.split_once('\n').unwrap().1, same.stdout.split_once('\n').unwrap().1);
        let ended = scene(digits, "1");
        let said = format!(
            "long.toml:5: particles.count = {digits} is not allowed: expected a whole number from 1 to 100000000"
        );
        assert!(ended.code == Some(2) && ended.stderr.contains(&said), "{}", ended.stderr);
    }
    let ended = scene("20", &"9".repeat(400));
    assert!(ended.stderr.contains("is not allowed: expected a finite number > 0"), "{}", ended.stderr);
}

/// A file's name makes the folder's, and dots alone make none.
#[test]
fn a_scene_of_dots_has_a_folder_below_out() {
    let dir = unequal();
    for (name, out) in [("..toml", "out/scene"), ("...toml", "out/scene"), (".a.toml", "out/a"), ("a..toml", "out/a.")]
    {
        fs::copy(dir.path().join("small.toml"), dir.path().join(name)).unwrap();
        let ended = shearbed(dir.path(), &format!("run {name} --force"));
        assert_eq!(ended.code, Some(0), "{name}: {}", ended.stderr);
        assert!(ended.stdout.contains(&format!("\nin {out}: ")), "{name}: {}", ended.stdout);
    }
}
