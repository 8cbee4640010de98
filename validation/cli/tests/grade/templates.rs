//! The templates of `peers/templates`: each is compiled where its tool is there, and graded over the text protocol.

use crate::bounded::{ANSWER_S, Bounded};
use crate::grading::{Graded, graded};
use crate::programs::{peers, python, run, runs, skipped};
use std::path::{Path, PathBuf};

const PROBLEMS: [&str; 3] = ["mid-flip-2", "disc-0.1", "spiral"];

fn judged(command: &str, more: &[&str]) -> Graded {
    let problems = PROBLEMS.map(|name| ["--problem", name]);
    let asked = ["--protocol", "text", "--command", command, "--order", "4", "--timeout", ANSWER_S];
    graded(&[&asked[..], more, problems.as_flattened()].concat())
}

/// RK4 passes with its order, and the same with a wrong weight fails.
fn holds(name: &str, command: &str) {
    let found = judged(command, &["--brief"]);
    assert_eq!(found.code, Some(0), "{name}: {}", found.words);
    for problem in PROBLEMS {
        assert_eq!(found.of(problem)["order_found"], "seen", "{name}: {}", found.words);
    }
}

fn template(name: &str) -> PathBuf {
    peers().join("templates").join(name)
}

/// A file of the peers, perhaps with one text replaced.
fn changed(path: &str, change: Option<(&str, &str)>) -> String {
    let text = std::fs::read_to_string(peers().join(path)).unwrap();
    let Some((old, new)) = change else { return text };
    assert!(text.contains(old), "{path}: {old}");
    text.replace(old, new)
}

/// Compiles a template, perhaps with one text replaced, and says how to start it.
fn compiled(compiler: &str, file: &str, dir: &Path, change: Option<(&str, &str)>) -> String {
    let (source, program) = (dir.join(file), dir.join("program"));
    std::fs::write(&source, changed(&format!("templates/{file}"), change)).unwrap();
    run(compiler, &[Path::new("-O2"), Path::new("-o"), &program, &source, Path::new("-lm")]);
    format!("'{}'", program.display())
}

#[test]
fn compiled_templates_pass_and_with_a_wrong_coefficient_fail() {
    for (compiler, file, old, new) in [
        ("cc", "my_code.c", "2 * k[1][i]", "1.8 * k[1][i]"),
        ("c++", "my_code.cpp", "2 * k2[i]", "1.8 * k2[i]"),
        ("gfortran", "my_code.f90", "2*k2", "1.8d0*k2"),
    ] {
        if !runs(compiler, &["--version"]) {
            skipped(file, &format!("no {compiler}"));
            continue;
        }
        let dir = tempfile::tempdir().unwrap();
        holds(file, &compiled(compiler, file, dir.path(), None));
        let wrong = judged(&compiled(compiler, file, dir.path(), Some((old, new))), &["--brief"]);
        assert_eq!(wrong.code, Some(1), "{file}: {}", wrong.words);
        for problem in PROBLEMS {
            assert_eq!(wrong.verdict(problem), "FAIL", "{file}: {}", wrong.words);
        }
        // (1 + 1.8 + 2 + 1)/6 of each step.
        let said = &wrong.grade.as_ref().unwrap()["diagnosis"][0];
        assert!(said.as_str().is_some_and(|said| said.starts_with("your time runs at 0.967")), "{}", wrong.words);
    }
}

#[test]
fn interpreted_templates_pass() {
    for (tool, file, flags) in
        [("python3", "my_code.py", ""), ("julia", "my_code.jl", ""), ("octave-cli", "my_code.m", " --quiet")]
    {
        let is_there = || runs(tool, &["--version"]).then(|| tool.to_owned());
        match if tool == "python3" { python("sys") } else { is_there() } {
            Some(found) => holds(file, &format!("'{found}'{flags} '{}'", template(file).display())),
            None => skipped(file, &format!("no {tool}")),
        }
    }
}

/// What of two tools is not here.
fn missing(tools: [&str; 2]) -> String {
    let missing = tools.into_iter().find(|tool| !runs(tool, &["--version"]));
    format!("no {}", missing.unwrap_or("reason"))
}

/// The studies of a program that runs speak the text protocol too, and so does the echo that the pipe's cost is taken
/// from.
#[test]
fn the_studies_speak_the_text_protocol() {
    if !runs("cc", &["--version"]) {
        return skipped("my_code.c", "no cc");
    }
    let dir = tempfile::tempdir().unwrap();
    let found = judged(&compiled("cc", "my_code.c", dir.path(), None), &[]);
    assert_eq!(found.code, Some(0), "{}", found.words);
    let live = &found.grade.as_ref().unwrap()["live"];
    assert!(live["work_precision"]["pipe_s"].as_f64().is_some_and(|seconds| seconds > 0.0), "{}", found.words);
    assert!(live["map"].is_array(), "{}", found.words);
    let longest = found.words.lines().filter(|line| !line.starts_with("report:")).map(|line| line.chars().count());
    assert!(longest.max().unwrap() <= 80, "{}", found.words);
}

/// `cmake/` and `fpm/`: the template passes as a test of theirs, and with a wrong coefficient their command fails.
#[test]
fn build_systems_hold_a_program_to_the_problems() {
    let program = Path::new(env!("CARGO_BIN_EXE_shearbed"));
    let path = std::env::var_os("PATH").unwrap_or_default();
    let all =
        std::env::join_paths(program.parent().map(Path::to_path_buf).into_iter().chain(std::env::split_paths(&path)));
    let all = all.unwrap();
    let dir = tempfile::tempdir().unwrap();
    let ends = |tool: &str, arguments: &[&str]| {
        let output = std::process::Command::new(tool).args(arguments).current_dir(dir.path()).env("PATH", &all).ended();
        (
            output.status.success(),
            format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr)),
        )
    };
    let put = |from: &str, to: &str, change: Option<(&str, &str)>| {
        let to = dir.path().join(to);
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        std::fs::write(to, changed(from, change)).unwrap();
    };
    if runs("cmake", &["--version"]) && runs("c++", &["--version"]) {
        put("cmake/CMakeLists.txt", "cmake/CMakeLists.txt", None);
        for change in [None, Some(("2 * k2[i]", "1.8 * k2[i]"))] {
            put("templates/my_code.cpp", "templates/my_code.cpp", change);
            for arguments in [&["-S", "cmake", "-B", "build"][..], &["--build", "build"]] {
                let (well, words) = ends("cmake", arguments);
                assert!(well, "{words}");
            }
            let (passed, words) = ends("ctest", &["--test-dir", "build", "--output-on-failure"]);
            assert_eq!(passed, change.is_none(), "{words}");
            assert!(words.contains(if passed { "100% tests passed" } else { "FAIL mid-flip-2: " }), "{words}");
        }
    } else {
        skipped("cmake", &missing(["cmake", "c++"]));
    }
    if runs("fpm", &["--version"]) && runs("gfortran", &["--version"]) {
        put("fpm/fpm.toml", "fpm.toml", None);
        let grader =
            "shearbed grade --problem mid-flip-2 --protocol text --order 4 --timeout 600 --brief --force --command";
        for change in [None, Some(("2*k2", "1.8d0*k2"))] {
            put("templates/my_code.f90", "test/my_code.f90", change);
            let (passed, words) = ends("fpm", &["test", "--runner", grader]);
            assert_eq!(passed, change.is_none(), "{words}");
        }
    } else {
        skipped("fpm", &missing(["fpm", "gfortran"]));
    }
}
