//! Output of a command on the terminal while it runs.

use super::{Failure, refuse};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle, WeakProgressBar};
use shearbed_validation::files::cluster;
use shearbed_validation::files::text::{complain, readable};
use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// The last progress bar.
static BAR: Mutex<Option<WeakProgressBar>> = Mutex::new(None);

/// Removes the progress bar from the terminal, so that an error starts on a line of its own.
pub(super) fn clear() {
    let bar = BAR.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let Some(bar) = bar.and_then(|bar| bar.upgrade()) {
        bar.finish_and_clear();
    }
}

/// Prints to standard output. It is no error if the reader has closed the pipe, as `head` does.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    if !cluster::is_root() {
        return Ok(());
    }
    let mut stdout = io::stdout().lock();
    match stdout.write_all(readable(text).as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Input(format!("standard output: cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// Refuses to print where nobody can read it: to a standard output that was closed (`>&-`). The runtime opens /dev/null
/// in its place for reading and writing, before `main`; a shell's `> /dev/null` is opened for writing alone.
#[cfg(unix)]
pub(super) fn is_open() -> Result<(), Failure> {
    use rustix::fs::{OFlags, fcntl_getfl, fstat, stat};
    let stdout = io::stdout();
    let null = || Ok::<_, rustix::io::Errno>(fstat(&stdout)?.st_rdev == stat("/dev/null")?.st_rdev);
    let both = fcntl_getfl(&stdout).is_ok_and(|flags| flags & OFlags::RWMODE == OFlags::RDWR);
    refuse((both && null().unwrap_or(false)).then_some(()), |()| {
        "standard output: cannot be written: it is closed, or /dev/null opened for reading and writing; open it for \
         writing alone (`> /dev/null`) to discard what this command prints"
            .to_owned()
    })
}

/// Never refuses.
#[cfg(not(unix))]
pub(super) fn is_open() -> Result<(), Failure> {
    Ok(())
}

/// Prints a line about progress to standard error if no bar shows it, as in the log of a job.
pub(super) fn log(line: &str, quiet: bool) {
    if quiet || !cluster::is_root() || io::stderr().is_terminal() {
        return;
    }
    complain(&format!("{}\n", readable(line)));
}

/// Logs each `every` how far a bar of `what` is, as long as there is the bar.
pub(super) fn log_progress(bar: &ProgressBar, what: &'static str, every: Duration, quiet: bool) {
    let bar = bar.downgrade();
    let follow = move || {
        loop {
            thread::sleep(every);
            let Some(bar) = bar.upgrade().filter(|bar| !bar.is_finished()) else { break };
            let (part, done, all) = (bar.message(), bar.position(), bar.length().unwrap_or_default());
            log(&format!("progress: {part}: {done} of {all} {what}"), quiet);
        }
    };
    // Without another thread the log has no such lines.
    let _ = thread::Builder::new().spawn(follow);
}

/// A bar for slow work on a terminal, hidden elsewhere. It shows the time left once a step is done, from the mean rate;
/// for a single step it shows the elapsed time.
pub(super) fn progress(steps: u64, what: &str, quiet: bool) -> ProgressBar {
    let template = match steps {
        1 => "{spinner} running for {elapsed} {msg}".to_owned(),
        _ => format!("{{wide_bar}} {{pos}}/{{len}} {what}, {{left}} {{msg}}"),
    };
    bar(steps, &template, quiet, |_, rate, left| format!("{rate:.2} a second, {left:.0} s left"))
}

/// A bar for work that usually takes so many steps, of which more become known as it goes on.
pub(super) fn progress_of_some(usual: u64, what: &str, quiet: bool) -> ProgressBar {
    let template = format!("{{msg}} {{wide_bar}} {{pos}} of some {{len}} {what}, {{left}}");
    bar(usual, &template, quiet, move |all, _, left| {
        if all > usual {
            format!("longer than most, {left:.0} s left or more")
        } else {
            format!("some {left:.0} s left")
        }
    })
}

/// A bar with the words of `left` from its length, the steps a second and the seconds left.
fn bar(
    steps: u64,
    template: &str,
    quiet: bool,
    left: impl Fn(u64, f64, f64) -> String + Clone + Send + Sync + 'static,
) -> ProgressBar {
    if quiet || !cluster::is_root() || !io::stderr().is_terminal() {
        let bar = ProgressBar::hidden();
        bar.set_length(steps);
        return bar;
    }
    let left = move |state: &ProgressState, text: &mut dyn fmt::Write| {
        let elapsed = state.elapsed().as_secs_f64();
        let words = match (state.pos(), state.len()) {
            (0, _) | (_, None) => format!("{elapsed:.0} s so far"),
            (done, Some(all)) => {
                let rate = done as f64 / elapsed.max(1e-9);
                left(all, rate, all.saturating_sub(done) as f64 / rate)
            }
        };
        // If even this cannot be written, there is no bar.
        let _ = text.write_str(&words);
    };
    let style = ProgressStyle::with_template(template);
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar());
    let bar = ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::stderr());
    bar.set_style(style.with_key("left", left));
    bar.enable_steady_tick(Duration::from_millis(500));
    *BAR.lock().unwrap_or_else(PoisonError::into_inner) = Some(bar.downgrade());
    bar
}
