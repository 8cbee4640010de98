//! Keys of a scene on the command line.

use crate::common::{UNEQUAL, names, read, shearbed, unequal};
use std::fs;

#[test]
fn keys_are_set_on_the_command_line_as_a_file_would() {
    let dir = unequal();
    let set = "--set interaction.alpha=0.25 --set particles.count=7 --set output.observables=[\"mean_angle\"] \
               --set ensemble.seed=9 --set interaction.update=angles";
    let ended = shearbed(dir.path(), &format!("run small.toml {set} --quiet --out a"));
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    let text = UNEQUAL
        .replace("alpha = 0.5", "alpha = 0.25\nupdate = \"angles\"")
        .replace("count = 20", "count = 7")
        .replace("replicas = 3", "replicas = 3\nseed = 9");
    let text =
        text.split("[output]").next().unwrap().to_owned() + "[output]\nobservables = [\"mean_angle\"]\n";
    fs::write(dir.path().join("other.toml"), text).unwrap();
    assert_eq!(shearbed(dir.path(), "run other.toml --quiet --out b").code, Some(0));
    assert_eq!(
        names(&dir.path().join("a")),
        ["mean_angle.csv", "mean_angle.svg", "run.json", "shearbed.json"]
    );
    assert_eq!(read(&dir.path().join("a/mean_angle.csv")), read(&dir.path().join("b/mean_angle.csv")));
    assert!(shearbed(dir.path(), "plan small.toml --set particles.count=7").stdout.contains("\n7 rods, "));

    for (set, message) in [
        ("--set alpha=1", "small.toml --set alpha=1: alpha = 1: unknown key `alpha`, expected one of"),
        ("--set alpha=1", "; did you mean interaction.alpha?"),
        ("--set particles.count=0", "particles.count = 0 is not allowed: a whole number from 1 to"),
        ("--set particles.count=20.0", "particles.count = 20.0 is not allowed: a whole number from 1 to"),
        (
            "--set ensemble.seed=9223372036854775808",
            "ensemble.seed = 9.223372036854776e18 is not allowed: a whole number from 0 to 9223372036854775807",
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
    let own = validation::input::scenes::find("fig6-uniform").unwrap().text;
    let spheres =
        own.replace("aspect_ratio = 11.6", "aspect_ratio = 1").replace("periods = 6", "periods = 2");
    assert_ne!(spheres, own);
    fs::write(dir.path().join("spheres.toml"), spheres).unwrap();
    succeeds("converge spheres.toml --quiet --out f");
    let studied = |out: &str| read(&dir.path().join(out).join("converge.csv"));
    assert_eq!(studied("e"), studied("f"));
    assert!(!dir.path().join("d").exists());
}
