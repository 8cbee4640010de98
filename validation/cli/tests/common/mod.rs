//! What several of the program's tests use.

#![allow(dead_code)] // Each test uses a part.

#[cfg(unix)]
pub mod running;
pub mod bounded;

pub use bounded::PATIENCE;

use bounded::Bounded;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A scene of milliseconds.
pub const SMALL: &str = r#"title = "A small scene"
[flow]
shear_rate_per_s = 0.5
[particles]
count = 20
length_mm = 0.72
aspect_ratio = 11.6
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
observables = ["projections", "mean_angle"]
"#;

/// The same with unequal rods and every observable of ⟨p⟩ and ⟨pp⟩.
pub static UNEQUAL: LazyLock<String> = LazyLock::new(|| {
    SMALL.replace("= 11.6\n", "= 11.6\naspect_ratio_sd_percent = 3.6\n").replace(
        "[\"projections\", \"mean_angle\"]",
        r#"["projections", "planar_projections", "mean_angle", "orbit_constant", "orientation_tensor"]"#,
    )
});

/// A folder in which a test runs commands.
pub struct Folder(TempDir);

impl Folder {
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    pub fn at(&self, name: &str) -> PathBuf {
        self.path().join(name)
    }

    pub fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::create_dir_all(self.at(name).parent().unwrap()).unwrap();
        fs::write(self.at(name), text).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        read(&self.at(name))
    }

    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.read(name)).unwrap()
    }

    pub fn files(&self, name: &str) -> BTreeMap<String, Vec<u8>> {
        files(&self.at(name))
    }

    /// Runs a command that ends well.
    pub fn runs(&self, arguments: &str) -> Ended {
        let ended = shearbed(self.path(), arguments);
        assert_eq!(ended.code, Some(0), "{arguments}: {}", ended.stderr);
        ended
    }

    /// Runs a command that ends with 2 and a message with these words, and leaves every file as it was.
    pub fn refuses(&self, arguments: &str, words: &str) {
        let before = files(self.path());
        let ended = shearbed(self.path(), arguments);
        assert_eq!(ended.code, Some(2), "{arguments}: {}", ended.stderr);
        assert!(ended.stderr.contains(words), "{arguments}: no {words:?} in {}", ended.stderr);
        assert!(files(self.path()) == before, "{arguments}: files have changed");
    }
}

pub fn empty_folder() -> Folder {
    Folder(tempfile::tempdir().unwrap())
}

/// A folder with [`SMALL`] as `small.toml` in it.
pub fn folder() -> Folder {
    let dir = empty_folder();
    dir.write("small.toml", SMALL);
    dir
}

/// The program with arguments separated by blanks.
pub fn command(dir: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_shearbed"));
    command.args(arguments.split_whitespace()).current_dir(dir);
    command
}

/// How a command ended.
pub struct Ended {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

/// Runs a command to its end.
pub fn shearbed(dir: &Path, arguments: &str) -> Ended {
    ended(&mut command(dir, arguments))
}

fn ended(command: &mut Command) -> Ended {
    let output = command.ended();
    Ended {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Sends a signal, unless the process has ended.
pub fn kill(id: u32, signal: &str) {
    Command::new("kill").args([signal, &id.to_string()]).ended();
}

/// Waits until something has come about.
pub fn wait_for(what: &str, mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        let seconds = PATIENCE.as_secs();
        assert!(start.elapsed() < PATIENCE, "this machine did not see within {seconds} s that {what}");
        sleep(Duration::from_millis(5));
    }
}

/// The names in a folder, in order.
pub fn names(dir: &Path) -> Vec<String> {
    let entries = fs::read_dir(dir).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Removes the hidden folders that killed processes left in a folder, and returns their number.
pub fn remove_left(dir: &Path) -> usize {
    let left: Vec<_> = names(dir).into_iter().filter(|name| name.starts_with(".shearbed-")).collect();
    left.iter().for_each(|name| fs::remove_dir_all(dir.join(name)).unwrap());
    left.len()
}

/// A file's text.
pub fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

/// Every regular file below a folder with its bytes.
pub fn files(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            let inner = files(&path).into_iter();
            all.extend(inner.map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else if path.is_file() {
            all.insert(name, fs::read(&path).unwrap());
        }
    }
    all
}

/// All that a run leaves, and of `run.json` what is no time, thread, command or way by which the replicas were found.
pub fn results(dir: &Path) -> (BTreeMap<String, Vec<u8>>, serde_json::Value) {
    let mut all = files(dir);
    let mut record: serde_json::Value = serde_json::from_slice(&all.remove("run.json").unwrap()).unwrap();
    // It has the inputs, and the checksum of run.json.
    all.remove("shearbed.json").unwrap();
    for key in ["seconds", "threads", "command", "until_se"] {
        record.as_object_mut().unwrap().remove(key);
    }
    (all, record)
}
