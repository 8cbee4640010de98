//! An orderly end after Ctrl-C and similar signals.

/// Makes SIGINT, SIGTERM and SIGHUP end the program with a message and the exit code that a shell expects, 128 plus
/// the signal's number, and never in the middle of writing files.
#[cfg(unix)]
pub(super) fn watch() {
    use clap::CommandFactory;
    use shearbed_validation::files::{checkpoint, cluster, output};
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::signal_name;

    #[cfg(target_os = "linux")]
    with_parent();
    // If this fails, the system ends the program in its usual way.
    let Ok(mut signals) = Signals::new([SIGINT, SIGTERM, SIGHUP]) else {
        return;
    };
    let stop = |(before, signal): (usize, i32)| {
        let name = signal_name(signal).unwrap_or("SIGHUP");
        let code = 128 + signal;
        if before > 0 {
            // The results are there, but nobody reads what is said of them.
            std::process::exit(code);
        }
        super::terminal::clear();
        let kept = checkpoint::last_words().unwrap_or_else(|| match super::words::command().as_str() {
            "sweep" => "finished points are saved, and the same command goes on from them".to_owned(),
            command => {
                let keeps = |command: &clap::Command| {
                    command.get_arguments().any(|argument| argument.get_long() == Some("checkpoint"))
                };
                let keeps = super::Cli::command().find_subcommand(command).is_some_and(keeps);
                let how = if keeps { ", but with --checkpoint FILE, from which the same command goes on" } else { "" };
                format!("`shearbed {command}` saves nothing before it ends{how}")
            }
        });
        let message = format!("stopped by {name}: no file is half written; {kept}");
        let say = || {
            cluster::failed(&message, code as u8);
            shearbed_validation::serve::grade::live::end_all();
        };
        output::stop(code, say);
    };
    let wait = move || signals.forever().enumerate().for_each(stop);
    let _ = std::thread::Builder::new().spawn(wait);
}

/// Ends the program when the process SHEARBED_PARENT ends, which the Python package sets to its own: a run that
/// outlives its script could replace later results.
#[cfg(target_os = "linux")]
fn with_parent() {
    use rustix::process::{Signal, getppid, set_parent_process_death_signal};
    let Some(parent) = std::env::var("SHEARBED_PARENT").ok().and_then(|text| text.parse::<i32>().ok()) else {
        return;
    };
    let _ = set_parent_process_death_signal(Some(Signal::TERM));
    // It may have ended before.
    if getppid().is_none_or(|now| now.as_raw_nonzero().get() != parent) {
        std::process::exit(1);
    }
}

/// Makes a limit on the size of files (`ulimit -f`) an error of the write that meets it; the system would end the
/// program.
#[cfg(unix)]
pub(super) fn outlive_limits() {
    // If this fails, the system ends the program.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::default());
}

/// Does nothing: there is no such signal.
#[cfg(not(unix))]
pub(super) fn outlive_limits() {}

/// Does nothing: the system ends the program.
#[cfg(not(unix))]
pub(super) fn watch() {}
