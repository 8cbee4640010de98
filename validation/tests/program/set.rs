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
    assert_eq!(
        shearbed(dir.path(), "run other.toml --quiet --out b").code,
        Some(0)
    );
    assert_eq!(
        names(&dir.path().join("a")),
        ["mean_angle.csv", "mean_angle.svg", "run.json"]
    );
    assert_eq!(
        read(&dir.path().join("a/mean_angle.csv")),
        read(&dir.path().join("b/mean_angle.csv"))
    );
    assert!(
        shearbed(dir.path(), "plan small.toml --set particles.count=7")
            .stdout
            .contains("\n7 rods, ")
    );

    for (set, message) in [
        (
            "--set alpha=1",
            "small.toml --set alpha=1: alpha = 1: unknown key `alpha`, expected one of",
        ),
        ("--set alpha=1", "; did you mean interaction.alpha?"),
        (
            "--set particles.count=0",
            "particles.count = 0 is not allowed: a whole number from 1 to",
        ),
        ("--set particles.count=1,2", "\"1,2\" is no value"),
        ("--set particles.count=1:3:3", "\"1:3:3\" is no value"),
        ("--set particles.count", "KEY=VALUE is allowed"),
        (
            "--set particles.count=1 --set particles.count=2",
            "--set particles.count: given twice",
        ),
        (
            "--set ensemble.seed=1 --seed 2",
            "--seed 2: --set ensemble.seed says it too",
        ),
        (
            "--set ensemble.replicas=1 --replicas 2",
            "--replicas 2: --set ensemble.replicas says it too",
        ),
        ("--set title.x=1", "is no table"),
    ] {
        let ended = shearbed(dir.path(), &format!("run small.toml {set} --out c"));
        assert_eq!(ended.code, Some(2), "{set}: {}", ended.stderr);
        assert!(ended.stderr.contains(message), "{set}: {}", ended.stderr);
    }
    assert!(!dir.path().join("c").exists());
}
