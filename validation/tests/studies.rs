//! `bench` and `converge` as a user meets them: exit codes, messages and files.

use std::path::Path;
use std::process::Command;

/// Runs `shearbed` in `dir`: exit code, standard output and standard error.
fn shearbed(dir: &Path, arguments: &str) -> (Option<i32>, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .args(arguments.split_whitespace())
        .current_dir(dir)
        .output()
        .unwrap();
    (
        output.status.code(),
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    )
}

#[test]
fn an_unknown_bench_is_refused_with_those_there_are() {
    let dir = tempfile::tempdir().unwrap();
    let (code, _, error) = shearbed(dir.path(), "bench --case re3");
    assert_eq!(code, Some(2));
    for text in ["--case re3", "re2, re11.6, re100, re10000"] {
        assert!(error.contains(text), "{error}");
    }
    assert!(!dir.path().join("out").exists());
}

#[test]
fn a_free_scene_shows_every_order_as_theory() {
    let dir = tempfile::tempdir().unwrap();
    let (code, text, error) = shearbed(dir.path(), "converge fig6-uniform");
    assert_eq!(code, Some(0), "{error}");
    assert_eq!(text.matches("as theory").count(), 7, "{text}");
    let out = dir.path().join("out/converge-fig6-uniform");
    let csv = std::fs::read_to_string(out.join("converge.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 7 * 13, "{csv}");
    assert!(out.join("converge.json").exists());
}

#[test]
fn a_free_scene_in_another_flow_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let (code, _, error) = shearbed(dir.path(), "converge extension");
    assert_eq!(code, Some(2));
    assert!(
        error.contains("extension: flow:") && error.contains("shear_rate_per_s"),
        "{error}"
    );
}

#[test]
fn an_interacting_scene_shows_steps_rods_and_replicas() {
    let dir = tempfile::tempdir().unwrap();
    let (code, text, error) = shearbed(dir.path(), "converge fig4-n50 --replicas 4 --out here");
    assert_eq!(code, Some(0), "{error}");
    for head in ["steps per period", "rods", "se √M"] {
        assert!(text.contains(head), "{text}");
    }
    let csv = std::fs::read_to_string(dir.path().join("here/converge.csv")).unwrap();
    assert!(
        csv.starts_with("against,steps_per_period,rods,replicas,x1,x1_se\n"),
        "{csv}"
    );
}
