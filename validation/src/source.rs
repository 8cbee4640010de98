//! The project's own sources, as tests read them.

mod examples;
mod map;
mod order;
pub mod reach;

use std::path::{Path, PathBuf};

/// A Rust file.
#[derive(Clone)]
pub struct File {
    /// Its name; of `mod.rs` its folder's.
    pub module: String,
    /// The file or folder beside `lib.rs` that it belongs to.
    pub room: String,
    /// Whether it is a file of tests, or lies below one.
    pub of_tests: bool,
    pub text: String,
}

/// Where the core's are.
pub fn core() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../src")
}

/// Where the suite's are.
pub fn suite() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Where the oracles' are.
pub fn oracle() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("oracle/src")
}

/// Every Rust file below a folder.
pub fn files(folder: &Path) -> Vec<File> {
    let mut open = vec![folder.to_owned()];
    let mut found = Vec::new();
    while let Some(path) = open.pop() {
        if path.is_dir() {
            let entries = std::fs::read_dir(&path).expect("a folder");
            open.extend(entries.map(|entry| entry.expect("an entry").path()));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let place = path.strip_prefix(folder).expect("below it");
            let stem = |path: &Path| path.file_stem().expect("a name").to_string_lossy().into_owned();
            let module = match stem(&path).as_str() {
                "mod" => stem(path.parent().expect("a folder")),
                name => name.to_owned(),
            };
            found.push(File {
                module,
                of_tests: place.iter().any(|name| name == "tests" || name == "tests.rs"),
                room: stem(Path::new(place.iter().next().expect("a name"))),
                text: std::fs::read_to_string(&path).expect("text"),
            });
        }
    }
    found
}
