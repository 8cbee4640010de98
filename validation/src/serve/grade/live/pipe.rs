//! A program behind two pipes: lines in, lines out, with each wait bounded in time and memory.

use super::kill;
use crate::files::text;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStderr, ChildStdin, ChildStdout, Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender, SyncSender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// The longest line that is read, in bytes: ten times the longest answer.
pub const LONGEST_LINE: usize = 1 << 20;

/// The number of unread lines that are buffered. A program that writes more must wait.
const LINES_HELD: usize = 4;

/// The number of bytes kept from the end of the program's standard error.
const LAST_WORDS: usize = 2048;

/// The time that a program has to end once its input or its output is closed: thousands of times what it needs, as the
/// machine may be busy. Only a remark depends on it, no verdict.
const GRACE: Duration = Duration::from_secs(5);

/// The reason why there is no next line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Trouble {
    /// Nothing came in time, and the processor time that the program used meanwhile, if the system says it.
    #[error("{}", hung(*.0, *.1))]
    Hung(Duration, Option<Duration>),
    /// The program ended: its exit code or signal, and the end of what it wrote to standard error.
    #[error("the program ended: {0}")]
    Ended(String),
    /// It closed its standard output and went on.
    #[error("it closed its standard output and went on; it was stopped")]
    Closed,
    /// The line with this number is longer than [`LONGEST_LINE`].
    #[error("line {0} of standard output is longer than {LONGEST_LINE} bytes; the program was stopped")]
    TooLong(u64),
}

/// The time for the first line of a program, which starts before, in limits.
const FIRST: u32 = 3;

/// The share of the time below which a program waits and does not compute.
const IDLE: f64 = 0.1;

/// The longest wait, in limits, for a program that computes on a machine that others keep busy.
const WAITS: u32 = 4;

fn hung(limit: Duration, used: Option<Duration>) -> String {
    let limit_s = limit.as_secs_f64();
    let why = match used.map(|used| used.as_secs_f64()) {
        Some(used) if used > IDLE * limit_s => {
            format!(", with {used:.1} s of processor time: it still computes (a longer timeout allows more)")
        }
        _ => " (is standard output flushed after each line?)".to_owned(),
    };
    format!("no answer within {limit_s} s; it was stopped{why}")
}

/// A line of the program; none if it is too long.
type Heard = Option<Vec<u8>>;

/// A running program. When dropped, the program and its descendants are killed.
pub struct Pipe {
    child: Child,
    requests: Option<Sender<Vec<u8>>>,
    lines: Receiver<Heard>,
    last_words: Arc<Mutex<Vec<u8>>>,
    /// Carries no message: it is closed when standard error has been read to its end.
    all_said: Receiver<()>,
    /// Number of lines received so far.
    heard: u64,
    /// The exit status and a message on each process that could not be killed, once all were killed.
    end: Option<(Option<ExitStatus>, Vec<String>)>,
}

impl Pipe {
    /// Starts `words[0]` with the other words as arguments, in a process group of its own.
    pub fn start(words: &[String]) -> Result<Self, String> {
        let (program, arguments) = words.split_first().ok_or("the command is empty")?;
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = kill::start(&mut command).map_err(|error| format!("{program}: cannot be started: {error}"))?;
        let (stdin, stdout, stderr) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        let (requests, to_write) = mpsc::channel();
        let (heard, lines) = mpsc::sync_channel(LINES_HELD);
        let last_words = Arc::new(Mutex::new(Vec::new()));
        let (saying, all_said) = mpsc::channel();
        // The threads are never joined: a process outside the process group may hold a pipe open for ever.
        let words = Arc::clone(&last_words);
        let pipe = Self { child, requests: Some(requests), lines, last_words, all_said, heard: 0, end: None };
        if let (Some(stdin), Some(stdout), Some(stderr)) = (stdin, stdout, stderr) {
            let thread = || thread::Builder::new();
            let started = (thread().spawn(move || write_requests(stdin, to_write)))
                .and_then(|_| thread().spawn(move || read_lines(stdout, heard)))
                .and_then(|_| {
                    thread().spawn(move || {
                        keep_last_words(stderr, &words);
                        drop::<Sender<()>>(saying);
                    })
                });
            started.map_err(|error| format!("{program}: no thread for its pipes: {error}"))?;
        }
        Ok(pipe)
    }

    /// Sends a line. If the program does not read it, the missing answer shows that.
    pub fn send(&mut self, line: String) {
        if let Some(requests) = &self.requests {
            // The writer is gone if the program has closed its input; its answer will be missing.
            let _ = requests.send((line + "\n").into_bytes());
        }
    }

    /// The next line within `limit`, with its number counted from 1. The limit is on the processor time where the
    /// system says it and the program computes.
    pub fn line(&mut self, limit: Duration) -> Result<(u64, String), Trouble> {
        let limit = if self.heard == 0 { FIRST * limit } else { limit };
        // To ask for the processor time takes longer than most answers.
        let first = limit.mul_f64(IDLE);
        let (mut wait, mut before, begun) = (first, None, Instant::now());
        loop {
            match self.lines.recv_timeout(wait) {
                Ok(heard) => return self.counted(heard),
                Err(RecvTimeoutError::Disconnected) => return Err(self.ended()),
                Err(RecvTimeoutError::Timeout) => {}
            }
            let used = kill::processor_time(self.child.id());
            let spent = used.zip(before).map(|(used, before): (Duration, _)| used.saturating_sub(before));
            let computes = |spent: &Duration| *spent < limit && *spent > begun.elapsed().mul_f64(IDLE);
            wait = match spent {
                None if begun.elapsed() < limit => limit - first,
                Some(spent) if computes(&spent) && begun.elapsed() < WAITS * limit => limit - spent,
                _ => return Err(Trouble::Hung(limit, spent)),
            };
            before = before.or(used);
        }
    }

    fn counted(&mut self, heard: Heard) -> Result<(u64, String), Trouble> {
        self.heard += 1;
        match heard {
            Some(bytes) => {
                let text = String::from_utf8_lossy(&bytes);
                Ok((self.heard, text.trim_end_matches(['\n', '\r']).to_owned()))
            }
            None => Err(Trouble::TooLong(self.heard)),
        }
    }

    /// Closes the program's input, waits for its end, and ends its descendants. `Err` says what was wrong with the end.
    pub fn close(mut self) -> Result<(), String> {
        let wrong: Vec<_> = self.ends().err().into_iter().chain(self.left()).collect();
        if wrong.is_empty() { Ok(()) } else { Err(wrong.join("; ")) }
    }

    /// Stops the program and its descendants. Returns a message on each process that cannot be stopped.
    pub fn left(mut self) -> Vec<String> {
        self.stop().1.clone()
    }

    fn ends(&mut self) -> Result<(), String> {
        drop(self.requests.take());
        let deadline = Instant::now() + GRACE;
        while !self.has_ended() {
            self.nothing_more(Duration::ZERO)?;
            thread::sleep(Duration::from_millis(5));
            if Instant::now() > deadline {
                let grace = GRACE.as_secs();
                return Err(format!("it did not end within {grace} s of the end of its input and was stopped"));
            }
        }
        // Its last output may still be on the way; a child process may hold standard output open.
        self.nothing_more(GRACE)
    }

    /// Waits for an unexpected line. `Err` says that there was one.
    pub fn nothing_more(&mut self, limit: Duration) -> Result<(), String> {
        let Ok(heard) = self.lines.recv_timeout(limit) else {
            return Ok(());
        };
        match self.counted(heard) {
            Ok((line, text)) => Err(format!("line {line} of standard output answers nothing: {}", excerpt(&text))),
            Err(trouble) => Err(trouble.to_string()),
        }
    }

    fn ended(&mut self) -> Trouble {
        // Its output is closed: if it is about to end, it ends soon.
        let deadline = Instant::now() + GRACE;
        while !self.has_ended() && Instant::now() < deadline {
            thread::sleep(Duration::from_millis(5));
        }
        if !self.has_ended() {
            return Trouble::Closed;
        }
        let mut how = self.stop().0.map_or("nobody knows how".to_owned(), |status| status.to_string());
        // Its last output may still be on the way; a child process may hold standard error open.
        let _ = self.all_said.recv_timeout(GRACE);
        let words = self.last_words.lock().unwrap_or_else(PoisonError::into_inner);
        let words = String::from_utf8_lossy(&words).trim().replace('\n', " | ");
        let start = words.char_indices().rev().nth(299).map_or(0, |(at, _)| at);
        if !words.is_empty() {
            how += &format!("; its last words on standard error: {}", &words[start..]);
        }
        Trouble::Ended(how)
    }

    /// True if the program has ended; it is not reaped, so that its id stays reserved until [`Pipe::stop`].
    #[cfg(unix)]
    fn has_ended(&mut self) -> bool {
        if self.end.is_some() {
            return true;
        }
        use rustix::process::{WaitId, WaitIdOptions, waitid};
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        let id = rustix::process::Pid::from_child(&self.child);
        !matches!(waitid(WaitId::Pid(id), options), Ok(None))
    }

    #[cfg(not(unix))]
    fn has_ended(&mut self) -> bool {
        !matches!(self.child.try_wait(), Ok(None))
    }

    fn stop(&mut self) -> &(Option<ExitStatus>, Vec<String>) {
        self.end.get_or_insert_with(|| kill::end(&mut self.child))
    }
}

impl Drop for Pipe {
    fn drop(&mut self) {
        self.stop();
    }
}

fn write_requests(mut stdin: ChildStdin, requests: Receiver<Vec<u8>>) {
    for request in requests {
        if stdin.write_all(&request).and_then(|()| stdin.flush()).is_err() {
            return;
        }
    }
}

fn read_lines(stdout: ChildStdout, heard: SyncSender<Heard>) {
    let mut reader = BufReader::new(stdout);
    while let Ok(line @ [_, ..]) = next_line(&mut reader).as_deref() {
        let too_long = line.len() > LONGEST_LINE;
        let sent = heard.send((!too_long).then(|| line.to_owned()));
        if too_long || sent.is_err() {
            return;
        }
    }
}

/// The next line with its end, cut one byte after [`LONGEST_LINE`]; empty at the end of the input.
pub(super) fn next_line(reader: &mut impl BufRead) -> io::Result<Vec<u8>> {
    let mut line = Vec::new();
    reader.take(LONGEST_LINE as u64 + 1).read_until(b'\n', &mut line)?;
    Ok(line)
}

/// Reads all output, so that the program never waits for a reader, and keeps its end.
fn keep_last_words(mut stderr: ChildStderr, kept: &Mutex<Vec<u8>>) {
    let mut buffer = [0; 4096];
    while let Ok(count @ 1..) = stderr.read(&mut buffer) {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend_from_slice(&buffer[..count]);
        let surplus = kept.len().saturating_sub(LAST_WORDS);
        kept.drain(..surplus);
    }
}

/// The start of a text, for messages.
pub fn excerpt(text: &str) -> String {
    format!("`{}`", text::line(&text::start(text, 60)))
}
