//! Feeds the program's readers what people and machines might: mutated and generated scene files, folders of measured
//! points, arguments of `sweep`, problems, answers, points to fit, folders of results, checkpoints, folders to write
//! to. None may panic, hang, take memory without bound or let a number pass that is not finite, and a refusal
//! says where and why.
//!
//!     cargo run --release -p shearbed-cli --example fuzz -- TARGET COUNT [SEED]
//!
//! prints how many inputs were taken and refused; the first one at fault ends it with the input in `fuzz-fault/`. The
//! small part that the gate runs is the test below.

mod checkpoints;
mod folders;
mod mutate;
mod readers;
mod results;
mod scenes;

use mutate::Mutator;
use peak_alloc::PeakAlloc;
use rustix::time::{ClockId, clock_gettime};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Seconds of the process's own time after which one input is a hang, whatever else the machine does: a thousand times
/// what the slowest takes.
const HANG_S: i64 = 60;
/// Seconds by the clock after which one input waits for what does not come.
const WAIT_S: u64 = 3600;
/// Bytes that one input may take: scenes that need more are not run, and no file here has a megabyte.
const MEMORY: usize = 512 << 20;

/// How a reader took an input.
pub enum Taken {
    /// As something to work on.
    Accepted,
    /// Not, for this reason.
    Refused(String),
}

impl Taken {
    /// As something to work on, if all its numbers are finite; else this is at fault.
    fn if_finite(finite: bool, fault: &str) -> Result<Self, String> {
        if finite { Ok(Self::Accepted) } else { Err(format!("{fault} that is not finite")) }
    }

    /// Not, for a reason that names this place; else this is at fault.
    fn refused_at(place: &str, why: String) -> Result<Self, String> {
        if why.contains(place) { Ok(Self::Refused(why)) } else { Err(format!("{place} is not named: {why}")) }
    }
}

/// Files by name.
type Files = [(&'static str, Vec<u8>)];
type Set = Vec<(&'static str, Vec<u8>)>;
/// Takes one set of files, of which some are mutated.
type Take = dyn Fn(&Path, &Files) -> Result<Taken, String>;

/// What reads one kind of input: its corpus, and what must hold of every input. `Err` is a fault of the program.
pub struct Target {
    name: &'static str,
    /// Files that are right, as a set of names and contents each.
    corpus: Vec<Set>,
    take: Box<Take>,
}

fn targets() -> Vec<Target> {
    vec![
        scenes::scene(),
        scenes::sweep(),
        readers::data(),
        readers::problems(),
        readers::answers(),
        results::fits(),
        results::plots(),
        checkpoints::checkpoint(),
        folders::folders(),
    ]
}

/// Feeds a target `count` inputs of this seed. How many were accepted, and the first words of reasons with their
/// number.
fn feed(target: &Target, count: u64, seed: u64) -> Result<(u64, BTreeMap<String, u64>), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let mut mutator = Mutator::new(seed);
    let mut accepted = 0;
    let mut reasons = BTreeMap::new();
    for k in 0..count {
        let files = mutator.of(&target.corpus);
        if let Ok(mut at_work) = AT_WORK.lock() {
            at_work.clone_from(&files);
        }
        BEGUN.store(k + 1, Ordering::Relaxed);
        let before = ALLOCATOR.current_usage();
        ALLOCATOR.reset_peak_usage();
        let taken = catch_unwind(AssertUnwindSafe(|| (target.take)(folder.path(), &files)));
        let held = ALLOCATOR.peak_usage().saturating_sub(before);
        let fault = match taken {
            Err(_) => Some("a panic".to_owned()),
            Ok(Err(fault)) => Some(fault),
            Ok(Ok(_)) if held > MEMORY => Some(format!("{held} bytes held")),
            Ok(Ok(Taken::Accepted)) => {
                accepted += 1;
                None
            }
            Ok(Ok(Taken::Refused(why))) => {
                *reasons.entry(kind(&why)).or_default() += 1;
                None
            }
        };
        if let Some(fault) = fault {
            keep(&files).map_err(|error| error.to_string())?;
            return Err(format!("{}: input {k} of seed {seed}: {fault}; it is in fuzz-fault/", target.name));
        }
    }
    BEGUN.store(0, Ordering::Relaxed);
    Ok((accepted, reasons))
}

/// Writes an input at fault.
fn keep(files: &Files) -> std::io::Result<()> {
    std::fs::create_dir_all("fuzz-fault")?;
    (files.iter()).try_for_each(|(name, bytes)| std::fs::write(Path::new("fuzz-fault").join(name), bytes))
}

/// A reason without what is different in each: letters and blanks.
fn kind(why: &str) -> String {
    let words: String = why.chars().map(|c| if c.is_alphabetic() { c } else { ' ' }).collect();
    let words: Vec<_> = words.split_whitespace().rev().take(6).collect();
    words.into_iter().rev().collect::<Vec<_>>().join(" ")
}

/// The input at work, from 1; 0 where none is.
static BEGUN: AtomicU64 = AtomicU64::new(0);
/// The input itself.
static AT_WORK: Mutex<Set> = Mutex::new(Vec::new());

/// Ends the process where one input takes too long.
fn watch() {
    std::thread::spawn(|| {
        let worked_s = || clock_gettime(ClockId::ProcessCPUTime).tv_sec;
        let mut last = (0, worked_s(), Instant::now());
        loop {
            std::thread::sleep(Duration::from_secs(1));
            let begun = BEGUN.load(Ordering::Relaxed);
            if begun != last.0 {
                last = (begun, worked_s(), Instant::now());
            } else if begun > 0 && (worked_s() - last.1 > HANG_S || last.2.elapsed().as_secs() > WAIT_S) {
                let kept = AT_WORK.lock().is_ok_and(|files| keep(&files).is_ok());
                let place = if kept { "; it is in fuzz-fault/" } else { "" };
                eprintln!("input {} hangs{place}", begun - 1);
                std::process::exit(3);
            }
        }
    });
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |k: usize, default| words.get(k).map_or(Ok(default), |word| word.parse());
    let (Some(name), Ok(count), Ok(seed)) = (words.first(), number(1, 1000), number(2, 1)) else {
        eprintln!("fuzz TARGET COUNT [SEED]");
        std::process::exit(2);
    };
    watch();
    for target in targets().iter().filter(|target| name == "all" || name == target.name) {
        let start = Instant::now();
        match feed(target, count, seed) {
            Ok((accepted, reasons)) => {
                let seconds = start.elapsed().as_secs_f64();
                println!(
                    "{}: {count} inputs, {accepted} accepted, {} kinds of refusal, {seconds:.0} s",
                    target.name,
                    reasons.len()
                );
                let mut reasons: Vec<_> = reasons.into_iter().collect();
                reasons.sort_by_key(|(_, count)| u64::MAX - count);
                for (reason, count) in reasons.iter().take(12) {
                    println!("    {count:>9}  … {reason}");
                }
            }
            Err(fault) => {
                eprintln!("{fault}");
                std::process::exit(1);
            }
        }
    }
}

/// The gate's part, in one test: memory is counted for all threads. Of every target some inputs are accepted and some
/// refused: else nothing would be tried.
#[test]
fn no_input_breaks_a_reader_and_one_that_breaks_is_seen() {
    faults_are_seen();
    watch();
    for target in targets() {
        let (accepted, reasons) = feed(&target, 400, 1982).unwrap();
        assert!(accepted > 0 && reasons.len() > 2, "{}: {accepted}, {reasons:?}", target.name);
    }
}

#[cfg(test)]
fn faults_are_seen() {
    let of = |take: fn(&Files) -> Result<Taken, String>| Target {
        name: "broken",
        corpus: vec![vec![("a", b"x = 1\n".to_vec())]],
        take: Box::new(move |_, files| take(files)),
    };
    let panics = of(|files| if files[0].1.len() > 9 { panic!("planted") } else { Ok(Taken::Accepted) });
    assert!(feed(&panics, 1000, 1).unwrap_err().contains("a panic"));
    let held = of(|_| {
        std::hint::black_box(vec![1_u8; 600 << 20]);
        Ok(Taken::Accepted)
    });
    assert!(feed(&held, 1, 1).unwrap_err().contains("bytes held"));
    let passes = of(|files| if files[0].1.contains(&b'e') { Err("not finite".into()) } else { Ok(Taken::Accepted) });
    assert!(feed(&passes, 1000, 1).unwrap_err().contains("not finite"));
    // What the first at fault left.
    std::fs::remove_dir_all("fuzz-fault").unwrap();
}
