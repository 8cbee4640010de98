//! The program while it runs: tests choose their moments by what it writes, never by a clock.

use super::{Ended, PATIENCE, kill, wait_for};
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::process::{Child, Command, Stdio};

/// A running program.
pub struct Running {
    child: Child,
    stdout: Captured,
    stderr: Captured,
}

/// What the program writes to one of its outputs.
struct Captured {
    stream: BufReader<UnixStream>,
    /// Bytes before the program's own.
    filler: usize,
}

impl Running {
    /// Starts a program.
    pub fn start(command: Command) -> Self {
        Self::with(command, Captured::open())
    }

    /// Starts a program that waits, for as long as the test likes, where it first writes to standard error: nobody
    /// reads there.
    pub fn held_at_its_first_message(command: Command) -> Self {
        Self::with(command, Captured::full())
    }

    fn with(mut command: Command, (stderr, end): (Captured, OwnedFd)) -> Self {
        let (stdout, own) = Captured::open();
        let child = command.stdout(Stdio::from(own)).stderr(Stdio::from(end)).spawn();
        Self { child: child.unwrap(), stdout, stderr }
    }

    /// The process's number.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Waits until something has come about while the program runs.
    pub fn wait_for(&mut self, what: &str, holds: impl Fn() -> bool) {
        assert!(self.reaches(what, holds), "it has ended before {what}");
    }

    /// The same; false where the program has ended before.
    pub fn reaches(&mut self, what: &str, holds: impl Fn() -> bool) -> bool {
        let (child, mut held) = (&mut self.child, false);
        wait_for(what, || {
            let ended = child.try_wait().unwrap();
            // Looked at after its end: what it did last counts.
            held = holds();
            held || ended.is_some()
        });
        held
    }

    /// The next line of standard output; empty at the end.
    pub fn line(&mut self) -> String {
        self.stdout.line()
    }

    /// The next line of standard error; empty at the end. A program that was held goes on.
    pub fn message(&mut self) -> String {
        self.stderr.line()
    }

    /// Sends a signal.
    pub fn signal(&self, name: &str) {
        kill(self.id(), name);
    }

    /// Lets the program go on where it was held, and waits for its end.
    pub fn end(mut self) -> Ended {
        let [stderr, stdout] = [&mut self.stderr, &mut self.stdout].map(Captured::rest);
        Ended { code: self.child.wait().unwrap().code(), stdout, stderr }
    }
}

impl Drop for Running {
    /// A test that failed leaves no program at work.
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Captured {
    /// A stream, and the program's end of it.
    fn open() -> (Self, OwnedFd) {
        let (own, end) = UnixStream::pair().unwrap();
        own.set_read_timeout(Some(PATIENCE)).unwrap();
        let captured = Self { stream: BufReader::new(own), filler: 0 };
        (captured, end.into())
    }

    /// The same where nothing more can be written until somebody reads.
    fn full() -> (Self, OwnedFd) {
        let (mut captured, end) = Self::open();
        let mut end = UnixStream::from(end);
        end.set_nonblocking(true).unwrap();
        loop {
            match end.write(b"~") {
                Ok(bytes) => captured.filler += bytes,
                Err(error) if error.kind() == ErrorKind::WouldBlock => break,
                Err(error) => panic!("{error}"),
            }
        }
        end.set_nonblocking(false).unwrap();
        (captured, end.into())
    }

    fn line(&mut self) -> String {
        self.skip();
        let mut line = String::new();
        self.stream.read_line(&mut line).unwrap_or_else(in_words);
        line
    }

    fn rest(&mut self) -> String {
        self.skip();
        let mut rest = String::new();
        self.stream.read_to_string(&mut rest).unwrap_or_else(in_words);
        rest
    }

    fn skip(&mut self) {
        let mut filler = vec![0; std::mem::take(&mut self.filler)];
        self.stream.read_exact(&mut filler).unwrap_or_else(in_words);
    }
}

fn in_words<T>(error: std::io::Error) -> T {
    let seconds = PATIENCE.as_secs();
    panic!("this machine did not end the program within {seconds} s, or it hangs: {error}")
}
