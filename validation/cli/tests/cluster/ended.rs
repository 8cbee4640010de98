//! Jobs that end early: bad input, a root that cannot write, a rank that dies.

use super::*;
use common::running::Running;

#[test]
fn bad_input_on_one_rank_ends_the_job() {
    let dir = folder();
    for command in ["run long.toml", "converge long.toml", "sweep long.toml --over interaction.alpha=1,2,3,4"] {
        let other = command.replace("long.toml", "missing.toml");
        let job = format!("-n 3 shearbed {command} --out x --threads 1 : -n 1 shearbed {other} --out x --threads 1");
        let (code, message) = shearbed(dir.path(), &job);
        assert_eq!(code, Some(2), "{message}");
        assert!(message.contains("error: rank 3 of 4: missing.toml: cannot be read"), "{message}");
    }
    assert!(!dir.path().join("x/sweep.csv").exists() && !dir.path().join("x/run.json").exists());
}

#[test]
fn bad_input_on_all_ranks_is_told_once() {
    let dir = folder();
    let (code, message) = shearbed(dir.path(), "-n 4 shearbed run missing.toml");
    assert_eq!(code, Some(2), "{message}");
    assert_eq!(message.matches("missing.toml: cannot be read").count(), 1, "{message}");
    assert!(message.contains("error: rank 0 of 4: missing.toml"), "{message}");
}

#[test]
fn a_root_that_cannot_write_ends_the_job() {
    let dir = folder();
    let over = "sweep long.toml --over interaction.alpha=1,2 --replicas 1 --over ensemble.seed=1,2 --out x";
    let first = mpirun(dir.path(), &format!("-n 2 shearbed {over} --threads 1 --quiet")).ended();
    assert!(first.status.success());
    fs::remove_dir_all(dir.path().join("x/points")).unwrap();
    fs::write(dir.path().join("x/points"), "in the way").unwrap();
    let (code, message) = shearbed(dir.path(), &format!("-n 4 shearbed {over} --threads 1"));
    assert_eq!(code, Some(2), "{message}");
    assert!(message.contains("error: rank 0 of 4: x/points/1: cannot be written"), "{message}");
}

#[test]
fn a_rank_that_dies_ends_the_job() {
    for dies in [0, 3] {
        let dir = folder();
        let mut job = Running::start(mpirun(dir.path(), "-n 4 shearbed run long.toml --out x --threads 1"));
        // All ranks have agreed on their input when the root warns, and the work takes hours.
        while !job.message().contains("warning: long.toml") {}
        kill(children(job.id())[dies], "-9");
        assert_ne!(job.end().code, Some(0));
        assert!(!dir.path().join("x").exists());
    }
}

/// A job's exit code and message.
pub fn shearbed(dir: &Path, arguments: &str) -> (Option<i32>, String) {
    let job = mpirun(dir, arguments).ended();
    (job.status.code(), text(&job.stderr))
}

/// The processes that a process has started, in order.
pub fn children(id: u32) -> Vec<u32> {
    let list = fs::read_to_string(format!("/proc/{id}/task/{id}/children")).unwrap_or_default();
    list.split_whitespace().map(|id| id.parse().unwrap()).collect()
}
