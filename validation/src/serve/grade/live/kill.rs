//! Ends graded programs with their descendants, those that left their process group too.

use std::collections::BTreeSet;
use std::io;
use std::process::{Child, Command, ExitStatus};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

pub(super) use family::processor_time;

/// The longest that killed processes are waited for.
const PATIENCE: Duration = Duration::from_secs(3);

/// The programs that run now, by their ids.
static RUNNING: Mutex<BTreeSet<u32>> = Mutex::new(BTreeSet::new());

fn running() -> MutexGuard<'static, BTreeSet<u32>> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

pub(super) fn start(command: &mut Command) -> io::Result<Child> {
    let mut running = running();
    family::adopt();
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    let child = command.spawn()?;
    running.insert(child.id());
    Ok(child)
}

/// Kills a program with its descendants. Returns its status, unless it does not end, and a message on each process that
/// is left.
pub(super) fn end(child: &mut Child) -> (Option<ExitStatus>, Vec<String>) {
    let mut running = running();
    running.remove(&child.id());
    let mut left = killed(child.id(), &running);
    #[cfg(not(unix))]
    let _ = child.kill();
    let deadline = Instant::now() + PATIENCE;
    let mut status = child.try_wait();
    while matches!(status, Ok(None)) && Instant::now() < deadline {
        sleep(Duration::from_millis(1));
        status = child.try_wait();
    }
    let status = status.ok().flatten();
    if status.is_none() && left.is_empty() {
        left.push(format!("process {} cannot be stopped", child.id()));
    }
    (status, left)
}

/// Kills every program that still runs with its descendants, before this program ends.
pub fn end_all() {
    let mut running = running();
    while let Some(id) = running.pop_first() {
        for left in killed(id, &running) {
            crate::files::text::complain(&format!("warning: {left}\n"));
        }
    }
}

/// Kills a program's process group and its descendants. Returns a message on each that cannot be killed.
fn killed(id: u32, others: &BTreeSet<u32>) -> Vec<String> {
    #[cfg(unix)]
    {
        use rustix::process::{Pid, Signal, kill_process_group};
        // An error means that the group is empty, or another user's.
        let _ = Pid::from_raw(id.cast_signed()).map(|id| kill_process_group(id, Signal::KILL));
    }
    family::killed(id, others)
}

/// Processes and their parents, from `/proc`.
#[cfg(target_os = "linux")]
mod family {
    use super::PATIENCE;
    use crate::files::{bounded, text};
    use rustix::process::{Pid, Signal, WaitOptions, getpid, kill_process, set_child_subreaper, waitpid};
    use std::collections::{BTreeMap, BTreeSet};
    use std::fs;
    use std::os::unix::fs::MetadataExt;
    use std::path::Path;
    use std::sync::OnceLock;
    use std::thread::sleep;
    use std::time::{Duration, Instant};

    struct Process {
        parent: u32,
        /// It has ended, and its parent has not asked how.
        zombie: bool,
        /// Processor time, in ticks of the clock.
        ticks: u64,
    }

    /// Size limit in bytes of a line about a process.
    const MOST: u64 = 1 << 12;

    /// This program's children before the first graded program.
    static EARLIER: OnceLock<BTreeSet<u32>> = OnceLock::new();

    /// Makes this program the parent of every descendant whose own parent ends.
    pub(super) fn adopt() {
        EARLIER.get_or_init(|| {
            let _ = set_child_subreaper(Some(getpid()));
            children(std::process::id(), &all())
        });
    }

    fn all() -> BTreeMap<u32, Process> {
        let ids = fs::read_dir("/proc").into_iter().flatten().flatten();
        let ids = ids.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
        ids.filter_map(|id| Some((id, process(id)?))).collect()
    }

    fn process(id: u32) -> Option<Process> {
        // 17 (a name with any character) S 1 …
        let stat = bounded::bytes(Path::new(&format!("/proc/{id}/stat")), MOST).ok()?;
        let stat = String::from_utf8_lossy(&stat);
        let (state, rest) = stat.rsplit_once(") ")?.1.split_once(' ')?;
        let mut fields = rest.split(' ');
        let parent = fields.next()?.parse().ok()?;
        // utime, stime and those of children that have ended, fields 14 to 17 of proc(5).
        let ticks = fields.skip(9).take(4).map(|field| field.parse::<u64>().unwrap_or_default()).sum();
        Some(Process { parent, zombie: matches!(state, "Z" | "X"), ticks })
    }

    /// The processor time that a program and its descendants have used.
    pub(in super::super) fn processor_time(id: u32) -> Option<Duration> {
        let all = all();
        let family = with_descendants(BTreeSet::from([id]), &all);
        let ticks: u64 = family.iter().filter_map(|id| Some(all.get(id)?.ticks)).sum();
        Some(Duration::from_secs_f64(ticks as f64 / rustix::param::clock_ticks_per_second() as f64))
    }

    fn with_descendants(mut found: BTreeSet<u32>, all: &BTreeMap<u32, Process>) -> BTreeSet<u32> {
        let mut new = found.clone();
        while !new.is_empty() {
            new = new.iter().flat_map(|parent| children(*parent, all)).filter(|child| !found.contains(child)).collect();
            found.extend(&new);
        }
        found
    }

    fn children(parent: u32, all: &BTreeMap<u32, Process>) -> BTreeSet<u32> {
        all.iter().filter(|(_, process)| process.parent == parent).map(|(id, _)| *id).collect()
    }

    /// Kills a program with its descendants. Returns a message on each that cannot be killed.
    pub(super) fn killed(id: u32, others: &BTreeSet<u32>) -> Vec<String> {
        let deadline = Instant::now() + PATIENCE;
        // A parent may have had another child before it was killed: they are looked for until there is none.
        loop {
            let late = Instant::now() > deadline;
            let (mut left, mut may_end) = (Vec::new(), false);
            for found in alive(id, others) {
                let sent = Pid::from_raw(found.cast_signed()).map_or(Ok(()), |id| kill_process(id, Signal::KILL));
                match sent {
                    Ok(()) if late => left.push(message(found, "it does not end")),
                    Ok(()) => may_end = true,
                    Err(rustix::io::Errno::SRCH) => {}
                    Err(error) => left.push(message(found, &error.to_string())),
                }
            }
            if !may_end {
                return left;
            }
            sleep(Duration::from_millis(2));
        }
    }

    /// The descendants of a program, and itself, that have not ended. Where no other program runs, adopted processes
    /// are its own.
    fn alive(id: u32, others: &BTreeSet<u32>) -> BTreeSet<u32> {
        let all = all();
        let mut found = BTreeSet::from([id]);
        if others.is_empty() {
            let earlier = EARLIER.get();
            let adopted = children(std::process::id(), &all).into_iter();
            found.extend(adopted.filter(|child| !earlier.is_some_and(|earlier| earlier.contains(child))));
        }
        let mut found = with_descendants(found, &all);
        let zombie = |id: &u32| all.get(id).is_none_or(|process| process.zombie);
        for ended in found.iter().filter(|found| **found != id && zombie(found)) {
            // Of an adopted one nobody else asks how it ended; those of others are no children of this program.
            let _ = Pid::from_raw(ended.cast_signed()).map(|ended| waitpid(Some(ended), WaitOptions::NOHANG));
        }
        found.retain(|id| !zombie(id));
        found
    }

    /// What cannot be killed, why, and how to end it.
    fn message(id: u32, why: &str) -> String {
        let folder = format!("/proc/{id}");
        let name = bounded::bytes(&Path::new(&folder).join("comm"), MOST).unwrap_or_default();
        let name = text::line(String::from_utf8_lossy(&name).trim());
        let user = fs::metadata(folder).map_or_else(|_| "unknown".to_owned(), |folder| folder.uid().to_string());
        format!("process {id} ({name}, user id {user}) cannot be stopped: {why}; end it by hand: kill -9 {id}")
    }
}

/// Without `/proc`: the process group alone.
#[cfg(not(target_os = "linux"))]
mod family {
    use std::collections::BTreeSet;

    pub(super) fn adopt() {}

    pub(in super::super) fn processor_time(_: u32) -> Option<std::time::Duration> {
        None
    }

    pub(super) fn killed(_: u32, _: &BTreeSet<u32>) -> Vec<String> {
        Vec::new()
    }
}
