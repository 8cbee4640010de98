//! What the program says where there is too little memory, no thread, too long an input, or a launcher of ranks that it
//! cannot use.

use crate::common::{folder, limited};
use std::fs;
use std::path::Path;

#[cfg(target_os = "linux")]
#[test]
fn a_command_with_little_memory_does_its_work_or_is_refused() {
    let dir = folder();
    dir.runs("run small.toml --out x --quiet");
    for arguments in [
        "problems export e",
        "grade --command cat --brief --problem sphere --timeout 1",
        "plot x --out x.png",
        "validate --case jeffery-period",
        "run small.toml --out y",
    ] {
        for limit in [80_000, 130_000, 200_000] {
            let ended = limited(dir.path(), &format!("export RAYON_NUM_THREADS=2; ulimit -v {limit}"), arguments);
            // Some need less.
            let runs = ended.code == Some(0);
            let refused = ended.code == Some(2) && ended.stderr.starts_with("error: ");
            assert!(runs || refused, "{arguments} with {limit} kB: {:?} {}", ended.code, ended.stderr);
        }
    }
}

/// Root has no limit of processes: another user's is set, in a folder that it may write.
#[cfg(target_os = "linux")]
#[test]
fn a_command_without_threads_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    if !rustix::process::geteuid().is_root() || !Path::new("/usr/bin/setpriv").is_file() {
        return eprintln!("skipped: the limit of processes is set by root with setpriv alone");
    }
    let dir = folder();
    let program = dir.at("program");
    fs::copy(env!("CARGO_BIN_EXE_shearbed"), &program).unwrap();
    fs::set_permissions(dir.path(), fs::Permissions::from_mode(0o777)).unwrap();
    for arguments in [
        "problems export e",
        "grade --command cat --brief --problem sphere --timeout 1",
        "reference --aspect-ratio 3 --times 0:1:3 --unit period",
        "converge extension",
        "run small.toml",
        "validate --case jeffery-period",
    ] {
        // The program's first thread and its own, and no more.
        let user = "setpriv --reuid 65533 --regid 65533 --clear-groups prlimit --nproc=2 --";
        let ended = limited(dir.path(), &format!("exec {user} ./program {arguments}"), "");
        assert_eq!(ended.code, Some(2), "{arguments}: {}", ended.stderr);
        let message = ended.stderr.starts_with("error: ") && ended.stderr.contains("RAYON_NUM_THREADS=1");
        assert!(message && !ended.stderr.contains("panicked"), "{arguments}: {}", ended.stderr);
    }
}

/// Both are set by the launcher for each process that it starts.
#[cfg(not(feature = "mpi"))]
#[test]
fn a_build_without_mpi_says_that_its_launcher_starts_it_several_times() {
    use crate::common::bounded::Bounded;
    use crate::common::command;
    let dir = folder();
    for (launcher, size, rank, warned) in [
        ("OMPI_COMM_WORLD", "3", "0", true),
        ("PMI", "3", "0", true),
        ("PMI", "3", "1", false),
        ("OMPI_COMM_WORLD", "1", "0", false),
    ] {
        let set = [("SIZE", size), ("RANK", rank)].map(|(name, value)| (format!("{launcher}_{name}"), value));
        let ended = command(dir.path(), "plan small.toml").envs(set).ended();
        let message = String::from_utf8(ended.stderr).unwrap();
        assert!(ended.status.success(), "{message}");
        let expected = format!("warning: {launcher}_SIZE = 3: this build shares no work over ranks");
        assert_eq!(message.starts_with(&expected), warned, "{message}");
    }
}
