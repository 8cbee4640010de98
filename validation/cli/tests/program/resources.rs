//! What the program says of a launcher of ranks that it cannot use.
#![cfg(not(feature = "mpi"))]

use crate::common::bounded::Bounded;
use crate::common::{command, folder};

/// Both are set by the launcher for each process that it starts.
#[test]
fn a_build_without_mpi_says_that_its_launcher_starts_it_several_times() {
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
