//! Child processes of tests. None is waited for without a bound: at it the process is ended, and the test fails and
//! says which it was.

#![allow(dead_code)] // Each test uses a part.

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::channel;
use std::thread::spawn;
use std::time::Duration;

/// How long a test waits for a process. It is no measure of the program: a machine that needs longer is at fault, and
/// the message says so.
pub const PATIENCE: Duration = Duration::from_secs(600);

/// `--timeout` of a graded program that answers within milliseconds: two answers in vain end within [`PATIENCE`].
pub const ANSWER_S: &str = "200";

/// A command that is waited for.
pub trait Bounded {
    /// Runs the command to its end, without input.
    fn ended(&mut self) -> Output;
}

impl Bounded for Command {
    fn ended(&mut self) -> Output {
        self.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        end(&format!("{self:?}"), self.spawn().unwrap_or_else(|error| panic!("{self:?}: {error}")))
    }
}

/// Bash at commands in a folder; `shearbed` is the program of this build.
pub fn bash(dir: &Path, commands: &str) -> Command {
    let program = Path::new(env!("CARGO_BIN_EXE_shearbed")).parent().unwrap();
    let mut bash = Command::new("bash");
    bash.args(["-c", commands]).current_dir(dir);
    bash.env("PATH", format!("{}:/usr/local/bin:/usr/bin:/bin", program.display()));
    bash
}

/// Waits for the end of a process, and reads what it writes into pipes.
pub fn end(name: &str, child: Child) -> Output {
    within(PATIENCE, name, child)
}

fn within(patience: Duration, name: &str, child: Child) -> Output {
    let id = child.id().to_string();
    let (ended, end) = channel();
    spawn(move || ended.send(child.wait_with_output()));
    end.recv_timeout(patience).map(Result::unwrap).unwrap_or_else(|_| {
        // At the first signal the program ends those that it has started.
        let mut written = None;
        for signal in ["-TERM", "-KILL"] {
            if written.is_none() {
                let _ = Command::new("kill").args([signal, &id]).spawn().map(|mut kill| kill.wait());
                written = end.recv_timeout(Duration::from_secs(5)).ok().and_then(Result::ok);
            }
        }
        let [stdout, stderr] = written.map_or([vec![], vec![]], |output| [output.stdout, output.stderr]);
        let written = [stdout, stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
        panic!("this machine did not end {name} within {patience:?}, or it hangs; it wrote: {written}")
    })
}

#[test]
fn a_process_that_hangs_is_named_and_ended() {
    let child = Command::new("sh").args(["-c", "echo begun; exec sleep 1000"]).stdout(Stdio::piped()).spawn().unwrap();
    let id = child.id();
    let hung = std::panic::catch_unwind(|| within(Duration::from_millis(500), "a sleeper", child)).unwrap_err();
    let words = hung.downcast_ref::<String>().unwrap();
    assert!(words.contains("a sleeper within 500ms, or it hangs; it wrote: begun"), "{words}");
    let sent = Command::new("kill").args(["-0", &id.to_string()]).stderr(Stdio::null()).ended();
    assert!(!sent.status.success(), "it is left");
}
