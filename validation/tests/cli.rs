//! The program as a user meets it: exit codes, messages and files.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::TempDir;

const SMALL: &str = r#"title = "A small scene"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 20
length_mm = 0.72
aspect_ratio = 11.6
aspect_ratio_sd_percent = 3.6
orientation = "isotropic"
[interaction]
concentration_per_cm3 = 50
alpha = 0.5
[time]
periods = 1
steps_per_period = 200
outputs_per_period = 4
[ensemble]
replicas = 3
[output]
observables = ["projections", "planar_projections", "mean_angle", "orbit_constant", "orientation_tensor"]
"#;

struct Ended {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

/// Runs `shearbed` in `dir` with arguments separated by blanks.
fn shearbed(dir: &Path, arguments: &str) -> Ended {
    let output = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .args(arguments.split_whitespace())
        .current_dir(dir)
        .output()
        .unwrap();
    Ended {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// A folder with `small.toml` in it.
fn folder() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("small.toml"), SMALL).unwrap();
    dir
}

fn names(dir: &Path) -> Vec<String> {
    let entries = fs::read_dir(dir).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

/// The text without the numbers and bars of its tables, which are not the same on every machine.
fn without_means(text: &str) -> String {
    let bars = |line: &str| line.trim_start().starts_with(|c| ('▁'..='█').contains(&c));
    let lines = text.lines().map(|line| match line {
        line if bars(line) => "       bars",
        line if line.contains(" ± ") && !line.starts_with("Means") => {
            line.get(..7).unwrap_or(line).trim_end()
        }
        line => line.trim_end(),
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn a_run_writes_a_table_and_a_picture_of_each_observable_and_a_record() {
    let dir = folder();
    let ended = shearbed(dir.path(), "run small.toml");
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    insta::assert_snapshot!(without_means(&ended.stdout));
    let out = dir.path().join("out/small");
    let columns: Vec<_> = names(&out)
        .into_iter()
        .map(|name| match name.ends_with(".csv") {
            true => format!("{name}: {}\n", read(&out.join(&name)).lines().next().unwrap()),
            false => name + "\n",
        })
        .collect();
    insta::assert_snapshot!(columns.concat());
    let record: Value = serde_json::from_str(&read(&out.join("run.json"))).unwrap();
    let files: Vec<_> = record["files"]
        .as_array()
        .unwrap()
        .iter()
        .map(|name| name.as_str().unwrap())
        .collect();
    assert!(files.iter().all(|name| out.join(name).is_file()));
    assert_eq!(files.len() + 1, names(&out).len());
}

#[test]
fn what_a_run_prints_is_in_its_tables() {
    let dir = folder();
    let printed = shearbed(dir.path(), "run small.toml").stdout;
    let table = read(&dir.path().join("out/small/projections.csv"));
    let x1: Vec<f64> = (table.lines().skip(1))
        .map(|line| line.split(',').nth(3).unwrap().parse().unwrap())
        .collect();
    let line = printed.lines().find(|line| line.starts_with("x1 ")).unwrap();
    let least = x1.iter().copied().fold(f64::INFINITY, f64::min);
    for number in [x1[0], x1[4], least] {
        assert!(line.contains(&format!("{number:.4}")), "{number} in {line}");
    }
    // Five outputs: the one with the least mean is a quarter of a period in.
    assert!(line.contains(&format!("{least:.4} at 0.25")), "{line}");
    let record: Value = serde_json::from_str(&read(&dir.path().join("out/small/run.json"))).unwrap();
    assert_eq!(record["facts"]["regime"], "dilute");
}

#[test]
fn one_picture_is_drawn_from_several_runs_and_from_a_sweep() {
    let dir = folder();
    for (seed, out) in [(1, "a"), (2, "b")] {
        let ended = shearbed(
            dir.path(),
            &format!("run small.toml --seed {seed} --out {out} --quiet"),
        );
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    }
    assert_eq!(
        shearbed(dir.path(), "plot a b --y x2 --out two.svg").code,
        Some(0)
    );
    let picture = read(&dir.path().join("two.svg"));
    for text in [">\na\n<", ">\nb\n<", "95 % band", "t/T"] {
        assert!(picture.contains(text), "{text}");
    }
    // The same picture in pixels: a PNG of the view box's size, that is read back.
    assert_eq!(
        shearbed(dir.path(), "plot a b --y x2 --out two.png").code,
        Some(0)
    );
    let file = std::fs::File::open(dir.path().join("two.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .unwrap();
    let (width, height) = reader.info().size();
    assert!(picture.contains(&format!("viewBox=\"0 0 {width} {height}\"")));
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let colours: std::collections::BTreeSet<_> = pixels.chunks(3).collect();
    assert!(colours.len() > 50, "{} colours", colours.len());
    // Letters that the fonts lack are named, and the picture is made all the same.
    let titled = "run small.toml --set title=\"стержни\" --quiet --out c";
    assert_eq!(shearbed(dir.path(), titled).code, Some(0));
    let ended = shearbed(dir.path(), "plot c --out c.png");
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert!(
        ended.stderr.contains("no letters for \"ежинрст\""),
        "{}",
        ended.stderr
    );
    let sweep = "sweep small.toml --over interaction.alpha=0.1,0.2 --quiet --out s";
    assert_eq!(shearbed(dir.path(), sweep).code, Some(0));
    assert_eq!(shearbed(dir.path(), "plot s --out s.svg").code, Some(0));
    assert!(read(&dir.path().join("s.svg")).contains("interaction.alpha=0.2"));
    for (arguments, words) in [
        (
            "plot a --y x9",
            "--y x9: a has no such channel; there are x1, x2, x3, x1x2,",
        ),
        (
            "plot nowhere",
            "nowhere: neither run.json nor sweep.json is in it",
        ),
        (
            "plot a --out picture.gif",
            "a name that ends in .svg or .png is allowed",
        ),
    ] {
        let ended = shearbed(dir.path(), arguments);
        assert_eq!(ended.code, Some(2), "{arguments}");
        assert!(ended.stderr.contains(words), "{arguments}: {}", ended.stderr);
    }
    assert!(!dir.path().join("out/plot.svg").exists());
}

#[test]
fn two_reports_are_compared() {
    let dir = folder();
    let case = "validate --case jeffery-period --quiet --out";
    assert_eq!(shearbed(dir.path(), &format!("{case} a")).code, Some(0));
    let text = read(&dir.path().join("a/report.json"));
    let same = shearbed(dir.path(), "compare a/report.json a/report.json");
    assert_eq!(same.code, Some(0), "{}", same.stderr);
    assert!(
        same.stdout.contains("Verdicts: none of 1 changed."),
        "{}",
        same.stdout
    );
    assert!(
        same.stdout.contains("No error moved beyond its noise."),
        "{}",
        same.stdout
    );
    // A spoilt report: another verdict, and an error that is no longer what it was.
    let mut spoilt: Value = serde_json::from_str(&text).unwrap();
    spoilt["cases"][0]["verdict"] = "fail".into();
    spoilt["cases"][0]["evidence"][0]["error"] = 1.0.into();
    fs::write(dir.path().join("b.json"), spoilt.to_string()).unwrap();
    let other = shearbed(dir.path(), "compare a/report.json b.json").stdout;
    assert!(other.contains("jeffery-period: pass → fail"), "{other}");
    assert!(other.contains("Errors that moved"), "{other}");
    let bad = shearbed(dir.path(), "compare a/report.json small.toml");
    assert_eq!(bad.code, Some(2));
    assert!(
        bad.stderr.contains("small.toml: is no report.json"),
        "{}",
        bad.stderr
    );
    assert!(read(&dir.path().join("a/junit.xml")).contains("name=\"jeffery-period\""));
}

#[test]
fn a_build_says_how_it_is_cited() {
    let text = shearbed(folder().path(), "cite").stdout;
    let version = format!("version = {{{}}}", env!("CARGO_PKG_VERSION"));
    for words in [
        "@software{shearbed,",
        &version,
        "note    = {commit ",
        "@article{lee-springer-1982,",
    ] {
        assert!(text.contains(words), "{text}");
    }
    assert_eq!(text.matches('{').count(), text.matches('}').count());
}

#[test]
fn the_scene_in_run_json_gives_the_same_bits() {
    let dir = folder();
    assert_eq!(
        shearbed(
            dir.path(),
            "run small.toml --replicas 4 --seed 7 --threads 2 --out a"
        )
        .code,
        Some(0)
    );
    let record: Value = serde_json::from_str(&read(&dir.path().join("a/run.json"))).unwrap();
    assert_eq!((&record["seed"], &record["threads"]), (&7.into(), &2.into()));
    let scene: shearbed::Scene = serde_json::from_value(record["scene"].clone()).unwrap();
    let plan = shearbed::Plan::new(&scene).unwrap();
    assert_eq!(record["plan_text"], plan.to_string());
    let results = shearbed::ensemble::run(&plan, || ()).unwrap();
    assert_eq!(record["counters"]["collisions"], results.counters.collisions);
    // Every number of the tables reads back as the same bits.
    for series in &results.series {
        let file = dir.path().join(format!("a/{}.csv", series.observable.name()));
        let mut reader = csv::Reader::from_path(file).unwrap();
        for (k, row) in reader.deserialize::<Vec<f64>>().enumerate() {
            let channels = series
                .columns
                .iter()
                .flat_map(|channel| [channel.mean[k], channel.se[k]]);
            let time = results.times[k];
            // T = 2π(r_e + 1/r_e)/G.
            let period_s = 2.0 * std::f64::consts::TAU * (11.6 + 1.0 / 11.6);
            let times = [time, time * period_s, time * period_s * 0.5];
            let expected: Vec<_> = times.into_iter().chain(channels).collect();
            assert_eq!(row.unwrap(), expected, "{} {k}", series.observable.name());
        }
    }
}

/// What is put in place of what in [`SMALL`], one extreme a scene.
#[rustfmt::skip]
const EXTREMES: &[&[(&str, &str)]] = &[
    &[("= 0.5\n[particles]", "= 1e-30\n[particles]")],
    &[("= 0.5\n[particles]", "= 1e30\n[particles]")],
    &[("= 11.6", "= 1e8"), ("= 3.6", "= 33.3")],
    &[("= 11.6", "= 1.000000000001"), ("= 3.6", "= 0")],
    &[("= 11.6", "= 1.2"), ("= 3.6", "= 5.555")],
    &[("count = 20", "count = 1")],
    &[("count = 20", "count = 2"), ("alpha = 0.5", "alpha = 1e300")],
    &[("= 50", "= 1e30"), ("alpha = 0.5", "alpha = 1e3")],
    &[("= 50", "= 1e-30"), ("alpha = 0.5", "alpha = 1e3")],
    &[("alpha = 0.5", "alpha = 0")],
    &[("alpha = 0.5", "alpha = 1e300\nupdate = \"angles\"")],
    &[("alpha = 0.5", "alpha = 0.5\nm = 0.1")],
    &[("alpha = 0.5", "alpha = 1e3\nm = 50")],
    &[("alpha = 0.5", "alpha = 1e3\nmin_contact_arm = 2.2250738585072014e-308")],
    &[("\"isotropic\"", "{ phi_deg = 0, theta_deg = 180 }"), ("alpha = 0.5", "alpha = 1e3")],
    &[("\"isotropic\"", "{ phi_deg = 0, theta_deg = 1e-300 }"), ("alpha = 0.5", "alpha = 1e3\nupdate = \"angles\"")],
    &[("steps_per_period = 200", "steps_per_period = 1"), ("outputs_per_period = 4", "outputs_per_period = 1")],
    &[("periods = 1", "periods = 1e-5"), ("steps_per_period = 200", "steps_per_period = 10000000"),
      ("outputs_per_period = 4", "outputs_per_period = 100000")],
    &[("shear_rate_per_s = 0.5", "gradient_per_s = [[1e30, 0, 0], [0, -1e30, 0], [0, 0, 0]]"), ("= 11.6", "= 1e8"),
      ("[interaction]\nconcentration_per_cm3 = 50\nalpha = 0.5\n", ""),
      ("periods = 1\nsteps_per_period = 200\noutputs_per_period = 4", "strain = 1e4\noutputs_per_strain = 1")],
];

#[test]
fn extreme_scenes_end_well_with_finite_tables() {
    let dir = folder();
    for (k, changes) in EXTREMES.iter().enumerate() {
        let text = (changes.iter()).fold(SMALL.to_owned(), |text, (old, new)| {
            assert!(text.contains(old), "{old}");
            text.replace(old, new)
        });
        fs::write(dir.path().join("extreme.toml"), text).unwrap();
        let ended = shearbed(
            dir.path(),
            &format!("run extreme.toml --threads 1 --quiet --out {k}"),
        );
        assert_eq!(ended.code, Some(0), "{changes:?}: {}", ended.stderr);
        let known = [
            "warning: extreme.toml: time.steps_per_period = ",
            "warning: extreme.toml: interaction.concentration_per_cm3 and particles.length_mm give n a³ = ",
        ];
        assert!(
            (ended.stderr.lines()).all(|line| known.iter().any(|start| line.starts_with(start))),
            "{changes:?}: {}",
            ended.stderr
        );
        for name in names(&dir.path().join(k.to_string())) {
            if name.ends_with(".csv") {
                let mut reader = csv::Reader::from_path(dir.path().join(format!("{k}/{name}"))).unwrap();
                let rows: Vec<Vec<f64>> = reader.deserialize().map(Result::unwrap).collect();
                assert!(
                    rows.iter().flatten().all(|value| value.is_finite()),
                    "{name}: {changes:?}"
                );
            }
        }
    }
}

#[test]
fn a_run_that_ends_badly_leaves_what_was_complete() {
    let dir = folder();
    assert_eq!(
        shearbed(dir.path(), "run small.toml --quiet --out a").code,
        Some(0)
    );
    let before: Vec<_> = names(&dir.path().join("a"))
        .iter()
        .map(|name| read(&dir.path().join("a").join(name)))
        .collect();
    fs::write(
        dir.path().join("small.toml"),
        SMALL.replace("aspect_ratio = 11.6", "aspect_ratio = 1e200"),
    )
    .unwrap();
    let ended = shearbed(dir.path(), "run small.toml --quiet --out a");
    assert_eq!(ended.code, Some(2));
    assert!(
        ended
            .stderr
            .contains("particles.aspect_ratio = 1e200 is not allowed"),
        "{}",
        ended.stderr
    );
    let after: Vec<_> = names(&dir.path().join("a"))
        .iter()
        .map(|name| read(&dir.path().join("a").join(name)))
        .collect();
    assert_eq!(before, after);
}

#[test]
fn quiet_prints_nothing() {
    let dir = folder();
    let ended = shearbed(dir.path(), "run extension --quiet");
    assert_eq!(
        (ended.code, ended.stdout + &ended.stderr),
        (Some(0), String::new())
    );
    let table = read(&dir.path().join("out/extension/projections.csv"));
    assert!(
        table.starts_with("strain,time_s,x1,x1_se,x2,x2_se,x3,x3_se\n0.0,0.0,"),
        "{table}"
    );
}

#[test]
fn a_name_with_a_dot_keeps_it_in_the_folder() {
    let dir = folder();
    assert_eq!(
        shearbed(dir.path(), "run fig8-a0.36 --replicas 1 --quiet").code,
        Some(0)
    );
    assert_eq!(names(&dir.path().join("out")), ["fig8-a0.36"]);
}

#[test]
fn a_file_wins_over_a_built_in_scene_and_a_folder_does_not() {
    let dir = folder();
    fs::create_dir(dir.path().join("fig5")).unwrap();
    assert!(shearbed(dir.path(), "plan fig5").stdout.starts_with("Fig. 5"));
    fs::rename(dir.path().join("small.toml"), dir.path().join("fig12")).unwrap();
    assert!(
        shearbed(dir.path(), "plan fig12")
            .stdout
            .starts_with("A small scene")
    );
}

#[test]
fn plans_of_built_in_scenes() {
    let dir = folder();
    let plan = |name: &str| shearbed(dir.path(), &format!("plan {name}")).stdout;
    insta::assert_snapshot!(plan("fig9-sd3.6"));
    insta::assert_snapshot!(plan("fig4-n50"));
    insta::assert_snapshot!(plan("extension"));
}

#[test]
fn the_built_in_scenes_are_listed_and_shown() {
    let dir = folder();
    insta::assert_snapshot!(shearbed(dir.path(), "scenes").stdout);
    let shown = shearbed(dir.path(), "scenes --show fig5").stdout;
    fs::write(dir.path().join("mine.toml"), shown).unwrap();
    let plan = |scene| shearbed(dir.path(), &format!("plan {scene}")).stdout;
    assert_eq!(plan("mine.toml"), plan("fig5"));
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .arg("scenes")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.len()), (Some(0), 0));
}

/// Arguments, and a part of the message.
#[rustfmt::skip]
const REJECTED: &[(&str, &str)] = &[
    ("", "Usage: shearbed <COMMAND>"),
    ("rnu small.toml", "unrecognized subcommand 'rnu'"),
    ("run", "<SCENE>"),
    ("run no.toml", "no.toml: cannot be read: No such file or directory"),
    ("run fig4n50", "close names: fig4-n50"),
    ("plan .", ".: cannot be read: Is a directory"),
    ("plan latin.toml", "latin.toml:2: not a text in UTF-8"),
    ("plan file", "file:1: title is missing: a text in quotes"),
    ("run zero.toml", "zero.toml:5: particles.count = 0 is not allowed: a whole number from 1 to 100000000"),
    ("run wide.toml", "wide.toml:8: particles.aspect_ratio_sd_percent = 40 is not allowed: so wide that r_e ≤ 1"),
    ("run sphere.toml", "sphere.toml:7: particles.aspect_ratio = 1 is not allowed: interacting rods need"),
    ("run small.toml --replicas 0", "'0' for '--replicas <N>': a whole number from 1 to 10000000 is allowed"),
    ("run small.toml --replicas 1.5", "'1.5' for '--replicas <N>': a whole number from 1 to"),
    ("run small.toml --replicas 10000001", "'10000001' for '--replicas <N>': a whole number from 1 to"),
    ("run small.toml --seed -1", "'-1' for '--seed <S>': a whole number from 0 to 9223372036854775807 is"),
    ("run small.toml --seed 9223372036854775808", "for '--seed <S>': a whole number from 0 to"),
    ("run small.toml --threads 0", "'0' for '--threads <K>': a whole number from 1 to 1024 is allowed"),
    ("run small.toml --threads many", "'many' for '--threads <K>': a whole number from 1 to 1024"),
    ("run small.toml --out file", "file: cannot be written: "),
    ("run small.toml --out file/below", "file/below: cannot be written: "),
    ("run small.toml --fast", "unexpected argument '--fast'"),
    ("scenes --show fig13", "--show fig13: no built-in scene has this name; there are fig4-n20, fig4-n50"),
    ("validate --case no-such-case", "--case no-such-case: no case has this name. `shearbed validate --list` has all"),
    ("validate --case jefery-period", "--case jefery-period: no case has this name; did you mean jeffery-period?"),
    ("validate --data no-such-folder", "'no-such-folder' for '--data <DIR>': No such file or directory"),
    ("validate --data file", "'file' for '--data <DIR>': it is no folder; an existing folder is allowed"),
    ("validate --out file", "file: cannot be written: "),
];

#[test]
fn bad_input_ends_with_2_and_a_message() {
    let dir = folder();
    let put = |name: &str, text: &[u8]| fs::write(dir.path().join(name), text).unwrap();
    put("file", b"");
    put("latin.toml", b"title = \"a\"\n# n = 50 cm\xb3\n");
    put("zero.toml", SMALL.replace("count = 20", "count = 0").as_bytes());
    put("wide.toml", SMALL.replace("= 3.6", "= 40").as_bytes());
    put(
        "sphere.toml",
        SMALL.replace("= 11.6", "= 1").replace("= 3.6", "= 0").as_bytes(),
    );
    let before = names(dir.path());
    for (arguments, message) in REJECTED {
        let ended = shearbed(dir.path(), arguments);
        assert_eq!(ended.code, Some(2), "{arguments}: {}", ended.stderr);
        assert!(ended.stderr.contains(message), "{arguments}: {}", ended.stderr);
        assert_eq!(ended.stdout, "", "{arguments}");
    }
    assert_eq!(names(dir.path()), before, "nothing was written");
    assert_eq!(read(&dir.path().join("file")), "");
}

#[test]
fn a_file_that_cannot_be_replaced_leaves_all_as_it_was() {
    let dir = folder();
    let out = dir.path().join("out");
    fs::create_dir_all(out.join("run.json")).unwrap();
    fs::write(out.join("projections.csv"), "old").unwrap();
    let ended = shearbed(dir.path(), "run small.toml --out out");
    assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""));
    assert_eq!(
        ended.stderr,
        "error: out/run.json: cannot be written: is a directory\n"
    );
    assert_eq!(names(&out), ["projections.csv", "run.json"]);
    assert_eq!(read(&out.join("projections.csv")), "old");
}

#[test]
fn chosen_cases_are_run_and_reported() {
    let dir = folder();
    let ended = shearbed(
        dir.path(),
        "validate --case jeffery-period --data . --threads 2 --out report",
    );
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    let lines: Vec<_> = ended.stdout.lines().collect();
    assert!(
        lines[0].starts_with("pass            jeffery-period "),
        "{lines:?}"
    );
    assert!(lines[2].starts_with("Passed: core 1 of 1. 0 fail, "), "{lines:?}");
    assert_eq!(
        lines[3],
        format!("report: {}", Path::new("report/report.html").display())
    );
    let report = dir.path().join("report");
    assert_eq!(
        names(&report),
        ["junit.xml", "report.html", "report.json", "report.md"]
    );
    let json: Value = serde_json::from_str(&read(&report.join("report.json"))).unwrap();
    assert_eq!(json["cases"].as_array().map(Vec::len), Some(1));

    let quiet = shearbed(dir.path(), "validate --case jeffery-period --quiet");
    assert_eq!(
        (quiet.code, quiet.stdout + &quiet.stderr),
        (Some(0), String::new())
    );
    assert!(dir.path().join("out/report/report.html").is_file());
}

/// A full device: every write to it fails as on a full disk.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_under_standard_output_ends_with_2() {
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .arg("scenes")
        .stdout(full)
        .output()
        .unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(
        stderr.starts_with("error: standard output: cannot be written: No space left"),
        "{stderr}"
    );
}

/// Linux says what memory there is.
#[cfg(target_os = "linux")]
#[test]
fn a_scene_that_does_not_fit_in_memory_is_refused_before_it_starts() {
    let dir = folder();
    let text = shearbed(dir.path(), "scenes --show fig4-n50").stdout;
    let huge = text.replace("count = 100\n", "count = 100_000_000\n");
    assert_ne!(huge, text);
    fs::write(dir.path().join("huge.toml"), huge).unwrap();
    // 11 GB for every thread.
    for command in [
        "run huge.toml --replicas 1000 --threads 200",
        "sweep huge.toml --over ensemble.replicas=1000,2000 --threads 200",
    ] {
        let ended = shearbed(dir.path(), command);
        assert_eq!(ended.code, Some(2), "{}", ended.stderr);
        for part in ["huge.toml", "particles.count = 100000000", "200 at a time", "GB"] {
            assert!(ended.stderr.contains(part), "{}", ended.stderr);
        }
    }
    assert_eq!(names(dir.path()), ["huge.toml", "small.toml"]);
}

#[test]
fn a_step_that_is_too_long_is_warned_of_wherever_it_is_used() {
    let dir = folder();
    let coarse = SMALL.replace("steps_per_period = 200", "steps_per_period = 100");
    fs::write(dir.path().join("coarse.toml"), coarse).unwrap();
    let warning = "time.steps_per_period = 100 does not resolve the motion: the strain per step is 0.734, above 0.370; \
                   200 steps a period resolve it (the default)";
    let ended = shearbed(dir.path(), "plan coarse.toml");
    assert_eq!(
        ended.stdout.lines().last(),
        Some(format!("warning: {warning}").as_str())
    );
    let ended = shearbed(dir.path(), "run coarse.toml --quiet --out a");
    assert_eq!((ended.code, ended.stdout.as_str()), (Some(0), ""));
    assert_eq!(ended.stderr, format!("warning: coarse.toml: {warning}\n"));
    let json = |path: &str| -> Value { serde_json::from_str(&read(&dir.path().join(path))).unwrap() };
    assert_eq!(json("a/run.json")["warnings"], serde_json::json!([warning]));

    let sweep = "sweep coarse.toml --over time.steps_per_period=100,200 --quiet --out b";
    let ended = shearbed(dir.path(), sweep);
    let at_point = format!("--over time.steps_per_period=100: {warning}");
    assert_eq!(ended.stderr, format!("warning: coarse.toml: {at_point}\n"));
    assert_eq!(json("b/sweep.json")["warnings"], serde_json::json!([at_point]));

    assert_eq!(shearbed(dir.path(), "run small.toml --quiet --out c").stderr, "");
    assert_eq!(json("c/run.json")["warnings"], serde_json::json!([]));
}

#[test]
fn keys_are_set_on_the_command_line_as_a_file_would() {
    let dir = folder();
    let set = "--set interaction.alpha=0.25 --set particles.count=7 --set output.observables=[\"mean_angle\"] \
               --set ensemble.seed=9 --set interaction.update=angles";
    let ended = shearbed(dir.path(), &format!("run small.toml {set} --quiet --out a"));
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    let text = SMALL
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

#[test]
fn another_run_is_overwritten_only_by_force() {
    let dir = folder();
    let run = |arguments: &str| shearbed(dir.path(), &format!("run small.toml --quiet --out a {arguments}"));
    assert_eq!(run("").code, Some(0));
    let kept = || -> Vec<_> {
        let dir = dir.path().join("a");
        names(&dir)
            .into_iter()
            .map(|name| (read(&dir.join(&name)), name))
            .collect()
    };
    let tables = || -> Vec<_> {
        kept()
            .into_iter()
            .filter(|(_, name)| name != "run.json")
            .collect()
    };
    let (before, before_tables) = (kept(), tables());
    for (arguments, what) in [
        ("--seed 2", "scene.ensemble.seed was 1 and is 2 now"),
        ("--replicas 4", "scene.ensemble.replicas was 3 and is 4 now"),
        (
            "--set interaction.alpha=0.4",
            "scene.interaction.alpha was 0.5 and is 0.4 now",
        ),
    ] {
        let ended = run(arguments);
        assert_eq!((ended.code, ended.stdout.as_str()), (Some(2), ""));
        for part in [
            "error: a/run.json: another run is kept here: \"A small scene\", 3 replicas, seed 1, version \"0.1.0\"",
            what,
            "--force overwrites it",
        ] {
            assert!(ended.stderr.contains(part), "{arguments}: {}", ended.stderr);
        }
        assert!(kept() == before, "{arguments}: nothing was changed");
    }
    // The same again is no other run.
    assert_eq!(run("--threads 1").code, Some(0));
    assert!(tables() == before_tables);
    // By force, and what the other run left and this one does not write goes.
    let fewer = "--force --seed 2 --set output.observables=[\"mean_angle\"]";
    assert_eq!(run(fewer).code, Some(0));
    assert_eq!(
        names(&dir.path().join("a")),
        ["mean_angle.csv", "mean_angle.svg", "run.json"]
    );

    let put = |text: &str| fs::write(dir.path().join("a/run.json"), text).unwrap();
    put("{");
    assert!(run("").stderr.contains("a/run.json: is no record of a run: "));
    // Another version, and a record that names a file which is not this folder's.
    let record = before.iter().find(|(_, name)| name == "run.json").unwrap();
    put(&record
        .0
        .replace("\"version\": \"0.1.0\"", "\"version\": \"0.0.9\""));
    assert!(
        run("")
            .stderr
            .contains("version was \"0.0.9\" and is \"0.1.0\" now")
    );
    put(&record.0.replace("\"mean_angle.csv\"", "\"../small.toml\""));
    assert_eq!(run("--force --seed 3").code, Some(0));
    assert_eq!(read(&dir.path().join("small.toml")), SMALL);
    fs::write(dir.path().join("a/sweep.json"), "{}").unwrap();
    assert!(run("").stderr.contains("a/sweep.json: a sweep is kept here"));
}
