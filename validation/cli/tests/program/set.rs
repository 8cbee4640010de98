//! Keys of a scene on the command line.

use crate::common::{UNEQUAL, names, read, shearbed, unequal};

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
    let text = text.split("[output]").next().unwrap().to_owned() + "[output]\nobservables = [\"mean_angle\"]\n";
    dir.write("other.toml", text);
    dir.runs("run other.toml --quiet --out b");
    assert_eq!(names(&dir.at("a")), ["mean_angle.csv", "mean_angle.svg", "run.json", "shearbed.json"]);
    assert_eq!(dir.read("a/mean_angle.csv"), dir.read("b/mean_angle.csv"));
}

#[test]
fn a_sweep_and_a_study_set_keys_as_a_run_does() {
    let dir = unequal();
    dir.write("other.toml", UNEQUAL.replace("count = 20", "count = 7"));
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
    dir.refuses(&format!("sweep small.toml {over} --out a"), "particles.count");

    // Spheres and two periods need few steps.
    succeeds("converge fig6-uniform --set particles.aspect_ratio=1 --set time.periods=2 --quiet --out e");
    let own = shearbed_validation::input::scenes::find("fig6-uniform").unwrap().text;
    let spheres = own.replace("aspect_ratio = 11.6", "aspect_ratio = 1").replace("periods = 6", "periods = 2");
    assert_ne!(spheres, own);
    dir.write("spheres.toml", spheres);
    succeeds("converge spheres.toml --quiet --out f");
    let studied = |out: &str| read(&dir.path().join(out).join("converge.csv"));
    assert_eq!(studied("e"), studied("f"));
}
