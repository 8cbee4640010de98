//! Bad input: exit code 2, a message, and nothing written.

use crate::common::bounded::end;
use crate::common::{UNEQUAL, names, read, shearbed, unequal};
use std::fs;
#[cfg(unix)]
use std::process::Stdio;

/// Arguments, and a part of the message.
#[rustfmt::skip]
const REJECTED: &[(&str, &str)] = &[
    ("", "Usage: shearbed <COMMAND>"),
    ("rnu small.toml", "unrecognized subcommand 'rnu'"),
    ("run", "<SCENE>"),
    ("run no.toml", "no.toml: cannot be read: No such file or directory; nor is it a built-in scene"),
    ("fit small.toml --data no.csv --over interaction.alpha=0.1:1", "no.csv: cannot be read: No such file or \
        directory\n"),
    ("run fig4n50", "close names: fig4-n50"),
    ("plan .", ".: cannot be read: it is a folder; a regular file is needed"),
    ("plan latin.toml", "latin.toml: cannot be read: it is not UTF-8 text (line 2)"),
    ("plan file", "file:1: title is missing: expected a text in quotes"),
    ("run zero.toml", "zero.toml:5: particles.count = 0 is not allowed: expected a whole number from 1 to 100000000"),
    ("run wide.toml", "wide.toml:8: particles.aspect_ratio_sd_percent = 40 is not allowed: expected a number below "),
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
    ("reference --aspect-ratio 5 --times 1e-1000000", "'1e-1000000' for '--times <FROM:TO:COUNT|T1,T2,…>': \
        FROM:TO:COUNT"),
    ("reference --aspect-ratio 5 --times 0:1e-1000000:2", "0 or of a size from 5e-324 to 1.8e308"),
    ("reference --times 1 --aspect-ratio=1e-1000000", "a number from 1e-100 to 1e100, or inf, is allowed"),
    ("reference --times 1 --aspect-ratio 5 --c-i=-1e-1000000", "0 (free rods), a number from 1e-9 to 1e9"),
    ("reference --times 1 --aspect-ratio 5 --aspect-ratio-sd-percent 1e-1000000", "a number from 0 to below 100"),
    ("reference --times 1 --aspect-ratio 5 --gradient-per-s 1e-1000000,0,0,1,0,0,0,0,0", "nine finite numbers"),
    ("reference --times 1 --aspect-ratio 5 --start 1e-1000000,90", "`isotropic`, or φ,θ in degrees"),
    ("sweep small.toml --over interaction.alpha=1e-1000000:1:3", "\"1e-1000000\" is no end of a range"),
    ("run small.toml --until-se x1=1e400", "a column and a number above 0 are allowed"),
    ("validate --case no-such-case", "--case no-such-case: no case has this name. `shearbed validate --list` has all"),
    ("validate --case jefery-period", "--case jefery-period: no case has this name; did you mean jeffery-period? \
        Others"),
    ("validate --case foo", "--case foo: no case has this name; did you mean fourth-moments? `shearbed validate \
        --list` has all\n"),
    ("validate --data no-such-folder", "'no-such-folder' for '--data <DIR>': No such file or directory"),
    ("validate --data file", "'file' for '--data <DIR>': it is no folder; an existing folder is allowed"),
    ("validate --out file", "file: cannot be written: "),
    ("grade ref mine --timeout 3", "'[MINE]' cannot be used with '--timeout <S>'"),
    ("grade ref mine --brief", "'[MINE]' cannot be used with '--brief'"),
    ("grade --command x --timestep-s 1", "cannot be used with '--timestep-s <S>'"),
    ("grade --command x --rod-axis x", "cannot be used with '--rod-axis <x|y|z>'"),
];

/// Ranks of a job write to one pipe, and what `mpirun` says may come between two writes: each line is one write, which
/// a datagram keeps.
#[cfg(unix)]
#[test]
fn a_message_is_written_in_one_piece() {
    use std::os::fd::OwnedFd;
    use std::os::unix::net::UnixDatagram;
    let dir = unequal();
    let first_piece = |words: &[&str]| {
        let (ours, theirs) = UnixDatagram::pair().unwrap();
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_shearbed"));
        program.args(words).current_dir(dir.path()).stdout(Stdio::null()).stderr(OwnedFd::from(theirs));
        let status = end(&format!("{words:?}"), program.spawn().unwrap()).status;
        let mut piece = vec![0; 1 << 16];
        let length = ours.recv(&mut piece).unwrap();
        (status.code(), String::from_utf8(piece[..length].to_vec()).unwrap())
    };
    let (code, said) = first_piece(&["run", "no.toml"]);
    assert_eq!(code, Some(2));
    assert!(said.starts_with("error: no.toml: cannot be read: ") && said.ends_with('\n'), "{said:?}");
    let (code, said) = first_piece(&[
        "run",
        "fig4-n50",
        "--replicas",
        "1",
        "--set",
        "particles.aspect_ratio=5",
        "--quiet",
        "--out",
        "x",
    ]);
    assert_eq!(code, Some(0), "{said:?}");
    assert!(said.starts_with("warning: fig4-n50: ") && said.ends_with('\n'), "{said:?}");
}

#[test]
fn bad_input_ends_with_2_and_a_message() {
    let dir = unequal();
    let put = |name: &str, text: &[u8]| fs::write(dir.path().join(name), text).unwrap();
    put("file", b"");
    put("latin.toml", b"title = \"a\"\n# n = 50 cm\xb3\n");
    put("zero.toml", UNEQUAL.replace("count = 20", "count = 0").as_bytes());
    put("wide.toml", UNEQUAL.replace("= 3.6", "= 40").as_bytes());
    put("sphere.toml", UNEQUAL.replace("= 11.6", "= 1").replace("= 3.6", "= 0").as_bytes());
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

/// Linux says what memory there is.
#[cfg(target_os = "linux")]
#[test]
fn a_scene_that_does_not_fit_in_memory_is_refused_before_it_starts() {
    let dir = unequal();
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

/// The law that interacting rods are studied by is of periods and of plane Couette flow; what else there is to do is
/// said.
#[test]
fn a_study_of_rods_that_meet_needs_shear_by_periods() {
    let dir = unequal();
    let by_strain = UNEQUAL
        .replace("periods = 1\nsteps_per_period = 200\noutputs_per_period = 4", "strain = 2\nsteps_per_strain = 10");
    let elliptic = UNEQUAL
        .replace("shear_rate_per_s = 0.5", "gradient_per_s = [[0, -0.2, 0], [0.5, 0, 0], [0, 0, 0]]")
        .replace("\"orbit_constant\", ", "");
    for (name, scene, advice) in [
        ("strain.toml", by_strain, "time.steps_per_strain=10,20,40"),
        ("elliptic.toml", elliptic, "time.steps_per_period=200,400,800"),
    ] {
        fs::write(dir.path().join(name), scene).unwrap();
        let plan = shearbed(dir.path(), &format!("plan {name}"));
        assert_eq!(plan.code, Some(0), "{}", plan.stderr);
        assert!(
            plan.stdout.contains("converge: only plane Couette flow by periods, and no particles.rods\n"),
            "{}",
            plan.stdout
        );
        let before = names(dir.path());
        let ended = shearbed(dir.path(), &format!("converge {name}"));
        assert_eq!(ended.code, Some(2), "{}", ended.stderr);
        assert!(ended.stderr.contains(&format!("{name}: converge of interacting rods needs")), "{}", ended.stderr);
        assert!(ended.stderr.contains(advice), "{}", ended.stderr);
        assert_eq!(names(dir.path()), before);
        // The advice can be followed.
        let sweep = shearbed(dir.path(), &format!("sweep {name} --over {advice} --out s-{name} --quiet"));
        assert_eq!(sweep.code, Some(0), "{}", sweep.stderr);
    }
}
